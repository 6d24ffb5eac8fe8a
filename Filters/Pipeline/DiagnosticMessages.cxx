// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "DiagnosticMessages.h"

#include "vtkObject.h"

namespace homeomorphism
{

std::string DescribeProblems(const MeshDiagnostics& problems, MeshDiagnostic::Outcome outcome)
{
  std::string text;
  for (const MeshDiagnostic& problem : problems)
  {
    if (problem.Result == outcome)
    {
      text += (text.empty() ? "" : "\n") + problem.Message();
    }
  }
  return text;
}

void ReportProblems(vtkObject* self, const MeshDiagnostics& problems)
{
  const std::string errors = DescribeProblems(problems, MeshDiagnostic::Outcome::Refused);
  const std::string warnings = DescribeProblems(problems, MeshDiagnostic::Outcome::Masked);
  if (!errors.empty())
  {
    vtkErrorWithObjectMacro(self, << errors);
  }
  if (!warnings.empty())
  {
    vtkWarningWithObjectMacro(self, << warnings);
  }
  vtkDebugWithObjectMacro(
    self, << DescribeProblems(problems, MeshDiagnostic::Outcome::MappedByLinear));
}

} // namespace homeomorphism
