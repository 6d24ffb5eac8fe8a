// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkResampleThroughHomeomorphism.h"

#include "Pipeline/AttributeTransformation.h"
#include "Pipeline/CellPoints.h"
#include "Pipeline/DiagnosticMessages.h"
#include "Pipeline/GhostArrays.h"
#include "Pipeline/ImageSampling.h"
#include "Pipeline/Options.h"
#include "Pipeline/PointBlocks.h"
#include "Pipeline/Requests.h"
#include "Pipeline/VTKVersions.h"

#include "Mesh/MeshValidation.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataProbeFilter.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataObjectTree.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

using namespace homeomorphism;

vtkStandardNewMacro(vtkResampleThroughHomeomorphism);

namespace
{

constexpr const char* maskName = "vtkValidPointMask";

/// Passes the ghost arrays.
void PassGhosts(vtkDataSetAttributes* from, vtkDataSetAttributes* to)
{
  if (vtkAbstractArray* ghosts = from->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()))
  {
    to->AddArray(ghosts);
  }
}

/// The values of the data at points, with a mask of the points that have values.
vtkSmartPointer<vtkPointSet> FindValues(vtkPoints* points, vtkDataObject* data)
{
  vtkNew<vtkPolyData> wanted;
  wanted->SetPoints(points);
  vtkNew<vtkCompositeDataProbeFilter> probe;
  probe->SetInputData(wanted);
  probe->SetSourceData(data);
  probe->SetValidPointMaskArrayName(maskName);
  probe->Update();
  return vtkPointSet::SafeDownCast(probe->GetOutputDataObject(0));
}

/// Searches again for points without values, after move(i, point) has moved them.
template <typename Move>
void FillGaps(vtkPointSet* found, vtkDataObject* data, Move&& move)
{
  vtkDataArray* hasValues = found->GetPointData()->GetArray(maskName);
  vtkNew<vtkPoints> moved;
  moved->SetDataTypeToDouble();
  std::vector<vtkIdType> gaps;
  for (vtkIdType i = 0; hasValues && i < found->GetNumberOfPoints(); ++i)
  {
    if (hasValues->GetTuple1(i) == 0.0)
    {
      double point[3];
      found->GetPoint(i, point);
      move(i, point);
      moved->InsertNextPoint(point);
      gaps.push_back(i);
    }
  }
  if (gaps.empty())
  {
    return;
  }
  const vtkSmartPointer<vtkPointSet> again = FindValues(moved, data);
  for (int a = 0; a < found->GetPointData()->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = found->GetPointData()->GetArray(a);
    vtkDataArray* values =
      array && array->GetName() ? again->GetPointData()->GetArray(array->GetName()) : nullptr;
    for (std::size_t i = 0; values && i < gaps.size(); ++i)
    {
      array->SetTuple(gaps[i], static_cast<vtkIdType>(i), values);
    }
  }
}

/// Collects ids for a message: their number, and the first of them.
class DefectiveIds
{
public:
  void Add(vtkIdType id) { this->Ids.push_back(id); }
  bool IsEmpty() const { return this->Ids.empty(); }
  /// "2 points of the data (points 3, 5) have".
  std::string Describe(const std::string& what) const
  {
    const bool one = this->Ids.size() == 1;
    return std::to_string(this->Ids.size()) + " " + what + (one ? "" : "s") + " of the data (" +
      what + (one ? " " : "s ") + ListIds(this->Ids) + (one ? ") has" : ") have");
  }

private:
  std::vector<vtkIdType> Ids;
};

/// The first array of some attributes that does not have one value for each point or cell; empty if
/// there is none.
std::string DescribeArrays(
  vtkDataSetAttributes* attributes, const std::string& what, vtkIdType count)
{
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* array = attributes->GetAbstractArray(i);
    if (array->GetNumberOfTuples() != count)
    {
      return "The " + what + " array " +
        (array->GetName() ? array->GetName() : "(without a name)") + " of the data has " +
        std::to_string(array->GetNumberOfTuples()) + " values for " + std::to_string(count) + " " +
        what + "s. Remove it (vtkPassSelectedArrays) or complete it.";
    }
  }
  return "";
}

