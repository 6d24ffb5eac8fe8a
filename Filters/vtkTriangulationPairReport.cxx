// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkTriangulationPairReport.h"

#include "Construction/MapStatistics.h"
#include "Construction/PairStatistics.h"
#include "Mesh/CubicHomeomorphism.h"
#include "Pipeline/DiagnosticMessages.h"
#include "Pipeline/Options.h"
#include "Pipeline/Requests.h"
#include "Pipeline/VTKVersions.h"

#include "vtkCallbackCommand.h"
#include "vtkCellData.h"
#include "vtkCommand.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkIntArray.h"
#include "vtkJacobianContinuity.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPolyData.h"
#include "vtkTable.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

using namespace homeomorphism;

vtkStandardNewMacro(vtkTriangulationPairReport);

namespace
{

constexpr double None = std::numeric_limits<double>::quiet_NaN();
constexpr std::array<const char*, 2> MeshNames{ "Source", "Target" };
constexpr std::array<const char*, 4> SystemNames{ "Linear", "Contour", "Smooth", "Cubic" };

/// A table of one row.
class Row
{
public:
  explicit Row(vtkTable* table)
    : Table(table)
  {
  }

  void Add(const std::string& name, double value) { this->AddTo<vtkDoubleArray>(name, value); }
  void Add(const std::string& name, bool value) { this->AddTo<vtkIntArray>(name, value ? 1 : 0); }
  void Add(const std::string& name, vtkIdType value) { this->AddTo<vtkIdTypeArray>(name, value); }
  void Add(const std::string& name, const Extreme& extreme)
  {
    this->Add(name, extreme.Value);
    this->Add(name + "Cell", extreme.Cell);
  }

private:
  template <typename Array, typename Value>
  void AddTo(const std::string& name, Value value)
  {
    vtkNew<Array> column;
    column->SetName(name.c_str());
    column->InsertNextValue(value);
    this->Table->AddColumn(column);
  }

  vtkTable* Table;
};

/// Adds a cell array with a value for each triangle, @a other for other cells.
template <typename Array, typename Values, typename Value>
void AddCellArray(vtkPolyData* mesh, const Triangulation& triangulation, const char* name,
  const Values& values, Value other)
{
  vtkNew<Array> array;
  array->SetName(name);
  array->SetNumberOfTuples(mesh->GetNumberOfCells());
  array->FillValue(static_cast<typename Array::ValueType>(other));
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    array->SetValue(triangulation.GetCellId(t),
      static_cast<typename Array::ValueType>(values[static_cast<std::size_t>(t)]));
  }
  mesh->GetCellData()->AddArray(array);
}

/// The statistics of the Cubic map.
struct CubicStatistics
{
  double BendingEnergy = None;
  Extreme Certificate;
  vtkIdType UncertifiedTriangles = -1;
  vtkIdType ExceptionalInteriorVertices = -1;
  vtkIdType ExceptionalBoundaryVertices = -1;
};

CubicStatistics MeasureCubic(const Homeomorphism& map)
{
  const CubicMapStatistics& known = map.GetCubic()->GetMap().GetStatistics();
  const Triangulation& triangulation = map.GetPair().GetTriangulation();
  CubicStatistics statistics;
  // Convert the energy from normalized coordinates to those of the input.
  const double rescale = map.GetPair().GetGeometry(Domain::Source).GetScale() /
    map.GetPair().GetGeometry(Domain::Target).GetScale();
  statistics.BendingEnergy = known.Bending.Energy * rescale * rescale;
  statistics.UncertifiedTriangles = known.UncertifiedTriangles;
  statistics.ExceptionalInteriorVertices =
    static_cast<vtkIdType>(known.ExceptionalInteriorPoints.size());
  statistics.ExceptionalBoundaryVertices =
    static_cast<vtkIdType>(known.ExceptionalBoundaryPoints.size());
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    if (!triangulation.IsMasked(t))
    {
      statistics.Certificate.TakeSmaller(
        map.GetCubic()->GetCertificate(t), triangulation.GetCellId(t));
    }
  }
  return statistics;
}

