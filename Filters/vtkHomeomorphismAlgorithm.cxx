// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkHomeomorphismAlgorithm.h"

#include "Mesh/CubicHomeomorphism.h"
#include "Pipeline/DiagnosticMessages.h"
#include "Pipeline/HomeomorphismCache.h"
#include "Pipeline/Options.h"
#include "Pipeline/PointBlocks.h"
#include "Pipeline/ProcessStatistics.h"
#include "Pipeline/Requests.h"

#include "vtkErrorCode.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkNew.h"
#include "vtkPolyData.h"
#include "vtkTable.h"

#include <algorithm>

using namespace homeomorphism;

class vtkHomeomorphismAlgorithm::Internals
{
public:
  HomeomorphismCache Cache;
  vtkNew<vtkTable> Diagnostics;
  ProcessStatistics Own{ { 0.0 }, { 0.0 } };
};

vtkHomeomorphismAlgorithm::vtkHomeomorphismAlgorithm()
  : Internal(new Internals)
{
  static_assert(
    int(MESHES_REFUSED) == int(vtkErrorCode::UserError), "The first code that is not VTK's");
}

vtkHomeomorphismAlgorithm::~vtkHomeomorphismAlgorithm() = default;

void vtkHomeomorphismAlgorithm::SetSourceConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(0, output);
}

void vtkHomeomorphismAlgorithm::SetSourceData(vtkPolyData* source)
{
  this->SetInputDataObject(0, source);
}

void vtkHomeomorphismAlgorithm::SetTargetConnection(vtkAlgorithmOutput* output)
{
  if (this->NumberOfMeshPorts < 2)
  {
    vtkErrorMacro(<< this->GetClassName() << " has no target mesh.");
    return;
  }
  this->SetInputConnection(1, output);
}

void vtkHomeomorphismAlgorithm::SetTargetData(vtkPolyData* target)
{
  if (this->NumberOfMeshPorts < 2)
  {
    vtkErrorMacro(<< this->GetClassName() << " has no target mesh.");
    return;
  }
  this->SetInputDataObject(1, target);
}

void vtkHomeomorphismAlgorithm::SetDataConnection(vtkAlgorithmOutput* output)
{
  this->SetInputConnection(this->NumberOfMeshPorts, output);
}

void vtkHomeomorphismAlgorithm::SetDataObject(vtkDataObject* data)
{
  this->SetInputDataObject(this->NumberOfMeshPorts, data);
}

int vtkHomeomorphismAlgorithm::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port < this->NumberOfMeshPorts)
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  }
  else
  {
    AcceptDataSetsAndTrees(info);
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  if (port < this->FirstPortInPieces)
  {
    info->Set(RequestedWhole(), 1);
  }
  return 1;
}

int vtkHomeomorphismAlgorithm::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port == 0 ? "vtkDataObject" : "vtkPolyData");
  return 1;
}

void vtkHomeomorphismAlgorithm::CheckInputTypes(vtkInformationVector** inputs)
{
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    if (!IsAcceptedType(this->GetInputPortInformation(port), vtkDataObject::GetData(inputs[port])))
    {
      // The executive reports the error.
      this->Fail(port < this->NumberOfMeshPorts ? MESHES_REFUSED : DATA_REFUSED);
    }
  }
}

int vtkHomeomorphismAlgorithm::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->CheckInputTypes(inputs);
  vtkDataObject* data = this->NumberOfMeshPorts < this->GetNumberOfInputPorts()
    ? vtkDataObject::GetData(inputs[this->NumberOfMeshPorts])
    : nullptr;
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    vtkInformation* outInfo = outputs->GetInformationObject(port);
    if (port == 0 && data)
    {
      MakeOutputLike(data, outInfo);
    }
    else
    {
      MakeOutput<vtkPolyData>(outInfo);
    }
  }
  return 1;
}

int vtkHomeomorphismAlgorithm::RequestInformation(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const int ports = this->GetNumberOfInputPorts();
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    // Only the first output is made from the data.
    DescribeTimesInOutput(inputs, port == 0 ? ports : std::min(ports, this->NumberOfMeshPorts),
      outputs->GetInformationObject(port));
  }
  if (this->FirstPortInPieces < ports)
  {
    DescribeDataInOutput(
      inputs[this->FirstPortInPieces]->GetInformationObject(0), outputs->GetInformationObject(0));
  }
  return 1;
}

int vtkHomeomorphismAlgorithm::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*)
{
  for (int port = 0; port < this->GetNumberOfInputPorts(); ++port)
  {
    if (port < this->FirstPortInPieces || this->DependsOnPortsBefore(port))
    {
      RequestWhole(inputs[port]->GetInformationObject(0));
    }
  }
  return 1;
}

int vtkHomeomorphismAlgorithm::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->SetErrorCode(vtkErrorCode::NoError);
  this->NumberOfOutsidePoints = 0;
  this->NumberOfDiscordantTriangles = 0;
  const int success = this->Execute(request, inputs, outputs);
  this->Internal->Own = { { static_cast<double>(this->NumberOfOutsidePoints) },
    { static_cast<double>(this->NumberOfDiscordantTriangles) } };
  this->SetProgressShiftScale(0.0, 1.0);
  if (success)
  {
    this->UpdateProgress(1.0);
    if (ShouldAbort(this))
    {
      this->SetErrorCode(UPDATE_ABORTED);
    }
  }
  return success;
}