/// A defect that would make VTK's locators and interpolation read out of bounds; empty if there is
/// none.
std::string DescribeDefects(vtkDataSet* data)
{
  // The cell arrays, each with the least number of points of its cells.
  std::vector<std::pair<vtkCellArray*, vtkIdType>> arrays;
  if (auto* mesh = vtkPolyData::SafeDownCast(data))
  {
    arrays = { { mesh->GetVerts(), 1 }, { mesh->GetLines(), 2 }, { mesh->GetPolys(), 3 },
      { mesh->GetStrips(), 3 } };
  }
  else if (auto* unstructured = vtkUnstructuredGrid::SafeDownCast(data))
  {
    arrays = { { unstructured->GetCells(), 0 } };
  }
  const vtkIdType numberOfPoints = data->GetNumberOfPoints();
  DefectiveIds cells;
  DefectiveIds small;
  vtkIdType first = 0;
  for (const auto& [array, least] : arrays)
  {
    if (array && !array->IsValid())
    {
      return "The offsets of the data's cells do not fit their points. The data is corrupt: "
             "read or build it again.";
    }
    vtkNew<vtkIdList> ids;
    for (vtkIdType cell = 0; array && cell < array->GetNumberOfCells(); ++cell)
    {
      array->GetCellAtId(cell, ids);
      if (std::any_of(ids->begin(), ids->end(),
            [numberOfPoints](vtkIdType id) { return id < 0 || id >= numberOfPoints; }))
      {
        cells.Add(first + cell);
      }
      else if (ids->GetNumberOfIds() < least)
      {
        small.Add(first + cell);
      }
    }
    first += array ? array->GetNumberOfCells() : 0;
  }
  if (!cells.IsEmpty())
  {
    return cells.Describe("cell") +
      " points that do not exist. The data is corrupt: read or build it again.";
  }
  if (!small.IsEmpty())
  {
    return small.Describe("cell") +
      " fewer points than a line or polygon needs. Remove them (vtkCleanPolyData).";
  }
  DefectiveIds points;
  auto* pointSet = vtkPointSet::SafeDownCast(data);
  for (vtkIdType i = 0; pointSet && i < numberOfPoints; ++i)
  {
    double point[3];
    pointSet->GetPoint(i, point);
    if (!(std::isfinite(point[0]) && std::isfinite(point[1]) && std::isfinite(point[2])))
    {
      points.Add(i);
    }
  }
  if (!points.IsEmpty())
  {
    return points.Describe("point") +
      " coordinates that are not finite, so that the data cannot be probed. Remove them.";
  }
  const std::string text = DescribeArrays(data->GetPointData(), "point", numberOfPoints);
  return !text.empty() ? text
                       : DescribeArrays(data->GetCellData(), "cell", data->GetNumberOfCells());
}

/// The first defect of a data set or a tree of data sets.
std::string DescribeDefects(vtkDataObject* data)
{
  if (auto* dataSet = vtkDataSet::SafeDownCast(data))
  {
    return DescribeDefects(dataSet);
  }
  std::string text;
  if (auto* tree = vtkCompositeDataSet::SafeDownCast(data))
  {
    const auto leaf = vtkSmartPointer<vtkCompositeDataIterator>::Take(tree->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal() && text.empty(); leaf->GoToNextItem())
    {
      if (auto* dataSet = vtkDataSet::SafeDownCast(leaf->GetCurrentDataObject()))
      {
        text = DescribeDefects(dataSet);
      }
    }
  }
  return text;
}

/// A copy of the points. vtkPoints stores its bounds when they are computed, and another thread may
/// use the original at the same time.
vtkSmartPointer<vtkPoints> CopyPoints(vtkPointSet* data)
{
  auto points = vtkSmartPointer<vtkPoints>::New();
  if (data->GetPoints())
  {
    points->SetDataType(data->GetPoints()->GetDataType());
    points->DeepCopy(data->GetPoints());
  }
  return points;
}