/// The results of vtkJacobianContinuity.
struct Continuity
{
  vtkIdType DifferentiableEdges = -1;
  vtkIdType Creases = -1;
  vtkIdType UndecidedEdges = -1;
  double LargestJump = None;
};

} // namespace

vtkTriangulationPairReport::vtkTriangulationPairReport()
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(4);
}

vtkTriangulationPairReport::~vtkTriangulationPairReport() = default;

vtkPolyData* vtkTriangulationPairReport::GetOutput(int port)
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(port));
}

vtkTable* vtkTriangulationPairReport::GetStatistics()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(2));
}

vtkTable* vtkTriangulationPairReport::GetDefects()
{
  return vtkTable::SafeDownCast(this->GetOutputDataObject(3));
}

double vtkTriangulationPairReport::GetStatistic(const char* column)
{
  vtkTable* table = this->GetStatistics();
  auto* array =
    table && column ? vtkDataArray::SafeDownCast(table->GetColumnByName(column)) : nullptr;
  return array && array->GetNumberOfTuples() > 0 ? array->GetTuple1(0) : None;
}

int vtkTriangulationPairReport::FillOutputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), port < 2 ? "vtkPolyData" : "vtkTable");
  return 1;
}

int vtkTriangulationPairReport::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->CheckInputTypes(inputs);
  MakeOutput<vtkPolyData>(outputs->GetInformationObject(0));
  MakeOutput<vtkPolyData>(outputs->GetInformationObject(1));
  MakeOutput<vtkTable>(outputs->GetInformationObject(2));
  MakeOutput<vtkTable>(outputs->GetInformationObject(3));
  return 1;
}

