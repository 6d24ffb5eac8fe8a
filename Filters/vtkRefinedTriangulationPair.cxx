// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkRefinedTriangulationPair.h"

#include "Construction/PairRefinement.h"
#include "Pipeline/DiagnosticMessages.h"
#include "Pipeline/Requests.h"
#include "Pipeline/VTKVersions.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkSmartPointer.h"

#include <array>

using namespace homeomorphism;

vtkStandardNewMacro(vtkRefinedTriangulationPair);

namespace
{

/// The attributes without arrays of a different length, in which VTK would read out of bounds.
template <typename Attributes>
vtkSmartPointer<Attributes> Complete(Attributes* attributes, vtkIdType tuples)
{
  auto complete = vtkSmartPointer<Attributes>::New();
  complete->ShallowCopy(attributes);
  for (int i = complete->GetNumberOfArrays() - 1; i >= 0; --i)
  {
    if (complete->GetAbstractArray(i)->GetNumberOfTuples() != tuples)
    {
      complete->RemoveArray(i);
    }
  }
  return complete;
}

/// One of the finer meshes, made from the original one.
void MakeMesh(vtkPolyData* original, const Triangulation& triangulation, const RefinedPair& refined,
  Domain domain, vtkPolyData* mesh)
{
  const vtkIdType oldPoints = original->GetNumberOfPoints();
  const auto newPoints = static_cast<vtkIdType>(refined.NewPoints.size());
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(oldPoints + newPoints);
  for (vtkIdType i = 0; i < oldPoints; ++i)
  {
    double p[3];
    original->GetPoint(i, p);
    points->SetPoint(i, p);
  }
  const auto oldPointData = Complete(original->GetPointData(), oldPoints);
  vtkPointData* pointData = mesh->GetPointData();
  pointData->InterpolateAllocate(oldPointData, oldPoints + newPoints);
  for (vtkIdType i = 0; i < oldPoints; ++i)
  {
    pointData->CopyData(oldPointData, i, i);
  }
  vtkNew<vtkIdList> corners;
  corners->SetNumberOfIds(3);
  for (vtkIdType i = 0; i < newPoints; ++i)
  {
    const RefinedPair::Point& point = refined.NewPoints[static_cast<std::size_t>(i)];
    points->SetPoint(oldPoints + i,
      refined.NewPositions[static_cast<std::size_t>(domain)][static_cast<std::size_t>(i)].data());
    std::array<double, 3> weights = point.Weights;
    for (int k = 0; k < 3; ++k)
    {
      corners->SetId(k, triangulation.GetCorners(point.Triangle)[static_cast<std::size_t>(k)]);
    }
    pointData->InterpolatePoint(oldPointData, oldPoints + i, corners, weights.data());
  }
  vtkNew<vtkCellArray> triangles;
  vtkNew<vtkIdTypeArray> originals;
  originals->SetName("OriginalCellIds");
  const auto numberOfTriangles = static_cast<vtkIdType>(refined.Triangles.size());
  originals->SetNumberOfTuples(numberOfTriangles);
  const auto oldCellData = Complete(original->GetCellData(), original->GetNumberOfCells());
  vtkCellData* cellData = mesh->GetCellData();
  cellData->CopyAllocate(oldCellData, numberOfTriangles);
  for (vtkIdType i = 0; i < numberOfTriangles; ++i)
  {
    const auto n = static_cast<std::size_t>(i);
    const vtkIdType cell = triangulation.GetCellId(refined.Originals[n]);
    triangles->InsertNextCell(3, refined.Triangles[n].data());
    originals->SetValue(i, cell);
    cellData->CopyData(oldCellData, cell, i);
  }
  mesh->SetPoints(points);
  mesh->SetPolys(triangles);
  cellData->AddArray(originals);
}

} // namespace

vtkRefinedTriangulationPair::vtkRefinedTriangulationPair()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

vtkRefinedTriangulationPair::~vtkRefinedTriangulationPair() = default;

vtkPolyData* vtkRefinedTriangulationPair::GetOutput(int port)
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(port));
}

int vtkRefinedTriangulationPair::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkPolyData");
  return 1;
}

