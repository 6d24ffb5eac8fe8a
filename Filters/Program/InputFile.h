// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file InputFile.h
/// A file to be read, or standard input.

#ifndef dhm_InputFile_h
#define dhm_InputFile_h

#include "Failure.h"
#include "TemporaryFile.h"

#include <optional>
#include <string>

namespace dhm
{

/// A file to be read. "-" is standard input, which is copied to a temporary file first, since most
/// readers need a file that has a name.
class InputFile
{
public:
  /// @a format is the extension that says what standard input holds. Throws Failure if there is no
  /// such file, or it cannot be read.
  InputFile(const std::string& name, const std::string& format);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// What to open.
  const std::string& GetPath() const { return this->Path; }
  /// What to call it in messages.
  const std::string& GetName() const { return this->Name; }
  /// The extension in lower case, without the dot.
  const std::string& GetFormat() const { return this->Format; }

  bool IsStandardInput() const { return this->Temporary.has_value(); }

private:
  std::string Name;
  std::string Path;
  std::string Format;
  std::optional<TemporaryFile> Temporary;
};

/// Reads what a file holds. If it is standard input and cannot be read, the message says what it
/// was taken for, and which option says what it is.
template <typename Read>
auto ReadFrom(const InputFile& file, const std::string& option, Read&& read)
{
  try
  {
    return read();
  }
  catch (const Failure& failure)
  {
    if (!file.IsStandardInput())
    {
      throw;
    }
    throw Failure(failure.GetStatus(),
      std::string(failure.what()) + " Standard input was read as ." + file.GetFormat() + ": " +
        option + " says what it is.");
  }
}

/// The extension of a file name in lower case, without the dot; empty if it has none.
std::string FormatOf(const std::string& fileName);

} // namespace dhm

#endif
