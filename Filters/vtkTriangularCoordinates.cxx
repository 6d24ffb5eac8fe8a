// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkTriangularCoordinates.h"

#include "Pipeline/CompositeData.h"
#include "Pipeline/CoordinateLines.h"
#include "Pipeline/GhostArrays.h"
#include "Pipeline/PointBlocks.h"
#include "Pipeline/PointsOffSurface.h"
#include "Pipeline/Requests.h"

#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <limits>

using namespace homeomorphism;

vtkStandardNewMacro(vtkTriangularCoordinates);

namespace
{

template <typename ArrayType>
vtkSmartPointer<ArrayType> NewArray(const char* name, vtkIdType tuples, int components = 1)
{
  auto array = vtkSmartPointer<ArrayType>::New();
  array->SetName(name);
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(tuples);
  return array;
}

/// Point arrays of the coordinates of the points of a data set.
class PointCoordinates
{
public:
  explicit PointCoordinates(vtkIdType points)
    : Triangle(NewArray<vtkIdTypeArray>("TriangleId", points))
    , Edge(NewArray<vtkIntArray>("EdgeLabel", points))
    , EdgeParameter(NewArray<vtkDoubleArray>("EdgeParameter", points))
    , ContourParameter(NewArray<vtkDoubleArray>("ContourParameter", points))
    , Mask(NewArray<vtkUnsignedCharArray>("vtkValidPointMask", points))
  {
    this->Triangle->FillValue(-1);
    this->Edge->FillValue(0);
    this->EdgeParameter->FillValue(vtkMath::Nan());
    this->ContourParameter->FillValue(vtkMath::Nan());
    this->Mask->FillValue(0);
  }

  void Set(vtkIdType point, vtkIdType triangle, const TriangularCoordinates& coordinates)
  {
    this->Triangle->SetValue(point, triangle);
    this->Edge->SetValue(point, coordinates.Edge);
    this->EdgeParameter->SetValue(point, coordinates.EdgeParameter);
    this->ContourParameter->SetValue(point, coordinates.ContourParameter);
    this->Mask->SetValue(point, 1);
  }

  vtkUnsignedCharArray* GetMask() const { return this->Mask; }

  void AddTo(vtkPointData* pointData) const
  {
    pointData->AddArray(this->Triangle);
    pointData->AddArray(this->Edge);
    pointData->AddArray(this->EdgeParameter);
    pointData->AddArray(this->ContourParameter);
    pointData->AddArray(this->Mask);
  }

private:
  vtkSmartPointer<vtkIdTypeArray> Triangle;
  vtkSmartPointer<vtkIntArray> Edge;
  vtkSmartPointer<vtkDoubleArray> EdgeParameter;
  vtkSmartPointer<vtkDoubleArray> ContourParameter;
  vtkSmartPointer<vtkUnsignedCharArray> Mask;
};

/// The angle at the corner opposite the shortest edge, in degrees.
double SmallestAngle(const EdgeViews& views)
{
  int shortest = 0;
  for (int k = 1; k < 3; ++k)
  {
    shortest = views[k].Length < views[shortest].Length ? k : shortest;
  }
  // The tangent of the angle is the height of the corner opposite another edge, divided by the
  // distance of its foot from the start of that edge. The edge starts at the corner opposite the
  // shortest edge.
  const EdgeView& beside = views[PreviousCorner(shortest)];
  return vtkMath::DegreesFromRadians(std::atan2(beside.Height, beside.Foot * beside.Length));
}

/// The least distance of a foot of the centroid from an end of its edge, divided by the length of
/// the edge.
double ConcordanceMargin(const EdgeViews& views)
{
  double margin = 1.0;
  for (const EdgeView& view : views)
  {
    const double foot = (1.0 + view.Foot) / 3.0;
    margin = std::min({ margin, foot, 1.0 - foot });
  }
  return margin;
}

/// Cell arrays that describe each triangle. Returns the number of discordant ones.
vtkIdType DescribeTriangles(const Homeomorphism& map, vtkPolyData* triangulation)
{
  const vtkIdType cells = triangulation->GetNumberOfCells();
  const auto concordant = NewArray<vtkUnsignedCharArray>("Concordant", cells);
  const auto margin = NewArray<vtkDoubleArray>("ConcordanceMargin", cells);
  const auto used = NewArray<vtkIntArray>("UsedCoordinateSystem", cells);
  const auto angle = NewArray<vtkDoubleArray>("SmallestAngle", cells);
  const auto width = NewArray<vtkDoubleArray>("StripWidth", cells, 3);
  const auto bound = NewArray<vtkDoubleArray>("DeterminantBound", cells);
  concordant->FillValue(0);
  margin->FillValue(vtkMath::Nan());
  used->FillValue(-1);
  angle->FillValue(vtkMath::Nan());
  width->FillValue(vtkMath::Nan());
  bound->FillValue(vtkMath::Nan());

  const Triangulation& topology = map.GetPair().GetTriangulation();
  const MeshGeometry& geometry = map.GetPair().GetGeometry(Domain::Source);
  vtkSMPTools::For(0, topology.GetNumberOfTriangles(), [&](vtkIdType begin, vtkIdType end) {
    for (auto t = static_cast<TriangleIndex>(begin); t < end; ++t)
    {
      if (topology.IsMasked(t))
      {
        continue;
      }
      const vtkIdType cell = topology.GetCellId(t);
      const EdgeViews views = geometry.GetViews(topology.GetCorners(t));
      concordant->SetValue(cell, geometry.IsConcordant(topology.GetCorners(t)) ? 1 : 0);
      margin->SetValue(cell, ConcordanceMargin(views));
      used->SetValue(cell, static_cast<int>(map.GetCharts(Domain::Source).GetSystemOf(t)));
      angle->SetValue(cell, SmallestAngle(views));
      const SmoothChart smooth(geometry.GetShape(t), views, UnfoldNeighbors(topology, geometry, t));
      bound->SetValue(cell, smooth.DeterminantBound());
      for (int k = 0; k < 3; ++k)
      {
        width->SetTypedComponent(cell, k, smooth.StripWidth(k));
      }
    }
  });
  vtkIdType discordant = 0;
  for (TriangleIndex t = 0; t < topology.GetNumberOfTriangles(); ++t)
  {
    discordant += !topology.IsMasked(t) && concordant->GetValue(topology.GetCellId(t)) == 0;
  }
  for (vtkDataArray* array :
    std::initializer_list<vtkDataArray*>{ concordant, margin, used, angle, width, bound })
  {
    triangulation->GetCellData()->AddArray(array);
  }
  return discordant;
}

} // namespace

