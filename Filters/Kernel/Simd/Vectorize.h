// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Vectorize.h
/// Loops over several points at once.

#ifndef homeomorphism_Vectorize_h
#define homeomorphism_Vectorize_h

/// HOMEOMORPHISM_FOR_WIDE_VECTORS, before a function: it is compiled for wider vectors, too, and
/// the widest that the processor has are used. HOMEOMORPHISM_WITH_FMA: the same for functions with
/// std::fma, which is one instruction where the processor has it. (By features: the name of an
/// architecture, such as haswell, would mean the processors of one maker.) No rounding depends on
/// which, since sums and products are never fused unasked (see Sources.cmake). Sanitizers do not
/// work with functions that are chosen when the library is loaded.
#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__linux__) &&       \
  !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define HOMEOMORPHISM_FOR_WIDE_VECTORS __attribute__((target_clones("avx512f", "avx2", "default")))
#define HOMEOMORPHISM_WITH_FMA __attribute__((target_clones("avx512f", "fma", "default")))
#else
#define HOMEOMORPHISM_FOR_WIDE_VECTORS
#define HOMEOMORPHISM_WITH_FMA
#endif

/// Before a function used by one of those: it becomes part of it.
#if defined(__GNUC__)
#define HOMEOMORPHISM_ALWAYS_INLINE inline __attribute__((always_inline))
#elif defined(_MSC_VER)
#define HOMEOMORPHISM_ALWAYS_INLINE __forceinline
#else
#define HOMEOMORPHISM_ALWAYS_INLINE inline
#endif

namespace homeomorphism
{

/// The most numbers that one instruction deals with. Arrays have so many elements more than are
/// used, and loops run to whole multiples, writing what is overwritten or never read: what remains
/// after whole vectors would take longer than they do.
constexpr int WidestVector = 8;

constexpr int InWholeVectors(int count)
{
  return (count + WidestVector - 1) & ~(WidestVector - 1);
}

} // namespace homeomorphism

/// Before a loop over batch, whose passes do not depend on each other.
#if defined(__clang__)
#define HOMEOMORPHISM_SIMD _Pragma("clang loop vectorize(enable)")
#elif defined(__GNUC__)
#define HOMEOMORPHISM_SIMD _Pragma("GCC ivdep")
#else
#define HOMEOMORPHISM_SIMD
#endif

#endif
