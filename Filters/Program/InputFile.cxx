// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "InputFile.h"

#include "Failure.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <unistd.h>

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
    std::string pattern =
      (std::filesystem::temp_directory_path() / ("dhm-XXXXXX." + format)).string();
    const int descriptor = mkstemps(pattern.data(), static_cast<int>(format.size()) + 1);
    if (descriptor < 0)
    {
      throw Failure(
        FILE_TROUBLE, "Cannot keep standard input: " + std::string(std::strerror(errno)) + ".");
    }
    close(descriptor);
    this->Path = pattern;
    this->Temporary = true;
    std::ofstream copy(pattern, std::ios::binary);
    if (std::cin.peek() != std::char_traits<char>::eof())
    {
      copy << std::cin.rdbuf();
    }
    copy.close();
    if (!copy)
    {
      unlink(pattern.c_str());
      throw Failure(FILE_TROUBLE, "Cannot keep standard input: no room for it.");
    }
    return;
  }
  std::error_code error;
  if (std::filesystem::is_directory(name, error))
  {
    throw Failure(FILE_TROUBLE, name + " is a folder.");
  }
  if (!std::ifstream(name))
  {
    throw Failure(FILE_TROUBLE, "Cannot open " + name + ": " + std::strerror(errno) + ".");
  }
}

InputFile::~InputFile()
{
  if (this->Temporary)
  {
    unlink(this->Path.c_str());
  }
}

} // namespace dhm
