// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file TemporaryFile.h
/// Files that are gone when the program is, however it ends.

#ifndef dhm_TemporaryFile_h
#define dhm_TemporaryFile_h

#include <string>

namespace dhm
{

/// Lets interrupts (SIGINT, SIGTERM, SIGHUP) remove temporary files before they end the program,
/// and makes a limit on the size of files, or a reader that has gone, errors like others.
void HandleSignals();

/// An empty file of a new name, removed by the destructor and by interrupts.
class TemporaryFile
{
public:
  TemporaryFile() = default;
  /// @a begin (with the folder) and @a ending of the name. Throws std::system_error if the file
  /// cannot be made.
  TemporaryFile(const std::string& begin, const std::string& ending);
  ~TemporaryFile();
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const std::string& GetName() const { return this->Name; }

  /// Gives the file its final name, in the same folder, under which it stays, unless @a replace is
  /// false and there is a file of that name. Returns 0 or an error number.
  int Rename(const std::string& name, bool replace);

private:
  std::string Name;
};

} // namespace dhm

#endif
