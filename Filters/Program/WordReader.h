// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file WordReader.h
/// Text files whose lines do not matter, word by word.

#ifndef dhm_WordReader_h
#define dhm_WordReader_h

#include "Failure.h"
#include "Numbers.h"

#include <istream>
#include <string>
#include <utility>

namespace dhm
{

/// Reads words, and knows on which line the last one was. Throws Failure, naming file and line,
/// where something else is expected.
class WordReader
{
public:
  WordReader(std::istream& file, std::string fileName, int line = 1)
    : File(file)
    , FileName(std::move(fileName))
    , Line(line)
  {
  }

  /// The next word; false at the end of the file.
  bool Next(std::string& word)
  {
    word.clear();
    for (int c = this->File.get(); c != std::char_traits<char>::eof(); c = this->File.get())
    {
      const bool blank = c == ' ' || (c >= '\t' && c <= '\r');
      if (blank && !word.empty())
      {
        this->File.unget();
        return true;
      }
      if (!blank)
      {
        word += static_cast<char>(c);
      }
      this->Line += c == '\n';
    }
    return !word.empty();
  }

  std::string Require(const std::string& expected)
  {
    std::string word;
    if (!this->Next(word))
    {
      throw Failure(FILE_TROUBLE,
        this->FileName + " ends in line " + std::to_string(this->Line) + ": expected " + expected +
          ". It has been cut off, or is damaged.");
    }
    return word;
  }

  double RequireNumber(const std::string& expected)
  {
    const std::string word = this->Require(expected);
    const auto number = ToNumber(word);
    if (!number)
    {
      this->Fail(expected, word);
    }
    return *number;
  }

  void SkipLine()
  {
    std::string rest;
    std::getline(this->File, rest);
    ++this->Line;
  }

  [[noreturn]] void Fail(const std::string& expected, const std::string& found) const
  {
    throw Failure(FILE_TROUBLE,
      this->FileName + ", line " + std::to_string(this->Line) + ": expected " + expected +
        ", found \"" + found + "\".");
  }

private:
  std::istream& File;
  std::string FileName;
  int Line;
};

} // namespace dhm

#endif