int vtkRefinedTriangulationPair::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->CheckInputTypes(inputs);
  MakeOutput<vtkPolyData>(outputs->GetInformationObject(0));
  MakeOutput<vtkPolyData>(outputs->GetInformationObject(1));
  return 1;
}

int vtkRefinedTriangulationPair::Execute(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPolyData* source = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* target = vtkPolyData::GetData(inputs[1]);
  this->Result = INVALID;
  this->LargestError = 0.0;
  this->NumberOfSamples = 0;
  const std::shared_ptr<const Homeomorphism> map = this->GetMap(source, target);
  if (!map)
  {
    return 0;
  }
  if (!IsFirstPiece(request, outputs))
  {
    this->Result = REFINED;
    return 1;
  }
  const Triangulation& triangulation = map->GetPair().GetTriangulation();
  vtkIdType triangles = 0;
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    triangles += triangulation.IsMasked(t) ? 0 : 1;
  }
  if (triangles > this->MaximumNumberOfTriangles)
  {
    this->Result = TOO_MANY_TRIANGLES;
    vtkErrorMacro(<< "The pair has " << triangles << " triangles, more than "
                  << this->MaximumNumberOfTriangles << ". Increase MaximumNumberOfTriangles.");
    return this->Fail(MESHES_REFUSED);
  }
  const MeshGeometry& targetGeometry = map->GetPair().GetGeometry(Domain::Target);
  const double maximumError = this->MaximumError > 0.0
    ? this->MaximumError
    : 1e-4 * targetGeometry.GetDiagonal() * targetGeometry.GetInverseScale();
  const RefinedPair refined = Refine(*map, source, target, maximumError,
    this->MaximumNumberOfTriangles, [this] { return homeomorphism::ShouldAbort(this); });
  this->LargestError = refined.LargestError;
  this->NumberOfSamples = refined.Samples;
  switch (refined.Result)
  {
    case RefinedPair::Outcome::Refined:
      break;
    case RefinedPair::Outcome::TooManyTriangles:
      this->Result = TOO_MANY_TRIANGLES;
      vtkErrorMacro(<< "More than " << this->MaximumNumberOfTriangles
                    << " triangles are needed for a maximum error of " << maximumError
                    << "; the error is still " << refined.LargestError
                    << ". Increase MaximumError or MaximumNumberOfTriangles.");
      return this->Fail(MESHES_REFUSED);
    case RefinedPair::Outcome::BelowRounding:
      this->Result = BELOW_ROUNDING;
      vtkErrorMacro(<< "A maximum error of " << maximumError
                    << " is below the rounding of the coordinates; the error is still "
                    << refined.LargestError << ". Increase MaximumError.");
      return this->Fail(MESHES_REFUSED);
    case RefinedPair::Outcome::Aborted:
      this->Result = ABORTED;
      return 1;
  }

  std::array<vtkNew<vtkPolyData>, 2> meshes;
  MakeMesh(source, triangulation, refined, Domain::Source, meshes[0]);
  MakeMesh(target, triangulation, refined, Domain::Target, meshes[1]);
  MeshDiagnostics problems;
  if (!TriangulationPair::Read(meshes[0], meshes[1], false, problems))
  {
    vtkErrorMacro(<< "The finer meshes are invalid because coordinates are rounded. Increase "
                     "MaximumError. "
                  << DescribeProblems(problems, MeshDiagnostic::Outcome::Refused));
    return this->Fail(MESHES_REFUSED);
  }
  this->Result = REFINED;
  vtkPolyData::GetData(outputs, 0)->ShallowCopy(meshes[0]);
  vtkPolyData::GetData(outputs, 1)->ShallowCopy(meshes[1]);
  return 1;
}

void vtkRefinedTriangulationPair::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MaximumError: " << this->MaximumError << "\n";
  os << indent << "MaximumNumberOfTriangles: " << this->MaximumNumberOfTriangles << "\n";
  os << indent << "Result: " << this->Result << "\n";
  os << indent << "LargestError: " << this->LargestError << "\n";
  os << indent << "NumberOfSamples: " << this->NumberOfSamples << "\n";
}