/// The data without VTK's search structures: VTK 9.1 uses the lists of the cells of each point even
/// after cells were replaced in place, and then reads out of bounds.
vtkSmartPointer<vtkDataObject> WithoutCaches(vtkDataObject* data)
{
  if (auto* mesh = vtkPolyData::SafeDownCast(data))
  {
    auto copy = vtkSmartPointer<vtkPolyData>::New();
    copy->SetPoints(CopyPoints(mesh));
    copy->SetVerts(mesh->GetVerts());
    copy->SetLines(mesh->GetLines());
    copy->SetPolys(mesh->GetPolys());
    copy->SetStrips(mesh->GetStrips());
    copy->GetPointData()->ShallowCopy(mesh->GetPointData());
    copy->GetCellData()->ShallowCopy(mesh->GetCellData());
    return copy;
  }
  if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    auto copy = vtkSmartPointer<vtkUnstructuredGrid>::New();
    copy->SetPoints(CopyPoints(grid));
    if (grid->GetCells())
    {
      CopyCells(grid, copy.Get());
    }
    copy->GetPointData()->ShallowCopy(grid->GetPointData());
    copy->GetCellData()->ShallowCopy(grid->GetCellData());
    return copy;
  }
  if (auto* tree = vtkDataObjectTree::SafeDownCast(data))
  {
    auto copy = vtkSmartPointer<vtkDataObjectTree>::Take(tree->NewInstance());
    copy->CopyStructure(tree);
    const auto leaf = vtkSmartPointer<vtkCompositeDataIterator>::Take(tree->NewIterator());
    for (leaf->InitTraversal(); !leaf->IsDoneWithTraversal(); leaf->GoToNextItem())
    {
      copy->SetDataSet(leaf, WithoutCaches(leaf->GetCurrentDataObject()));
    }
    return copy;
  }
  return data;
}

bool HasVectors(vtkPointData* pointData)
{
  return pointData->GetVectors() || pointData->GetNormals() || pointData->GetTensors();
}

/// The bounds of a mesh. GetBounds would store them in the mesh, which another thread may use at
/// the same time.
std::array<double, 6> FindBounds(vtkPolyData* mesh)
{
  const vtkNew<vtkPolyData> copy;
  copy->SetPoints(CopyPoints(mesh));
  copy->SetVerts(mesh->GetVerts());
  copy->SetLines(mesh->GetLines());
  copy->SetPolys(mesh->GetPolys());
  copy->SetStrips(mesh->GetStrips());
  std::array<double, 6> bounds;
  copy->GetBounds(bounds.data());
  return bounds;
}

} // namespace

vtkResampleThroughHomeomorphism::vtkResampleThroughHomeomorphism()
{
  this->FirstPortInPieces = 3;
  this->SetNumberOfInputPorts(4);
}

vtkResampleThroughHomeomorphism::~vtkResampleThroughHomeomorphism() = default;

void vtkResampleThroughHomeomorphism::SetGridData(vtkDataSet* grid)
{
  this->SetInputDataObject(3, grid);
}

vtkDataSet* vtkResampleThroughHomeomorphism::GetOutput()
{
  return vtkDataSet::SafeDownCast(this->GetOutputDataObject(0));
}

int vtkResampleThroughHomeomorphism::FillInputPortInformation(int port, vtkInformation* info)
{
  this->Superclass::FillInputPortInformation(port, info);
  if (port == 2)
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  }
  else if (port == 3)
  {
    info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
  }
  return 1;
}

int vtkResampleThroughHomeomorphism::FillOutputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkDataObject::DATA_TYPE_NAME(), "vtkDataSet");
  return 1;
}

