// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Vectorize.h
/// Macros for vectorized loops over batches.

#ifndef homeomorphism_Vectorize_h
#define homeomorphism_Vectorize_h

/// HOMEOMORPHISM_FOR_WIDE_VECTORS before a function compiles it for several vector widths; the
/// loader selects the widest that the processor supports. HOMEOMORPHISM_WITH_FMA does the same for
/// functions that use std::fma. Targets are named by feature, because the name of an architecture
/// such as haswell would select processors of one manufacturer only. Results do not depend on the
/// selection, because products and sums are never contracted implicitly (see Sources.cmake). The
/// sanitizers do not support functions that are selected by the loader.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) &&       \
  !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define HOMEOMORPHISM_FOR_WIDE_VECTORS __attribute__((target_clones("avx512f", "avx2", "default")))
#define HOMEOMORPHISM_WITH_FMA __attribute__((target_clones("avx512f", "fma", "default")))
#else
#define HOMEOMORPHISM_FOR_WIDE_VECTORS
#define HOMEOMORPHISM_WITH_FMA
#endif

/// Before a function that one of those calls: inlines it, so that it is compiled for the same
/// vector width.
#if defined(__GNUC__)
#define HOMEOMORPHISM_ALWAYS_INLINE inline __attribute__((always_inline))
#elif defined(_MSC_VER)
#define HOMEOMORPHISM_ALWAYS_INLINE __forceinline
#else
#define HOMEOMORPHISM_ALWAYS_INLINE inline
#endif

/// Before a function that is rarely called: keeps its code out of its callers.
#if defined(__GNUC__)
#define HOMEOMORPHISM_NEVER_INLINE __attribute__((noinline, cold))
#else
#define HOMEOMORPHISM_NEVER_INLINE
#endif

namespace homeomorphism
{

/// The largest number of doubles in a vector. Arrays have this many extra elements, and loops run
/// to whole multiples of it, because a scalar remainder loop would take longer. The extra elements
/// are overwritten later or never read.
constexpr int WidestVector = 8;

/// The smallest number of points for which a vectorized loop is faster than processing them one by
/// one.
constexpr int LeastVector = 3;

constexpr int InWholeVectors(int count)
{
  return (count + WidestVector - 1) & ~(WidestVector - 1);
}

} // namespace homeomorphism

/// Before a loop over a batch whose iterations are independent.
#if defined(__clang__)
#define HOMEOMORPHISM_SIMD _Pragma("clang loop vectorize(enable)")
#elif defined(__GNUC__)
#define HOMEOMORPHISM_SIMD _Pragma("GCC ivdep")
#else
#define HOMEOMORPHISM_SIMD
#endif

#endif
