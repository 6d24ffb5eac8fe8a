// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FuzzRequire.h
/// Assertions of the fuzz targets.

#ifndef FuzzRequire_h
#define FuzzRequire_h

#include <cstdlib>

namespace fuzz
{

/// Aborts if the condition is false, which the fuzzer reports with the input.
inline void Require(bool condition)
{
  if (!condition)
  {
    std::abort();
  }
}

} // namespace fuzz

#endif