int vtkResampleThroughHomeomorphism::RequestDataObject(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->CheckInputTypes(inputs);
  if (vtkDataObject* grid = vtkDataObject::GetData(inputs[3]))
  {
    MakeOutputLike(grid, outputs->GetInformationObject(0));
  }
  else
  {
    MakeOutput<vtkImageData>(outputs->GetInformationObject(0));
  }
  return 1;
}

int vtkResampleThroughHomeomorphism::RequestInformation(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  this->Superclass::RequestInformation(request, inputs, outputs);
  if (!inputs[3]->GetInformationObject(0))
  {
    const int extent[6] = { 0, std::max(1, this->SamplingDimensions[0]) - 1, 0,
      std::max(1, this->SamplingDimensions[1]) - 1, 0, 0 };
    vtkInformation* outInfo = outputs->GetInformationObject(0);
    outInfo->Set(vtkStreamingDemandDrivenPipeline::WHOLE_EXTENT(), extent, 6);
    outInfo->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  }
  return 1;
}

bool vtkResampleThroughHomeomorphism::MakeImage(
  vtkPolyData* mesh, const int extent[6], vtkImageData* image)
{
  std::array<double, 6> bounds = FindBounds(mesh);
  if (bounds[4] != bounds[5] && bounds[4] <= bounds[5])
  {
    vtkErrorMacro(<< "The default grid needs a mesh parallel to the xy plane, but z ranges from "
                  << bounds[4] << " to " << bounds[5] << ". Set a grid (input port 3).");
    return false;
  }
  if (this->SamplingBounds[0] <= this->SamplingBounds[1] &&
    this->SamplingBounds[2] <= this->SamplingBounds[3])
  {
    std::copy_n(this->SamplingBounds, 4, bounds.begin());
  }
  double spacing[3] = { 1.0, 1.0, 1.0 };
  for (int axis = 0; axis < 2; ++axis)
  {
    const int intervals = std::max(1, this->SamplingDimensions[axis]) - 1;
    const double length = bounds[2 * axis + 1] - bounds[2 * axis];
    spacing[axis] = intervals > 0 && length > 0.0 ? length / intervals : 1.0;
  }
  image->SetOrigin(bounds[0], bounds[2], bounds[4]);
  image->SetSpacing(spacing);
  image->SetExtent(const_cast<int*>(extent));
  return true;
}

int vtkResampleThroughHomeomorphism::Execute(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPolyData* source = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* target = vtkPolyData::GetData(inputs[1]);
  vtkDataObject* data = vtkDataObject::GetData(inputs[2]);
  vtkDataSet* grid = vtkDataSet::GetData(inputs[3]);
  vtkDataSet* output = vtkDataSet::GetData(outputs);
  if (grid && !IsFirstPiece(request, outputs) && this->DependsOnPortsBefore(3))
  {
    return 1;
  }
  const std::shared_ptr<const Homeomorphism> map = this->GetMap(source, target);
  if (!map)
  {
    output->Initialize();
    return 0;
  }
  // Only after the meshes have been accepted, because VTK does not check the points of cells when
  // it computes bounds.
  if (grid)
  {
    output->CopyStructure(grid);
  }
  else if (!this->MakeImage(this->Inverse ? source : target,
             outputs->GetInformationObject(0)->Get(
               vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT()),
             vtkImageData::SafeDownCast(output)))
  {
    return this->Fail(MESHES_REFUSED);
  }

  const vtkIdType count = output->GetNumberOfPoints();
  const vtkNew<vtkUnsignedCharArray> mask;
  mask->SetName(maskName);
  mask->SetNumberOfTuples(count);
  mask->FillValue(0);
  vtkPolyData* mesh = this->Inverse ? target : source;
  auto* image = vtkImageData::SafeDownCast(data);
  if (image && ImageSampling::CanSample(image) &&
    !(this->TransformActiveAttributes && HasVectors(image->GetPointData())))
  {
    this->SampleImage(*map, image, grid, output, mask);
  }
  else if (!this->Probe(*map, mesh, data ? data : mesh, output, mask))
  {
    output->Initialize();
    return this->Fail(DATA_REFUSED);
  }

  output->GetPointData()->AddArray(mask);
  this->NumberOfOutsidePoints = CountOutside(grid ? grid : output, mask);
  if (grid)
  {
    PassGhosts(grid->GetPointData(), output->GetPointData());
    PassGhosts(grid->GetCellData(), output->GetCellData());
  }
  if (this->BlankOutside)
  {
    HidePoints(output, mask, output);
  }
  return 1;
}

