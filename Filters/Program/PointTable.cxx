// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "PointTable.h"

#include "Failure.h"
#include "Numbers.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkStringArray.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <istream>
#include <limits>
#include <ostream>
#include <sstream>

namespace dhm
{
namespace
{

std::string ToLower(std::string text)
{
  std::transform(text.begin(), text.end(), text.begin(),
    [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

/// In lower case, without blanks around it.
std::string Simplify(const std::string& name)
{
  constexpr const char* blanks = " \t\r\n";
  const std::size_t begin = name.find_first_not_of(blanks);
  return begin == std::string::npos
    ? std::string()
    : ToLower(name.substr(begin, name.find_last_not_of(blanks) - begin + 1));
}

/// What coordinates are called, in the order of x, y (and z); the first that a table has are taken.
const std::vector<std::vector<std::string>>& UsualNames()
{
  static const std::vector<std::vector<std::string>> names{ { "x", "y", "z" }, { "x", "y" },
    { "e", "n" }, { "easting", "northing" }, { "east", "north" },
    { "x_coord", "y_coord", "z_coord" }, { "x_coord", "y_coord" }, { "xcoord", "ycoord" },
    { "x_coordinate", "y_coordinate" }, { "point_x", "point_y" }, { "rechtswert", "hochwert" },
    { "rechts", "hoch" }, { "ostwert", "nordwert" }, { "ost", "nord" }, { "longitude", "latitude" },
    { "long", "lat" }, { "lon", "lat" }, { "lng", "lat" } };
  return names;
}

char FindSeparator(const std::string& line)
{
  const std::array<char, 3> candidates{ ',', ';', '\t' };
  const auto count = [&line](char c) { return std::count(line.begin(), line.end(), c); };
  const char most = *std::max_element(
    candidates.begin(), candidates.end(), [&count](char a, char b) { return count(a) < count(b); });
  return count(most) > 0 ? most : ' ';
}

constexpr const char* byteOrderMark = "\xEF\xBB\xBF";

/// Whether a line that begins with the field would be taken for something else than a row.
bool MisleadsAtBegin(const std::string& field)
{
  return field.compare(0, 1, "#") == 0 || field.compare(0, 3, byteOrderMark) == 0;
}

bool NeedsQuotes(const std::string& field, char separator)
{
  return field.find_first_of("\"\n\r") != std::string::npos ||
    field.find(separator) != std::string::npos || (separator == ' ' && field.empty());
}

} // namespace

bool PointTable::IsFormat(const std::string& format)
{
  return format == "csv" || format == "txt" || format == "xyz";
}

PointTable::PointTable(std::istream& file, const std::string& fileName, const std::string& columns)
{
  const auto fail = [&fileName](std::size_t line, const std::string& what) {
    throw Failure(FILE_TROUBLE, fileName + ", line " + std::to_string(line) + ": " + what);
  };
  std::size_t number = 0;
  std::vector<std::size_t> lineOfRow;
  for (std::string line; std::getline(file, line);)
  {
    ++number;
    if (number == 1 && line.compare(0, 3, byteOrderMark) == 0)
    {
      // As some programs put it there.
      line.erase(0, 3);
    }
    if (line.find_first_not_of(" \t\r") == std::string::npos)
    {
      continue;
    }
    if (line[0] == '#')
    {
      if (line.back() == '\r')
      {
        line.pop_back();
      }
      this->Comments.push_back(line);
      continue;
    }
    if (this->Rows.empty())
    {
      this->Separator = FindSeparator(line);
    }
    const std::size_t first = number;
    Row row;
    std::string field;
    bool quoted = false;
    bool any = false;
    for (std::size_t i = 0;; ++i)
    {
      if (i == line.size())
      {
        if (!quoted)
        {
          break;
        }
        // A field in quotes goes on in the next line.
        std::string more;
        if (!std::getline(file, more))
        {
          fail(first, "a quotation mark that is never closed.");
        }
        ++number;
        line += "\n" + more;
      }
      const char c = line[i];
      if (quoted)
      {
        if (c != '"')
        {
          field += c;
        }
        else if (i + 1 < line.size() && line[i + 1] == '"')
        {
          field += line[++i];
        }
        else
        {
          quoted = false;
        }
      }
      else if (c == '\r' && i + 1 == line.size())
      {
        // Part of the line's end, which it is not within quotes.
      }
      else if (c == '"')
      {
        quoted = any = true;
      }
      else if (this->Separator == ' ' ? c == ' ' || c == '\t' : c == this->Separator)
      {
        if (this->Separator != ' ' || any)
        {
          row.push_back(field);
        }
        field.clear();
        any = false;
      }
      else
      {
        field += c;
        any = true;
      }
    }
    if (this->Separator != ' ' || any)
    {
      row.push_back(field);
    }
    if (!this->Rows.empty() && row.size() != this->Rows[0].size())
    {
      fail(first,
        std::to_string(row.size()) + " columns, but the first line has " +
          std::to_string(this->Rows[0].size()) + ".");
    }
    this->Rows.push_back(row);
    lineOfRow.push_back(first);
  }
  if (this->Rows.empty())
  {
    throw Failure(FILE_TROUBLE, fileName + " has no points.");
  }
  this->ChooseColumns(columns, fileName);

  const auto coordinate = [this](std::size_t row, std::size_t column) {
    return ToNumber(this->Rows[row][this->Columns[column]]);
  };
  const auto failWithCommas = [&](std::size_t row) {
    fail(lineOfRow[row],
      "its numbers have decimal commas: write them with points, such as 0.5 instead of 0,5.");
  };
  if (this->Names.empty() && (!coordinate(0, 0) || !coordinate(0, 1)) &&
    this->HasDecimalCommas(this->Rows[0]))
  {
    failWithCommas(0);
  }
  if (this->Names.empty() && !coordinate(0, 0) && !coordinate(0, 1))
  {
    if (columns.empty())
    {
      throw Failure(FILE_TROUBLE,
        fileName + ": none of its columns (" + this->ListColumns() +
          ") have names that are usual for coordinates, such as x and y: say which they are "
          "(--columns).");
    }
    this->Names = this->Rows[0];
  }
  if (!this->Names.empty())
  {
    this->Rows.erase(this->Rows.begin());
    lineOfRow.erase(lineOfRow.begin());
  }
  this->Coordinates.reserve(this->Columns.size() * this->Rows.size());
  for (std::size_t row = 0; row < this->Rows.size(); ++row)
  {
    for (std::size_t k = 0; k < this->Columns.size(); ++k)
    {
      const auto value = coordinate(row, k);
      if (!value)
      {
        if (this->HasDecimalCommas(this->Rows[row]))
        {
          failWithCommas(row);
        }
        fail(lineOfRow[row],
          "expected a coordinate in column " + std::to_string(this->Columns[k] + 1) + ", found \"" +
            this->Rows[row][this->Columns[k]] + "\"" +
            (this->Names.empty() ? " (--columns says which columns have coordinates)." : "."));
      }
      this->Coordinates.push_back(*value);
    }
  }
}

bool PointTable::FindNamed(const std::vector<std::string>& names)
{
  std::vector<std::size_t> found;
  for (const std::string& name : names)
  {
    found.push_back(this->FindColumn(name));
    if (found.back() == this->Rows[0].size())
    {
      return false;
    }
  }
  this->Columns = found;
  this->Names = this->Rows[0];
  return true;
}

std::size_t PointTable::FindColumn(const std::string& name) const
{
  // Two names may differ in their case only.
  const Row& first = this->Rows[0];
  auto place = std::find(first.begin(), first.end(), name);
  if (place == first.end())
  {
    place = std::find_if(first.begin(), first.end(),
      [&name](const std::string& field) { return Simplify(field) == Simplify(name); });
  }
  return static_cast<std::size_t>(place - first.begin());
}

std::string PointTable::ListColumns() const
{
  constexpr std::size_t most = 20;
  std::string list;
  for (std::size_t i = 0; i < this->Rows[0].size() && i < most; ++i)
  {
    list += (i > 0 ? ", \"" : "\"") + this->Rows[0][i] + "\"";
  }
  return list + (this->Rows[0].size() > most ? ", ..." : "");
}

bool PointTable::HasDecimalCommas(const Row& row) const
{
  const auto isOne = [](std::string field) {
    const std::size_t comma = field.find(',');
    field.replace(std::min(comma, field.size()), 1, ".");
    return comma != std::string::npos && ToNumber(field);
  };
  // Where commas have been taken for what separates columns, two numbers are left in one.
  const auto isRest = [](const std::string& field) {
    const std::size_t between = field.find_first_of("; \t", field.find_first_not_of("; \t"));
    return between != std::string::npos && ToNumber(field.substr(0, between)) &&
      ToNumber(field.substr(between + 1));
  };
  return this->Separator == ',' ? std::any_of(row.begin(), row.end(), isRest)
                                : std::any_of(row.begin(), row.end(), isOne);
}

void PointTable::ChooseColumns(const std::string& columns, const std::string& fileName)
{
  const Row& first = this->Rows[0];
  if (columns.empty())
  {
    if (std::any_of(UsualNames().begin(), UsualNames().end(),
          [this](const std::vector<std::string>& names) { return this->FindNamed(names); }))
    {
      return;
    }
    if (first.size() < 2)
    {
      throw Failure(FILE_TROUBLE, fileName + " has only one column: points need two coordinates.");
    }
    this->Columns = { 0, 1 };
    return;
  }
  std::istringstream list(columns);
  for (std::string name; std::getline(list, name, ',');)
  {
    // A number is never a name: in a table without names it may well be a coordinate.
    const auto number = ToNumber<std::size_t>(name);
    const std::size_t column = number ? *number - 1 : this->FindColumn(name);
    if (column >= first.size())
    {
      throw Failure(WRONG_USAGE,
        fileName + " has no column \"" + name + "\" (--columns): its first line has " +
          std::to_string(first.size()) + " columns, " + this->ListColumns() + ".");
    }
    if (std::find(this->Columns.begin(), this->Columns.end(), column) != this->Columns.end())
    {
      throw Failure(WRONG_USAGE,
        "Two coordinates cannot come from the same column, \"" + name + "\" (--columns).");
    }
    this->Columns.push_back(column);
    if (!number)
    {
      this->Names = first;
    }
  }
  if (this->Columns.size() < 2 || this->Columns.size() > 3)
  {
    throw Failure(WRONG_USAGE, "Two or three coordinate columns are needed (--columns).");
  }
}

vtkSmartPointer<vtkPolyData> PointTable::ToPoints() const
{
  const auto count = static_cast<vtkIdType>(this->Rows.size());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(count);
  vtkNew<vtkCellArray> vertices;
  vertices->AllocateExact(count, count);
  const std::size_t dimension = this->Columns.size();
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double* point = &this->Coordinates[dimension * static_cast<std::size_t>(i)];
    points->SetPoint(i, point[0], point[1], dimension == 3 ? point[2] : 0.0);
    vertices->InsertNextCell(1, &i);
  }
  auto data = vtkSmartPointer<vtkPolyData>::New();
  data->SetPoints(points);
  data->SetVerts(vertices);
  return data;
}

void PointTable::AddColumnsTo(vtkPolyData* points) const
{
  const std::size_t width =
    this->Names.empty() && !this->Rows.empty() ? this->Rows[0].size() : this->Names.size();
  vtkPointData* arrays = points->GetPointData();
  for (std::size_t column = 0; column < width; ++column)
  {
    if (std::find(this->Columns.begin(), this->Columns.end(), column) != this->Columns.end())
    {
      continue;
    }
    const std::string number = std::to_string(column + 1);
    std::string name = this->Names.empty() || Simplify(this->Names[column]).empty()
      ? "Column" + number
      : this->Names[column];
    // Of two arrays of one name, the second would be in the place of the first.
    while (arrays->HasArray(name.c_str()))
    {
      name += "_" + number;
    }
    const auto isNumber = [column](const Row& row) {
      return Simplify(row[column]).empty() || ToNumber(row[column]);
    };
    vtkSmartPointer<vtkAbstractArray> array;
    if (std::all_of(this->Rows.begin(), this->Rows.end(), isNumber))
    {
      vtkNew<vtkDoubleArray> values;
      for (const Row& row : this->Rows)
      {
        values->InsertNextValue(
          ToNumber(row[column]).value_or(std::numeric_limits<double>::quiet_NaN()));
      }
      array = values;
    }
    else
    {
      vtkNew<vtkStringArray> texts;
      for (const Row& row : this->Rows)
      {
        texts->InsertNextValue(row[column]);
      }
      array = texts;
    }
    array->SetName(name.c_str());
    arrays->AddArray(array);
  }
}

void PointTable::Update(vtkDataSet* data, bool moved)
{
  vtkDataArray* mask = moved ? data->GetPointData()->GetArray("vtkValidPointMask") : nullptr;
  for (std::size_t row = 0; row < this->Rows.size(); ++row)
  {
    double point[3];
    data->GetPoint(static_cast<vtkIdType>(row), point);
    if (mask && mask->GetTuple1(static_cast<vtkIdType>(row)) == 0.0)
    {
      std::fill_n(point, 3, std::numeric_limits<double>::quiet_NaN());
    }
    for (std::size_t k = 0; k < this->Columns.size(); ++k)
    {
      // What has not changed keeps its digits.
      double& coordinate = this->Coordinates[row * this->Columns.size() + k];
      if (coordinate != point[k])
      {
        coordinate = point[k];
        this->Rows[row][this->Columns[k]] = ToText(point[k]);
      }
    }
  }
  for (int i = 0; i < data->GetPointData()->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = data->GetPointData()->GetArray(i);
    if (!array || !array->GetName() ||
      array->GetName() == std::string(vtkDataSetAttributes::GhostArrayName()))
    {
      continue;
    }
    const int components = array->GetNumberOfComponents();
    for (int k = 0; k < components; ++k)
    {
      const std::string name =
        array->GetName() + (components > 1 ? "_" + std::to_string(k) : std::string());
      // A table that has been through here before has columns of these names.
      const auto found = std::find(this->Names.begin(), this->Names.end(), name);
      const auto column = static_cast<std::size_t>(found - this->Names.begin());
      const bool isNew = found == this->Names.end();
      if (isNew && !this->Names.empty())
      {
        this->Names.push_back(name);
      }
      for (std::size_t row = 0; row < this->Rows.size(); ++row)
      {
        const std::string text = ToText(array->GetComponent(static_cast<vtkIdType>(row), k));
        if (isNew)
        {
          this->Rows[row].push_back(text);
        }
        else
        {
          this->Rows[row][column] = text;
        }
      }
    }
  }
}

void PointTable::Write(std::ostream& file) const
{
  const auto write = [this, &file](const Row& row) {
    for (std::size_t i = 0; i < row.size(); ++i)
    {
      if (i > 0)
      {
        file << this->Separator;
      }
      if (!NeedsQuotes(row[i], this->Separator) && !(i == 0 && MisleadsAtBegin(row[i])))
      {
        file << row[i];
        continue;
      }
      file << '"';
      for (const char c : row[i])
      {
        file << (c == '"' ? "\"\"" : std::string(1, c));
      }
      file << '"';
    }
    file << '\n';
  };
  for (const std::string& comment : this->Comments)
  {
    file << comment << '\n';
  }
  if (!this->Names.empty())
  {
    write(this->Names);
  }
  for (const Row& row : this->Rows)
  {
    write(row);
  }
}

} // namespace dhm