int vtkTriangulationPairReport::Execute(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const std::array<vtkPolyData*, 2> meshes{ vtkPolyData::GetData(inputs[0]),
    vtkPolyData::GetData(inputs[1]) };
  this->Valid = false;

  // If invalid triangles are left out, all kinds of defects are found and the rest can be measured.
  MeshDiagnostics defects;
  HomeomorphismOptions options;
  options.System = homeomorphism::CoordinateSystem::Linear;
  options.MaskInvalidTriangles = true;
  options.DiscordantByLinear = true;
  options.Cubic = GetOptions(this).Cubic;
  const std::shared_ptr<const Homeomorphism> linear =
    Homeomorphism::Make(meshes[0], meshes[1], options, defects);
  // Diagnostics of accepted meshes are information, not errors.
  this->Valid = linear && std::all_of(defects.begin(), defects.end(), [](const auto& defect) {
    return defect.Result == MeshDiagnostic::Outcome::Accepted;
  });
  if (!IsFirstPiece(request, outputs))
  {
    return 1;
  }
  std::array<vtkPolyData*, 2> measured;
  for (int side = 0; side < 2; ++side)
  {
    measured[static_cast<std::size_t>(side)] = vtkPolyData::GetData(outputs, side);
    measured[static_cast<std::size_t>(side)]->ShallowCopy(meshes[static_cast<std::size_t>(side)]);
  }
  Row row(vtkTable::GetData(outputs, 2));
  MakeTable(defects, vtkTable::GetData(outputs, 3));
  row.Add("Valid", this->Valid);
  row.Add("Measured", linear != nullptr);
  for (std::size_t side = 0; side < 2; ++side)
  {
    const std::string name = MeshNames[side];
    const PointCounts counts = CountPoints(meshes[side]);
    row.Add(name + "Points", vtkIdType(meshes[side]->GetNumberOfPoints()));
    row.Add(name + "Triangles", vtkIdType(meshes[side]->GetNumberOfPolys()));
    row.Add(name + "UnusedPoints", counts.Unused);
    row.Add(name + "DuplicatePoints", counts.Duplicate);
  }
  if (!linear)
  {
    return 1;
  }

  const TriangulationPair& pair = linear->GetPair();
  const Triangulation& triangulation = pair.GetTriangulation();
  const auto numberOfTriangles = static_cast<std::size_t>(triangulation.GetNumberOfTriangles());
  std::vector<bool> invalid(numberOfTriangles);
  vtkIdType numberOfInvalid = 0;
  for (std::size_t t = 0; t < numberOfTriangles; ++t)
  {
    invalid[t] = triangulation.IsMasked(static_cast<TriangleIndex>(t));
    numberOfInvalid += invalid[t];
  }
  const TriangulationCounts counts = CountConnections(triangulation);
  row.Add("InvalidTriangles", numberOfInvalid);
  row.Add("Mirrored", IsMirrored(pair));
  row.Add("Components", counts.Components);
  row.Add("InteriorEdges", counts.InteriorEdges);
  row.Add("BoundaryEdges", counts.BoundaryEdges);
  row.Add("BoundaryLoops", counts.BoundaryLoops);
  row.Add("OppositeWindings", counts.OppositeWindings);
  row.Add("ReorderedTriangles", CountReordered(meshes[0], meshes[1]));

  std::array<double, 2> meanEdges;
  for (std::size_t side = 0; side < 2; ++side)
  {
    const auto domain = static_cast<Domain>(side);
    const std::string name = MeshNames[side];
    const MeshShapes shapes = MeasureShapes(pair, domain);
    meanEdges[side] = shapes.MeanEdgeLength;
    row.Add(name + "Planar", pair.GetGeometry(domain).IsPlanar());
    row.Add(name + "Area", shapes.Area);
    row.Add(name + "MeanEdgeLength", shapes.MeanEdgeLength);
    row.Add(name + "SmallestAngle", shapes.SmallestAngle);
    row.Add(name + "ShareOfTrianglesBelow10Degrees", shapes.SharesOfSmallAngles[0]);
    row.Add(name + "ShareOfTrianglesBelow15Degrees", shapes.SharesOfSmallAngles[1]);
    row.Add(name + "ShareOfTrianglesBelow20Degrees", shapes.SharesOfSmallAngles[2]);
    row.Add(name + "LargestAreaRatio", shapes.LargestAreaRatio);
    row.Add(name + "DiscordantTriangles", shapes.DiscordantTriangles);
    AddCellArray<vtkDoubleArray>(
      measured[side], triangulation, "SmallestAngle", shapes.SmallestAngles, None);
    AddCellArray<vtkDoubleArray>(
      measured[side], triangulation, "AreaRatio", shapes.AreaRatios, None);
    AddCellArray<vtkUnsignedCharArray>(
      measured[side], triangulation, "Concordant", shapes.Concordant, 0);
    AddCellArray<vtkUnsignedCharArray>(measured[side], triangulation, "Invalid", invalid, 0);
  }
  const LinearMaps maps = MeasureLinearMaps(pair);
  row.Add("LargestStretch", maps.LargestStretch);
  row.Add("SmallestStretch", maps.SmallestStretch);
  row.Add("LargestDistortion", maps.LargestDistortion);
  for (vtkPolyData* mesh : measured)
  {
    AddCellArray<vtkDoubleArray>(mesh, triangulation, "Determinant", maps.Determinants, None);
    AddCellArray<vtkDoubleArray>(mesh, triangulation, "Distortion", maps.Distortions, None);
  }
  this->UpdateProgress(0.05);

  std::array<vtkNew<vtkPolyData>, 2> copies;
  for (std::size_t side = 0; side < 2; ++side)
  {
    copies[side]->ShallowCopy(meshes[side]);
  }
  // Suppress warnings about triangles that are left out; they are in the table of defects.
  vtkNew<vtkCallbackCommand> ignore;
  ignore->SetCallback([](vtkObject*, unsigned long, void*, void*) {});
  const bool hasCubic = pair.GetGeometry(Domain::Source).IsPlanar() &&
    pair.GetGeometry(Domain::Target).IsPlanar() &&
    options.Cubic.IsPossible(triangulation.GetNumberOfTriangles());
  for (int system = LINEAR; system <= CUBIC; ++system)
  {
    if (homeomorphism::ShouldAbort(this))
    {
      return 1;
    }
    const std::string name = SystemNames[static_cast<std::size_t>(system)];
    MapSamples samples;
    SecondDifference second;
    CubicStatistics cubic;
    const bool exists = system != CUBIC || hasCubic;
    if (this->MeasureMaps && exists)
    {
      options.System = static_cast<homeomorphism::CoordinateSystem>(system);
      options.Center = static_cast<homeomorphism::CenterPoint>(this->CenterPoint);
      MeshDiagnostics known;
      const std::shared_ptr<const Homeomorphism> map =
        Homeomorphism::Make(meshes[0], meshes[1], options, known);
      samples = SampleMap(*map, *linear);
      second = MeasureSecondDifference(*map, meanEdges[0], meanEdges[1]);
      if (map->GetCubic())
      {
        cubic = MeasureCubic(*map);
        cubic.BendingEnergy = this->CubicBending == LEAST ? cubic.BendingEnergy : None;
      }
      if (system == this->CoordinateSystem)
      {
        for (vtkPolyData* mesh : measured)
        {
          AddCellArray<vtkDoubleArray>(
            mesh, triangulation, "SmallestDeterminant", samples.SmallestDeterminants, None);
          AddCellArray<vtkDoubleArray>(
            mesh, triangulation, "LargestDeterminant", samples.LargestDeterminants, None);
          AddCellArray<vtkDoubleArray>(
            mesh, triangulation, "DeviationFromLinear", samples.Deviations, None);
        }
      }
    }
    row.Add(name + "SmallestDeterminant", samples.SmallestDeterminant);
    row.Add(name + "LargestDeterminant", samples.LargestDeterminant);
    row.Add(name + "Samples", samples.Samples);
    row.Add(name + "NotPositive", samples.NotPositive);
    row.Add(name + "DeviationFromLinear", samples.LargestDeviation);
    for (int axis = 0; axis < 3; ++axis)
    {
      row.Add(name + "DeviationFromLinear" + "XYZ"[axis],
        samples.LargestDeviation.Cell < 0 ? None
                                          : samples.DeviationPoint[static_cast<std::size_t>(axis)]);
    }
    row.Add(name + "SecondDifference", second.RootMeanSquare);
    row.Add(name + "SecondDifferenceSamples", second.Samples);
    if (system == CUBIC)
    {
      row.Add("CubicBendingEnergy", cubic.BendingEnergy);
      row.Add("CubicCertificate", cubic.Certificate);
      row.Add("CubicUncertifiedTriangles", cubic.UncertifiedTriangles);
      row.Add("CubicExceptionalInteriorVertices", cubic.ExceptionalInteriorVertices);
      row.Add("CubicExceptionalBoundaryVertices", cubic.ExceptionalBoundaryVertices);
    }
    this->UpdateProgress(0.05 + 0.23 * system + 0.08);

    Continuity continuity;
    if (this->MeasureContinuity && exists)
    {
      vtkNew<vtkJacobianContinuity> measure;
      measure->SetSourceData(copies[0]);
      measure->SetTargetData(copies[1]);
      CopyOptions(this, measure.Get());
      measure->SetCoordinateSystem(system);
      measure->SetDiscordantTriangles(vtkJacobianContinuity::USE_LINEAR);
      measure->SetMaskInvalidTriangles(true);
      measure->AddObserver(vtkCommand::WarningEvent, ignore);
      measure->Update();
      continuity = { measure->GetNumberOfDifferentiableEdges(), measure->GetNumberOfCreases(),
        measure->GetNumberOfUndecidedEdges(), measure->GetLargestJump() };
    }
    row.Add(name + "DifferentiableEdges", continuity.DifferentiableEdges);
    row.Add(name + "Creases", continuity.Creases);
    row.Add(name + "UndecidedEdges", continuity.UndecidedEdges);
    row.Add(name + "LargestJump", continuity.LargestJump);
    this->UpdateProgress(0.05 + 0.23 * (system + 1));
  }
  return 1;
}

void vtkTriangulationPairReport::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "MeasureMaps: " << this->MeasureMaps << "\n";
  os << indent << "MeasureContinuity: " << this->MeasureContinuity << "\n";
  os << indent << "Valid: " << this->Valid << "\n";
}
