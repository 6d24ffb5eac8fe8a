// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Failure.h
/// How the program ends.

#ifndef dhm_Failure_h
#define dhm_Failure_h

#include <stdexcept>
#include <string>

namespace dhm
{

/// Exit statuses.
enum Status
{
  /// Done; of `check`: the pair defines a map.
  SUCCESS = 0,
  /// The answer is no: the meshes define no map, or what was asked for cannot be had of them.
  REFUSED = 1,
  /// The command line makes no sense.
  WRONG_USAGE = 2,
  /// A file cannot be read or written, or is not what it should be.
  FILE_TROUBLE = 3
};

/// Ends the program with a message and a status.
class Failure : public std::runtime_error
{
public:
  Failure(Status status, const std::string& message)
    : std::runtime_error(message)
    , ExitStatus(status)
  {
  }

  Status GetStatus() const { return this->ExitStatus; }

private:
  Status ExitStatus;
};

} // namespace dhm

#endif
