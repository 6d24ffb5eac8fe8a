// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file DiagnosticMessages.h
/// Conversion of diagnostics to messages and to a table.

#ifndef homeomorphism_DiagnosticMessages_h
#define homeomorphism_DiagnosticMessages_h

#include "Mesh/MeshDiagnostic.h"

#include "vtkType.h"

#include <string>
#include <vector>

class vtkObject;
class vtkTable;

namespace homeomorphism
{

/// The first ten ids: "1, 2, 5", or "0, 1, 2, 3, 4, 5, 6, 7, 8, 9, ..." if there are more.
std::string ListIds(const std::vector<vtkIdType>& ids);

/// The name of a kind in tables: "DegenerateTriangle".
const char* GetName(MeshDiagnostic::Kind kind);
/// The name of a mesh in messages and tables: "source".
const char* GetName(MeshDiagnostic::Mesh mesh);
/// The name of an outcome in tables: "masked".
const char* GetName(MeshDiagnostic::Outcome outcome);
/// The name of a remedy in tables: "RepairOrMask".
const char* GetName(MeshDiagnostic::Remedy remedy);

/// One or two sentences: the number of defective triangles, their mesh, the defect, the first ids,
/// and the remedy.
std::string Describe(const MeshDiagnostic& diagnostic);

/// The messages of the diagnostics with an outcome, one per line.
std::string DescribeProblems(const MeshDiagnostics& diagnostics, MeshDiagnostic::Outcome outcome);

/// Reports refused meshes as an error and masked triangles as a warning. The other diagnostics are
/// debug output, because they do not affect the result.
void ReportProblems(vtkObject* self, const MeshDiagnostics& diagnostics);

/// Makes a table with one row for each diagnostic. The columns are Kind, Domain, Outcome and Remedy
/// (strings), Count (the number of defective triangles; 0 if a mesh is defective as a whole),
/// FirstCount and SecondCount (the two numbers that differ or are too large), Size, Tolerance,
/// Position (3 components), FirstId, Message and Defect. The field data array Ids has the cell ids
/// of all rows; those of row i are the elements FirstId[i] to FirstId[i] + Count[i] - 1.
void MakeTable(const MeshDiagnostics& diagnostics, vtkTable* table);

} // namespace homeomorphism

#endif
