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
  /// those named x, y (and z), else E, N, or easting, northing, whatever the case, else the first
  /// two. Throws Failure, naming file and line.
  PointTable(std::istream& file, const std::string& fileName, const std::string& columns);

  /// The points as vertices, in double precision; z is 0 if there is none.
  vtkSmartPointer<vtkPolyData> ToPoints() const;

  /// Takes the coordinates from @a data, and adds those of its point arrays as columns that @a
  /// before does not have. If points were moved, coordinates of those that `ValidPointMask` leaves
  /// out become nan. z
  /// stays if there is no column for it.
  void Update(vtkDataSet* before, vtkDataSet* data, bool moved);

  void Write(std::ostream& file) const;

private:
  using Row = std::vector<std::string>;

  void ChooseColumns(const std::string& columns, const std::string& fileName);
  bool FindNamed(const std::vector<std::string>& names);

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
