// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "InputFile.h"

#include "Failure.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <system_error>

namespace dhm
{

std::string FormatOf(const std::string& fileName)
{
  std::string format = std::filesystem::path(fileName).extension().string();
  format.erase(0, format.empty() ? 0 : 1);
  std::transform(format.begin(), format.end(), format.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return format;
}

InputFile::InputFile(const std::string& name, const std::string& format)
  : Name(name == "-" ? "standard input" : name)
  , Path(name)
  , Format(name == "-" ? format : FormatOf(name))
{
  if (name == "-")
  {
    try
    {
      this->Temporary.emplace(
        (std::filesystem::temp_directory_path() / "dhm-").string(), "." + format);
    }
    catch (const std::system_error& error)
    {
      throw Failure(FILE_TROUBLE, "Cannot keep standard input: " + error.code().message() + ".");
    }
    this->Path = this->Temporary->GetName();
    std::ofstream copy(this->Path, std::ios::binary);
    if (std::cin.peek() != std::char_traits<char>::eof())
    {
      copy << std::cin.rdbuf();
    }
    copy.close();
    if (!copy)
    {
      throw Failure(FILE_TROUBLE, "Cannot keep standard input: no room for it.");
    }
    return;
  }
  if (name.empty())
  {
    throw Failure(WRONG_USAGE, "The name of an input file is empty.");
  }
  std::error_code error;
  if (std::filesystem::is_directory(name, error))
  {
    throw Failure(FILE_TROUBLE, name + " is a folder.");
  }
  if (!std::ifstream(name))
  {
    throw Failure(
      FILE_TROUBLE, "Cannot open " + name + ": " + std::generic_category().message(errno) + ".");
  }
}

} // namespace dhm
