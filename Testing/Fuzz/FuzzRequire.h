// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FuzzRequire.h
/// What must hold, whatever the bytes.

#ifndef FuzzRequire_h
#define FuzzRequire_h

#include <cstdlib>

namespace fuzz
{

/// Ends the program if something does not hold, which the fuzzer reports with the input.
inline void Require(bool condition)
{
  if (!condition)
  {
    std::abort();
  }
}

} // namespace fuzz

#endif