vtkTriangularCoordinates::vtkTriangularCoordinates()
{
  this->NumberOfMeshPorts = 1;
  this->FirstPortInPieces = 1;
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(3);
}

vtkTriangularCoordinates::~vtkTriangularCoordinates() = default;

int vtkTriangularCoordinates::Execute(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPolyData* triangulation = vtkPolyData::GetData(inputs[0]);
  vtkDataObject* data = vtkDataObject::GetData(inputs[1]);
  vtkDataObject* output = vtkDataObject::GetData(outputs, 0);
  vtkPolyData* lines = vtkPolyData::GetData(outputs, 1);
  vtkPolyData* described = vtkPolyData::GetData(outputs, 2);
  if (this->CoordinateSystem == CUBIC)
  {
    vtkErrorMacro(<< "The Cubic system has no triangular coordinates: use the Linear, Contour or "
                     "Smooth system.");
    return this->Fail(MESHES_REFUSED);
  }
  const std::shared_ptr<const Homeomorphism> map = this->GetMap(triangulation, nullptr);
  if (!map)
  {
    return 0;
  }

  const bool isFirstPiece = IsFirstPiece(request, outputs);
  const vtkNew<vtkPolyData> triangles;
  triangles->ShallowCopy(triangulation);
  this->NumberOfDiscordantTriangles = DescribeTriangles(*map, triangles);
  if (isFirstPiece)
  {
    described->ShallowCopy(triangles);
  }
  if (this->GenerateLines && isFirstPiece)
  {
    MakeCoordinateLines(
      this, *map, { this->NumberOfContours, this->NumberOfRings, this->LineResolution }, lines);
  }

  const auto addCoordinates = [this, &map](vtkDataSet* input, vtkDataSet* result) {
    result->ShallowCopy(input);
    const vtkIdType count = input->GetNumberOfPoints();
    PointCoordinates coordinates(count);
    const double tolerance =
      map->GetAbsoluteTolerance(Domain::Source, this->Tolerance, PrecisionOfPoints(input));
    RunInBlocks(this, count, 0.1, 1.0, [&](vtkIdType begin, vtkIdType end) {
      LocationHint hint;
      PointBlock block;
      for (vtkIdType first = begin; first < end; first += PointBlock::Capacity)
      {
        block.Count = static_cast<int>(std::min<vtkIdType>(PointBlock::Capacity, end - first));
        ReadPoints(input, first, block);
        map->LocateBlock(Domain::Source, block, tolerance, hint);
        for (int i = 0; i < block.Count; ++i)
        {
          if (block.Triangles[i] >= 0)
          {
            coordinates.Set(first + i,
              map->GetPair().GetTriangulation().GetCellId(block.Triangles[i]),
              map->GetCoordinates(Domain::Source, block.GetSurfacePoint(i)));
          }
        }
      }
    });
    coordinates.AddTo(result->GetPointData());
    this->NumberOfOutsidePoints += CountOutside(input, coordinates.GetMask());
    WarnOfPointsOffSurface(this, *map, Domain::Source, input, coordinates.GetMask());
  };

  if (!isFirstPiece && (!data || this->DependsOnPortsBefore(1)))
  {
    return 1;
  }
  if (auto* tree = vtkCompositeDataSet::SafeDownCast(data))
  {
    ConvertLeaves(this, tree, vtkCompositeDataSet::SafeDownCast(output), [&](vtkDataSet* leaf) {
      const auto result = vtkSmartPointer<vtkDataSet>::Take(leaf->NewInstance());
      addCoordinates(leaf, result);
      return result;
    });
  }
  else if (data)
  {
    addCoordinates(vtkDataSet::SafeDownCast(data), vtkDataSet::SafeDownCast(output));
  }
  else
  {
    // Without separate data, the triangulation gets the coordinates in addition to its cell arrays.
    addCoordinates(triangles, vtkDataSet::SafeDownCast(output));
  }
  return 1;
}

vtkPolyData* vtkTriangularCoordinates::GetLines()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(1));
}

vtkPolyData* vtkTriangularCoordinates::GetTriangulation()
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(2));
}

void vtkTriangularCoordinates::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "GenerateLines: " << this->GenerateLines << "\n";
  os << indent << "NumberOfContours: " << this->NumberOfContours << "\n";
  os << indent << "NumberOfRings: " << this->NumberOfRings << "\n";
  os << indent << "LineResolution: " << this->LineResolution << "\n";
}
