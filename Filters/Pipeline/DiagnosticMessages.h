// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file DiagnosticMessages.h
/// Messages about defects of meshes.

#ifndef homeomorphism_DiagnosticMessages_h
#define homeomorphism_DiagnosticMessages_h

#include "Mesh/MeshDiagnostic.h"

#include <string>

class vtkObject;

namespace homeomorphism
{

/// The messages of the defects with an outcome, one to a line.
std::string DescribeProblems(const MeshDiagnostics& problems, MeshDiagnostic::Outcome outcome);

/// Errors for what made the meshes be refused, warnings for what was left out of them. That the
/// Linear system carries discordant triangles is no surprise to who asked for it, and shows in an
/// array.
void ReportProblems(vtkObject* self, const MeshDiagnostics& problems);

} // namespace homeomorphism

#endif
