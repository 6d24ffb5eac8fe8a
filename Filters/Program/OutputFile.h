// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file OutputFile.h
/// Files that come into being at once and whole, or not at all.

#ifndef dhm_OutputFile_h
#define dhm_OutputFile_h

#include "TemporaryFile.h"

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <string_view>

namespace dhm
{

/// A file to be written: somebody writes to GetTemporaryName(), in the same folder, and Commit
/// gives it its name. What is not committed is removed, on interrupts as well. "-" is standard
/// output, to which Commit copies, as it does to pipes and devices.
class OutputFile
{
public:
  /// @a format is the extension that says what standard output, or a pipe or device whose name does
  /// not say it, is to hold. Throws Failure if there is a file of that name and it is not to be
  /// replaced, or the folder does not exist or cannot be written to.
  OutputFile(const std::string& name, const std::string& format, bool replace);
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// What to open.
  const std::string& GetTemporaryName() const { return this->Temporary->GetName(); }
  /// What to call it in messages.
  std::string GetName() const { return this->Name == "-" ? "standard output" : this->Name; }
  /// The extension in lower case, without the dot.
  const std::string& GetFormat() const { return this->Format; }

  /// Writes all of it. Throws Failure.
  void Write(std::string_view contents) const;
  /// The same of what @a write puts into a stream.
  void Write(const std::function<void(std::ostream& file)>& write) const;

  /// Throws the Failure to say that the disk is full.
  [[noreturn]] void FailForWantOfRoom() const;

  /// Throws Failure if what was written cannot be brought to the disk or to standard output.
  void Commit();

private:
  [[noreturn]] void FailToWrite(int error) const;

  std::string Name;
  std::string Format;
  bool Replace;
  std::optional<TemporaryFile> Temporary;
};

/// The format of an output of this name: its extension or, of standard output, and of pipes and
/// devices without an extension, @a format.
std::string OutputFormatOf(const std::string& name, const std::string& format);

/// The beginning of a message about a format that is not known, or is not there.
std::string CannotWrite(const std::string& what, const std::string& format);

} // namespace dhm

#endif