/// Resamples an image, which needs neither a search nor intermediate data.
void vtkResampleThroughHomeomorphism::SampleImage(const Homeomorphism& map, vtkImageData* image,
  vtkDataSet* grid, vtkDataSet* output, vtkUnsignedCharArray* mask)
{
  const vtkIdType count = output->GetNumberOfPoints();
  const ImageSampling sampling(image, output->GetPointData(), count);
  const Domain from = this->Inverse ? Domain::Source : Domain::Target;
  vtkUnsignedCharArray* ghosts = grid ? GhostsOf(grid->GetPointData(), count) : nullptr;
  const auto isHidden = [ghosts](vtkIdType i) {
    return ghosts && (ghosts->GetValue(i) & vtkDataSetAttributes::HIDDENPOINT) != 0;
  };
  static_assert(ImageSampling::Capacity == PointBlock::Capacity, "block by block");
  MapInBlocks(this, map, from, output,
    map.GetAbsoluteTolerance(from, this->Tolerance, PrecisionOfPoints(output)), 0.1, 0.9, isHidden,
    nullptr, false, [&](vtkIdType first, const PointBlock& block) {
      bool isInside[PointBlock::Capacity];
      std::transform(block.Triangles, block.Triangles + block.Count, isInside,
        [](TriangleIndex t) { return t >= 0; });
      sampling.Sample(block.Images, isInside, block.Count, first, mask);
    });
}