std::shared_ptr<const Homeomorphism> vtkHomeomorphismAlgorithm::GetMap(
  vtkPolyData* source, vtkPolyData* target)
{
  HomeomorphismCache& cache = this->Internal->Cache;
  std::shared_ptr<const Homeomorphism> map = cache.Get(source, target, GetOptions(this));
  ReportProblems(this, cache.GetProblems());
  MakeTable(cache.GetProblems(), this->Internal->Diagnostics);
  if (!map)
  {
    this->Fail(MESHES_REFUSED);
  }
  CubicMapStatistics cubic;
  double scale = 1.0;
  if (map && map->GetCubic())
  {
    cubic = map->GetCubic()->GetMap().GetStatistics();
    // The scale of second derivatives times the square root of an area.
    scale = map->GetPair().GetGeometry(Domain::Target).GetInverseScale() *
      map->GetPair().GetGeometry(Domain::Source).GetScale();
    if (cubic.UncertifiedTriangles > 0)
    {
      vtkWarningMacro(<< "The Cubic map is not certified in " << cubic.UncertifiedTriangles
                      << (cubic.UncertifiedTriangles == 1 ? " triangle" : " triangles")
                      << " (array Certificate): doubles cannot represent its elements there. "
                         "Points in them are marked as outside. Use the Smooth system"
                      << (this->GetMaximumDeviation() < VTK_DOUBLE_MAX
                             ? ", or allow a larger MaximumDeviation."
                             : "."));
    }
  }
  this->NumberOfCubicElements = cubic.Elements;
  this->NumberOfCutTriangles = cubic.Bending.CutTriangles;
  this->NumberOfVertexRings = cubic.Rings;
  this->NumberOfBendingRounds = cubic.Bending.Rounds;
  this->BendingEnergy = cubic.Bending.Energy * scale * scale;
  this->NumberOfExceptionalInteriorVertices =
    static_cast<vtkIdType>(cubic.ExceptionalInteriorPoints.size());
  this->NumberOfExceptionalBoundaryVertices =
    static_cast<vtkIdType>(cubic.ExceptionalBoundaryPoints.size());
  this->NumberOfUncertifiedTriangles = cubic.UncertifiedTriangles;
  return map;
}

int vtkHomeomorphismAlgorithm::Fail(int errorCode)
{
  this->SetErrorCode(static_cast<unsigned long>(errorCode));
  this->NumberOfOutsidePoints = -1;
  this->Internal->Own.Sums[0] = -1.0;
  return 0;
}

bool vtkHomeomorphismAlgorithm::IsFirstPiece(vtkInformation* request, vtkInformationVector* outputs)
{
  return homeomorphism::IsFirstPiece(request, outputs);
}

bool vtkHomeomorphismAlgorithm::DependsOnPortsBefore(int port)
{
  return SharesUpstreamWithPortsBefore(this, port);
}

void vtkHomeomorphismAlgorithm::ReduceStatistics(vtkMultiProcessController* controller)
{
  const ProcessStatistics total = Total(this, this->Internal->Own, controller);
  this->NumberOfOutsidePoints = static_cast<vtkIdType>(total.Sums[0]);
  this->NumberOfDiscordantTriangles = static_cast<vtkIdType>(total.Largest[0]);
}

vtkTable* vtkHomeomorphismAlgorithm::GetDiagnostics()
{
  return this->Internal->Diagnostics;
}

vtkIdType vtkHomeomorphismAlgorithm::GetNumberOfMeshBuilds()
{
  return this->Internal->Cache.GetNumberOfBuilds();
}

void vtkHomeomorphismAlgorithm::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  PrintOptions(this, os, indent);
  os << indent << "NumberOfOutsidePoints: " << this->NumberOfOutsidePoints << "\n";
  os << indent << "NumberOfDiscordantTriangles: " << this->NumberOfDiscordantTriangles << "\n";
  os << indent << "NumberOfCubicElements: " << this->NumberOfCubicElements << "\n";
  os << indent << "NumberOfCutTriangles: " << this->NumberOfCutTriangles << "\n";
  os << indent << "NumberOfVertexRings: " << this->NumberOfVertexRings << "\n";
  os << indent << "NumberOfBendingRounds: " << this->NumberOfBendingRounds << "\n";
  os << indent << "BendingEnergy: " << this->BendingEnergy << "\n";
  os << indent
     << "NumberOfExceptionalInteriorVertices: " << this->NumberOfExceptionalInteriorVertices
     << "\n";
  os << indent
     << "NumberOfExceptionalBoundaryVertices: " << this->NumberOfExceptionalBoundaryVertices
     << "\n";
  os << indent << "NumberOfUncertifiedTriangles: " << this->NumberOfUncertifiedTriangles << "\n";
}
