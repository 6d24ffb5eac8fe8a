// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Tables.h
/// Reads the reference values of Testing/Data.

#ifndef fixtures_Tables_h
#define fixtures_Tables_h

#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace fixtures
{

/// The numbers of a row by the names of their columns.
using Row = std::map<std::string, double>;

/// Comma-separated numbers under a row of names; lines that begin with # are comments.
inline std::vector<Row> ReadTable(const std::string& path)
{
  std::ifstream file(path);
  std::vector<Row> rows;
  std::vector<std::string> header;
  std::string line;
  while (std::getline(file, line))
  {
    std::vector<std::string> values;
    std::istringstream cells(line);
    for (std::string cell; line[0] != '#' && std::getline(cells, cell, ',');)
    {
      values.push_back(cell);
    }
    if (header.empty() || values.empty())
    {
      header = values;
      continue;
    }
    EXPECT_EQ(values.size(), header.size()) << path << ": " << line;
    Row row;
    for (std::size_t i = 0; i < header.size(); ++i)
    {
      row[header[i]] = std::stod(values[i]);
    }
    rows.push_back(row);
  }
  return rows;
}

} // namespace fixtures

#endif