/// Resamples any other data by VTK's cells. Returns false if it was refused.
bool vtkResampleThroughHomeomorphism::Probe(const Homeomorphism& map, vtkPolyData* mesh,
  vtkDataObject* data, vtkDataSet* output, vtkUnsignedCharArray* mask)
{
  // The preimages of the points of the grid.
  const Domain from = this->Inverse ? Domain::Source : Domain::Target;
  const Domain to = Opposite(from);
  const vtkIdType count = output->GetNumberOfPoints();
  std::vector<TriangleIndex> triangles(static_cast<std::size_t>(count), -1);
  const vtkNew<vtkPoints> preimages;
  preimages->SetDataTypeToDouble();
  preimages->SetNumberOfPoints(count);
  MapInBlocks(
    this, map, from, output,
    map.GetAbsoluteTolerance(from, this->Tolerance, PrecisionOfPoints(output)), 0.0, 0.3,
    [](vtkIdType) { return false; }, preimages->GetData(), false,
    [&](vtkIdType first, const PointBlock& block) {
      WritePoints(block.Images, block.Count, first, preimages->GetData());
      std::copy_n(block.Triangles, block.Count, triangles.begin() + first);
    });
  std::vector<vtkIdType> inside;
  const vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (triangles[static_cast<std::size_t>(i)] >= 0)
    {
      inside.push_back(i);
      points->InsertNextPoint(preimages->GetPoint(i));
    }
  }
  if (ShouldAbort(this))
  {
    return true;
  }

  // The values of the data there. A point on the border of the data may be outside by rounding. It
  // is searched again after moving it by a rounding error towards the center of its triangle.
  const vtkSmartPointer<vtkDataObject> probed = WithoutCaches(data);
  const std::string defects = DescribeDefects(probed);
  if (!defects.empty())
  {
    vtkErrorMacro(<< defects);
    return false;
  }
  const vtkSmartPointer<vtkPointSet> found = FindValues(points, probed);
  this->UpdateProgress(0.6);
  const Triangulation& topology = map.GetPair().GetTriangulation();
  FillGaps(found, probed, [&](vtkIdType i, double point[3]) {
    double middle[3] = { 0.0, 0.0, 0.0 };
    const TriangleIndex triangle =
      triangles[static_cast<std::size_t>(inside[static_cast<std::size_t>(i)])];
    for (const std::int32_t corner : topology.GetCorners(triangle))
    {
      double position[3];
      mesh->GetPoint(corner, position);
      for (int axis = 0; axis < 3; ++axis)
      {
        middle[axis] += position[axis] / 3.0;
      }
    }
    constexpr double share = 1e-12;
    for (int axis = 0; axis < 3; ++axis)
    {
      point[axis] += share * (middle[axis] - point[axis]);
    }
  });
  this->UpdateProgress(0.7);

  vtkPointData* values = found->GetPointData();
  vtkDataArray* hasValues = values->GetArray(maskName);
  const vtkNew<vtkPointData> transformed;
  transformed->ShallowCopy(values);
  if (this->TransformActiveAttributes && HasVectors(values))
  {
    const vtkNew<vtkDoubleArray> jacobians;
    jacobians->SetNumberOfComponents(9);
    jacobians->SetNumberOfTuples(points->GetNumberOfPoints());
    jacobians->FillValue(vtkMath::Nan());
    const double tolerance =
      map.GetAbsoluteTolerance(to, this->Tolerance, PrecisionOfType(VTK_DOUBLE));
    RunInBlocks(this, points->GetNumberOfPoints(), 0.7, 0.9, [&](vtkIdType begin, vtkIdType end) {
      for (vtkIdType i = begin; i < end; ++i)
      {
        double point[3];
        points->GetPoint(i, point);
        const SurfacePoint surfacePoint = map.Locate(to, point, tolerance,
          triangles[static_cast<std::size_t>(inside[static_cast<std::size_t>(i)])]);
        if (surfacePoint.Triangle >= 0)
        {
          const Jacobian jacobian = map.GetJacobian(to, surfacePoint);
          jacobians->SetTypedTuple(i, jacobian.Matrix.data());
        }
      }
    });
    TransformAttributes(values, transformed, jacobians, [values](vtkDataArray* array) {
      return array == values->GetNormals() ? TransformationRule::Normal
        : array == values->GetVectors() || array == values->GetTensors()
        ? TransformationRule::Tangent
        : TransformationRule::None;
    });
  }

  for (std::size_t i = 0; i < inside.size(); ++i)
  {
    const bool has = hasValues && hasValues->GetTuple1(static_cast<vtkIdType>(i)) != 0.0;
    mask->SetValue(inside[i], has ? 1 : 0);
  }
  vtkPointData* result = output->GetPointData();
  for (int a = 0; a < transformed->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* array = transformed->GetArray(a);
    if (!array || !array->GetName() || std::strcmp(array->GetName(), maskName) == 0 ||
      std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName()) == 0)
    {
      continue;
    }
    const auto resampled = NewEmptyLike(array, count);
    for (std::size_t i = 0; i < inside.size(); ++i)
    {
      if (mask->GetValue(inside[i]))
      {
        resampled->SetTuple(inside[i], static_cast<vtkIdType>(i), array);
      }
    }
    const int index = result->AddArray(resampled);
    for (int role = 0; role < vtkDataSetAttributes::NUM_ATTRIBUTES; ++role)
    {
      if (transformed->GetAbstractAttribute(role) == array)
      {
        result->SetActiveAttribute(index, role);
      }
    }
  }
  return true;
}

void vtkResampleThroughHomeomorphism::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  PrintMappingOptions(this, os, indent);
  os << indent << "SamplingDimensions: " << this->SamplingDimensions[0] << " "
     << this->SamplingDimensions[1] << "\n";
  os << indent << "SamplingBounds: " << this->SamplingBounds[0] << " " << this->SamplingBounds[1]
     << " " << this->SamplingBounds[2] << " " << this->SamplingBounds[3] << "\n";
}
