// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file LineReader.h
/// Text files whose lines matter, line by line.

#ifndef dhm_LineReader_h
#define dhm_LineReader_h

#include "Failure.h"

#include <istream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace dhm
{

/// Reads lines as words, without those that have none. Throws Failure, naming file and line, where
/// something else is expected.
class LineReader
{
public:
  /// What follows a character of @a comments in a line is left out.
  LineReader(std::istream& file, std::string fileName, std::string comments)
    : File(file)
    , FileName(std::move(fileName))
    , Comments(std::move(comments))
  {
  }

  /// The next line that has words; false at the end of the file.
  bool Next()
  {
    std::string line;
    while (std::getline(this->File, line))
    {
      ++this->Number;
      std::istringstream text(line.substr(0, line.find_first_of(this->Comments)));
      this->Words.clear();
      for (std::string word; text >> word;)
      {
        this->Words.push_back(word);
      }
      if (!this->Words.empty())
      {
        return true;
      }
    }
    return false;
  }

  void Require(const std::string& expected)
  {
    if (!this->Next())
    {
      throw Failure(FILE_TROUBLE,
        this->FileName + " ends after line " + std::to_string(this->Number) + ": expected " +
          expected + ".");
    }
  }

  [[noreturn]] void Fail(const std::string& expected) const
  {
    throw Failure(FILE_TROUBLE,
      this->FileName + ", line " + std::to_string(this->Number) + ": expected " + expected + ".");
  }

  /// The number of the last line, from 1.
  int GetNumber() const { return this->Number; }

  /// The last line's.
  std::vector<std::string> Words;

private:
  std::istream& File;
  std::string FileName;
  std::string Comments;
  int Number = 0;
};

} // namespace dhm

#endif
