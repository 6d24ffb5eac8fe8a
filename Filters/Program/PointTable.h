// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file PointTable.h
/// Points as text: one to a line, coordinates and anything else in columns.

#ifndef dhm_PointTable_h
#define dhm_PointTable_h

#include "vtkDataSet.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <iosfwd>
#include <string>
#include <vector>

namespace dhm
{

/// A table of points. What is no coordinate stays text.
class PointTable
{
public:
  /// Whether the format is one of point tables (csv, txt, xyz).
  static bool IsFormat(const std::string& format);

  /// Reads a table. The separator is the one of comma, semicolon and tab that the first line has
  /// most of, else blanks. Fields may be in double quotes; lines that begin with # are kept at the
  /// top. The first line has the columns' names if its coordinates are no numbers. @a columns are
  /// the names or numbers (from 1) of two or three coordinate columns, separated by commas; empty:
  /// those with names that are usual for coordinates, such as x, y (and z), or E, N; of a table
  /// without names, the first two. Case, and blanks around names, do not matter. Throws Failure,
  /// naming file and line.
  PointTable(std::istream& file, const std::string& fileName, const std::string& columns);

  /// The points as vertices, in double precision; z is 0 if there is none.
  vtkSmartPointer<vtkPolyData> ToPoints() const;

  /// Gives the points the columns that are no coordinates as arrays: of numbers (empty fields are
  /// nan) or, where a field is none, of strings.
  void AddColumnsTo(vtkPolyData* points) const;

  /// Takes the coordinates from @a data, and its point arrays as columns, in the place of columns
  /// of the same names. If points were moved, coordinates of those that `vtkValidPointMask` leaves
  /// out become nan. z stays if there is no column for it.
  void Update(vtkDataSet* data, bool moved);

  void Write(std::ostream& file) const;

private:
  using Row = std::vector<std::string>;

  void ChooseColumns(const std::string& columns, const std::string& fileName);
  bool FindNamed(const std::vector<std::string>& names);
  /// The column of a name; the number of columns if there is none.
  std::size_t FindColumn(const std::string& name) const;
  /// The first line's fields, for messages.
  std::string ListColumns() const;
  /// Whether a row has numbers with commas in the place of points.
  bool HasDecimalCommas(const Row& row) const;

  std::vector<std::string> Comments;
  /// Empty if the table has no names.
  Row Names;
  std::vector<Row> Rows;
  std::vector<double> Coordinates;
  /// Where the two or three coordinates are.
  std::vector<std::size_t> Columns;
  /// Blank: any number of blanks.
  char Separator = ',';
};

} // namespace dhm

#endif
