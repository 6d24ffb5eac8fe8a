// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkResampleThroughHomeomorphism.h"

#include "Pipeline/FilterSupport.h"
#include "Pipeline/ImageSampling.h"
#include "Pipeline/ProcessStatistics.h"
#include "Pipeline/VTKVersions.h"
#include "vtkDifferentiableHomeomorphism.h"

#include "vtkCallbackCommand.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataProbeFilter.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataObjectTree.h"
#include "vtkErrorCode.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
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

/// Passes the marks of what is hidden or belongs to another piece.
void PassGhosts(vtkDataSetAttributes* from, vtkDataSetAttributes* to)
{
  if (vtkAbstractArray* ghosts = from->GetAbstractArray(vtkDataSetAttributes::GhostArrayName()))
  {
    to->AddArray(ghosts);
  }
}

/// The data's values at points, with a mask that tells where there are any.
vtkSmartPointer<vtkPointSet> Probe(vtkPoints* points, vtkDataObject* data)
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

/// Looks again for the points that have no values, where move(i, point) moves them.
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
  const vtkSmartPointer<vtkPointSet> again = Probe(moved, data);
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

/// Collects ids for a message: how many there are, and the first of them.
class Offenders
{
public:
  void Add(vtkIdType id) { this->Ids.push_back(id); }
  bool IsEmpty() const { return this->Ids.empty(); }
  /// "2 points of the data (points 3, 5) have".
  std::string Tell(const std::string& what) const
  {
    const bool one = this->Ids.size() == 1;
    return std::to_string(this->Ids.size()) + " " + what + (one ? "" : "s") + " of the data (" +
      what + (one ? " " : "s ") + ListIds(this->Ids) + (one ? ") has" : ") have");
  }

private:
  std::vector<vtkIdType> Ids;
};

/// The first array of some attributes that does not have a value for each point or cell; empty if
/// all have.
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

/// What would make VTK's locators and interpolation read memory that is not theirs; empty if
/// nothing would.
std::string DescribeDefects(vtkDataSet* data)
{
  // With the least number of points that such a cell has.
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
  Offenders cells;
  Offenders small;
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
    return cells.Tell("cell") +
      " points that do not exist. The data is corrupt: read or build it again.";
  }
  if (!small.IsEmpty())
  {
    return small.Tell("cell") +
      " fewer points than a line or polygon needs. Remove them (vtkCleanPolyData).";
  }
  Offenders points;
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
    return points.Tell("point") +
      " coordinates that are not finite, among which values cannot be looked for. Remove them.";
  }
  const std::string text = DescribeArrays(data->GetPointData(), "point", numberOfPoints);
  return !text.empty() ? text
                       : DescribeArrays(data->GetCellData(), "cell", data->GetNumberOfCells());
}

/// The same of a data set or a tree of them: the first defect found.
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

/// The data without what VTK has computed for searching in it: VTK 9.1 uses the lists of each
/// point's cells even after cells were replaced in place, and then reads beyond them.
vtkSmartPointer<vtkDataObject> WithoutCaches(vtkDataObject* data)
{
  if (auto* mesh = vtkPolyData::SafeDownCast(data))
  {
    auto copy = vtkSmartPointer<vtkPolyData>::New();
    copy->SetPoints(mesh->GetPoints());
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
    copy->SetPoints(grid->GetPoints());
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

} // namespace

class vtkResampleThroughHomeomorphism::Internals
{
public:
  HomeomorphismCache Cache;
};

vtkResampleThroughHomeomorphism::vtkResampleThroughHomeomorphism()
  : Internal(new Internals)
{
  this->SetNumberOfInputPorts(4);
  // Outside points are told by the mask; errors are this filter's own.
  this->Mapping->BlankOutsideOff();
  this->Mapping->ComputeTriangleIdOn();
  vtkNew<vtkCallbackCommand> passOnErrors;
  passOnErrors->SetClientData(this);
  passOnErrors->SetCallback([](vtkObject*, unsigned long event, void* client, void* text) {
    auto* self = static_cast<vtkResampleThroughHomeomorphism*>(client);
    // VTK's macros prefix their text with where it comes from; the part after it is the message.
    std::string message = static_cast<const char*>(text);
    const std::size_t start = message.find("): ");
    message = start == std::string::npos ? message : message.substr(start + 3);
    message.erase(message.find_last_not_of('\n') + 1);
    if (event == vtkCommand::ErrorEvent)
    {
      vtkErrorWithObjectMacro(self, << message);
    }
    else
    {
      vtkWarningWithObjectMacro(self, << message);
    }
  });
  this->Mapping->AddObserver(vtkCommand::ErrorEvent, passOnErrors);
  this->Mapping->AddObserver(vtkCommand::WarningEvent, passOnErrors);
}

vtkResampleThroughHomeomorphism::~vtkResampleThroughHomeomorphism() = default;

void vtkResampleThroughHomeomorphism::SetSourceData(vtkPolyData* source)
{
  this->SetInputData(0, source);
}

void vtkResampleThroughHomeomorphism::SetTargetData(vtkPolyData* target)
{
  this->SetInputData(1, target);
}

void vtkResampleThroughHomeomorphism::SetGridData(vtkDataSet* grid)
{
  this->SetInputData(3, grid);
}

vtkIdType vtkResampleThroughHomeomorphism::GetNumberOfMeshBuilds()
{
  return this->Internal->Cache.GetNumberOfBuilds() + this->Mapping->GetNumberOfMeshBuilds();
}

int vtkResampleThroughHomeomorphism::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), port < 2 ? "vtkPolyData" : "vtkDataSet");
  if (port < 3)
  {
    info->Set(AskedForWhole(), 1);
  }
  if (port == 2)
  {
    info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  }
  if (port >= 2)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
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
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  vtkInformation* outInfo = outputs->GetInformationObject(0);
  DescribeTimesInOutput(inputs, 4, outInfo);
  if (vtkInformation* gridInfo = inputs[3]->GetInformationObject(0))
  {
    DescribeDataInOutput(gridInfo, outInfo);
    return 1;
  }
  const int extent[6] = { 0, std::max(1, this->SamplingDimensions[0]) - 1, 0,
    std::max(1, this->SamplingDimensions[1]) - 1, 0, 0 };
  outInfo->Set(Pipeline::WHOLE_EXTENT(), extent, 6);
  outInfo->Set(vtkAlgorithm::CAN_PRODUCE_SUB_EXTENT(), 1);
  return 1;
}

int vtkResampleThroughHomeomorphism::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  for (int port = 0; port < 3; ++port)
  {
    RequestWhole(inputs[port]->GetInformationObject(0));
  }
  vtkInformation* gridInfo = inputs[3]->GetInformationObject(0);
  vtkInformation* outInfo = outputs->GetInformationObject(0);
  if (gridInfo && SharesUpstreamWithPortsBefore(this, 3))
  {
    RequestWhole(gridInfo);
  }
  else if (gridInfo)
  {
    for (auto* key : { Pipeline::UPDATE_PIECE_NUMBER(), Pipeline::UPDATE_NUMBER_OF_PIECES(),
           Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS() })
    {
      gridInfo->CopyEntry(outInfo, key);
    }
    if (gridInfo->Has(Pipeline::WHOLE_EXTENT()) && outInfo->Has(Pipeline::UPDATE_EXTENT()))
    {
      gridInfo->CopyEntry(outInfo, Pipeline::UPDATE_EXTENT());
    }
  }
  return 1;
}

vtkDataSet* vtkResampleThroughHomeomorphism::Map(vtkDataSet* data, bool inverse, bool carryVectors)
{
  this->Mapping->SetDataObject(data);
  this->Mapping->SetInverse(inverse);
  this->Mapping->SetTransformActiveAttributes(carryVectors);
  this->Mapping->Update();
  if (this->Mapping->GetErrorCode() != vtkErrorCode::NoError)
  {
    this->SetErrorCode(vtkErrorCode::UserError);
    return nullptr;
  }
  return vtkDataSet::SafeDownCast(this->Mapping->GetOutputDataObject(0));
}

int vtkResampleThroughHomeomorphism::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const int success = this->Resample(request, inputs, outputs);
  this->OwnOutsidePoints = this->NumberOfOutsidePoints;
  return success;
}

void vtkResampleThroughHomeomorphism::ReduceStatistics(vtkMultiProcessController* controller)
{
  const ProcessStatistics own{ { static_cast<double>(this->OwnOutsidePoints) }, {} };
  this->NumberOfOutsidePoints = static_cast<vtkIdType>(Total(this, own, controller).Sums[0]);
}

int vtkResampleThroughHomeomorphism::Resample(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPolyData* source = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* target = vtkPolyData::GetData(inputs[1]);
  vtkDataObject* data = vtkDataObject::GetData(inputs[2]);
  vtkDataSet* grid = vtkDataSet::GetData(inputs[3]);
  vtkDataSet* output = vtkDataSet::GetData(outputs);
  this->NumberOfOutsidePoints = -1;
  this->SetErrorCode(vtkErrorCode::NoError);
  if (grid && !IsFirstPiece(request, outputs) && SharesUpstreamWithPortsBefore(this, 3))
  {
    this->NumberOfOutsidePoints = 0;
    return 1;
  }

  // Copies: the originals belong to a pipeline of their own. They share points and cells, so that
  // nothing is built anew.
  vtkNew<vtkPolyData> meshes[2];
  meshes[0]->ShallowCopy(source);
  meshes[1]->ShallowCopy(target);
  this->Mapping->SetSourceData(meshes[0]);
  this->Mapping->SetTargetData(meshes[1]);
  this->Mapping->SetCoordinateSystem(this->CoordinateSystem);
  this->Mapping->SetCenterPoint(this->CenterPoint);
  this->Mapping->SetDiscordantTriangles(this->DiscordantTriangles);
  this->Mapping->SetMaskInvalidTriangles(this->MaskInvalidTriangles);
  this->Mapping->SetTolerance(this->Tolerance);
  this->Mapping->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);

  if (grid)
  {
    output->CopyStructure(grid);
  }
  else
  {
    double bounds[6];
    (this->Inverse ? source : target)->GetBounds(bounds);
    if (bounds[4] != bounds[5] && bounds[4] <= bounds[5])
    {
      vtkErrorMacro(
        << "An image can be laid over a mesh that is parallel to the xy plane only; this "
           "one's z goes from "
        << bounds[4] << " to " << bounds[5]
        << ". Give the points at which values are wanted (input port 3).");
      this->SetErrorCode(vtkErrorCode::UserError);
      return 0;
    }
    if (this->SamplingBounds[0] <= this->SamplingBounds[1] &&
      this->SamplingBounds[2] <= this->SamplingBounds[3])
    {
      std::copy_n(this->SamplingBounds, 4, bounds);
    }
    auto* image = vtkImageData::SafeDownCast(output);
    double spacing[3] = { 1.0, 1.0, 1.0 };
    for (int axis = 0; axis < 2; ++axis)
    {
      const int intervals = std::max(1, this->SamplingDimensions[axis]) - 1;
      const double length = bounds[2 * axis + 1] - bounds[2 * axis];
      spacing[axis] = intervals > 0 && length > 0.0 ? length / intervals : 1.0;
    }
    image->SetOrigin(bounds[0], bounds[2], bounds[4]);
    image->SetSpacing(spacing);
    image->SetExtent(
      outputs->GetInformationObject(0)->Get(vtkStreamingDemandDrivenPipeline::UPDATE_EXTENT()));
  }

  auto* image = vtkImageData::SafeDownCast(data);
  if (image && ImageSampling::CanSample(image) &&
    !(this->TransformActiveAttributes && HasVectors(image->GetPointData())))
  {
    return this->ResampleImage(source, target, image, grid, output);
  }

  // Where the grid's points come from.
  const vtkIdType count = output->GetNumberOfPoints();
  vtkNew<vtkPoints> origins;
  origins->SetDataTypeToDouble();
  std::vector<vtkIdType> inside;
  vtkSmartPointer<vtkDataSet> shape;
  shape.TakeReference(output->NewInstance());
  shape->CopyStructure(output);
  vtkDataSet* pulledBack = this->Map(shape, !this->Inverse, false);
  if (!pulledBack)
  {
    output->Initialize();
    return 0;
  }
  this->UpdateProgress(0.3);
  vtkDataArray* isInside = pulledBack->GetPointData()->GetArray(maskName);
  const vtkSmartPointer<vtkDataArray> triangles =
    pulledBack->GetPointData()->GetArray("TriangleId");
  for (vtkIdType i = 0; i < count; ++i)
  {
    if (isInside && isInside->GetTuple1(i) != 0.0)
    {
      inside.push_back(i);
      origins->InsertNextPoint(pulledBack->GetPoint(i));
    }
  }
  if (ShouldAbort(this))
  {
    return 1;
  }

  // What the data has there. A point on the data's border may be outside by rounding: it is looked
  // for again, a rounding error closer to the middle of its triangle.
  const vtkSmartPointer<vtkDataObject> probed =
    WithoutCaches(data ? data : (this->Inverse ? target : source));
  const std::string defects = DescribeDefects(probed);
  if (!defects.empty())
  {
    vtkErrorMacro(<< defects);
    this->SetErrorCode(vtkErrorCode::UserError);
    output->Initialize();
    return 0;
  }
  vtkSmartPointer<vtkPointSet> found = Probe(origins, probed);
  this->UpdateProgress(0.6);
  vtkPolyData* mesh = this->Inverse ? target : source;
  const CellPoints cellPoints(mesh);
  FillGaps(found, probed, [&](vtkIdType i, double point[3]) {
    vtkNew<vtkIdList> corners;
    cellPoints.Get(
      static_cast<vtkIdType>(triangles->GetTuple1(inside[static_cast<std::size_t>(i)])), corners);
    double middle[3] = { 0.0, 0.0, 0.0 };
    for (const vtkIdType corner : *corners)
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
  vtkSmartPointer<vtkDataArray> hasValues = found->GetPointData()->GetArray(maskName);
  if (this->TransformActiveAttributes && HasVectors(found->GetPointData()))
  {
    vtkNew<vtkPolyData> values;
    values->ShallowCopy(found);
    // The map makes an array of this name of its own.
    values->GetPointData()->RemoveArray(maskName);
    found = vtkPointSet::SafeDownCast(this->Map(values, this->Inverse, true));
    if (!found)
    {
      output->Initialize();
      return 0;
    }
  }

  vtkNew<vtkUnsignedCharArray> mask;
  mask->SetName(maskName);
  mask->SetNumberOfTuples(count);
  mask->FillValue(0);
  for (std::size_t i = 0; i < inside.size(); ++i)
  {
    const bool has = hasValues && hasValues->GetTuple1(static_cast<vtkIdType>(i)) != 0.0;
    mask->SetValue(inside[i], has ? 1 : 0);
  }
  vtkPointData* result = output->GetPointData();
  for (int a = 0; a < found->GetPointData()->GetNumberOfArrays(); ++a)
  {
    vtkDataArray* values = found->GetPointData()->GetArray(a);
    if (!values || !values->GetName() || std::strcmp(values->GetName(), maskName) == 0 ||
      std::strcmp(values->GetName(), vtkDataSetAttributes::GhostArrayName()) == 0)
    {
      continue;
    }
    const auto array = NewEmptyLike(values, count);
    for (std::size_t i = 0; i < inside.size(); ++i)
    {
      if (mask->GetValue(inside[i]))
      {
        array->SetTuple(inside[i], static_cast<vtkIdType>(i), values);
      }
    }
    const int index = result->AddArray(array);
    for (int role = 0; role < vtkDataSetAttributes::NUM_ATTRIBUTES; ++role)
    {
      if (found->GetPointData()->GetAbstractAttribute(role) == values)
      {
        result->SetActiveAttribute(index, role);
      }
    }
  }
  this->Mark(grid, mask, output);
  return 1;
}

/// The same for data that is an image, which needs no search and no intermediate data.
int vtkResampleThroughHomeomorphism::ResampleImage(vtkPolyData* source, vtkPolyData* target,
  vtkImageData* image, vtkDataSet* grid, vtkDataSet* output)
{
  HomeomorphismCache& cache = this->Internal->Cache;
  const std::shared_ptr<const Homeomorphism> map = cache.Get(source, target, GetOptions(this));
  ReportProblems(this, cache.GetProblems());
  if (!map)
  {
    this->SetErrorCode(vtkErrorCode::UserError);
    output->Initialize();
    return 0;
  }
  const vtkIdType count = output->GetNumberOfPoints();
  vtkNew<vtkUnsignedCharArray> mask;
  mask->SetName(maskName);
  mask->SetNumberOfTuples(count);
  mask->FillValue(0);
  const ImageSampling sampling(image, output->GetPointData(), count);
  const Domain from = this->Inverse ? Domain::Source : Domain::Target;
  auto* pointSet = vtkPointSet::SafeDownCast(output);
  vtkPoints* points = pointSet ? pointSet->GetPoints() : nullptr;
  const double tolerance = map->GetAbsoluteTolerance(
    from, this->Tolerance, PrecisionOfType(points ? points->GetDataType() : VTK_DOUBLE));
  vtkUnsignedCharArray* ghosts = grid ? GhostsOf(grid->GetPointData(), count) : nullptr;
  static_assert(ImageSampling::Capacity == PointBlock::Capacity, "block by block");
  RunInBlocks(this, count, 0.1, 0.9, [&](vtkIdType begin, vtkIdType end) {
    LocationHint hint;
    PointBlock block;
    for (vtkIdType first = begin; first < end; first += PointBlock::Capacity)
    {
      block.Count = static_cast<int>(std::min<vtkIdType>(PointBlock::Capacity, end - first));
      ReadPoints(output, first, block);
      map->LocateBlock(from, block, tolerance, hint);
      map->MapBlock(from, block);
      bool isInside[PointBlock::Capacity];
      for (int i = 0; i < block.Count; ++i)
      {
        isInside[i] = block.Triangles[i] >= 0 &&
          !(ghosts && (ghosts->GetValue(first + i) & vtkDataSetAttributes::HIDDENPOINT));
      }
      sampling.Sample(block.Points, isInside, block.Count, first, mask);
    }
  });
  this->Mark(grid, mask, output);
  return 1;
}

/// Adds the mask and what follows from it.
void vtkResampleThroughHomeomorphism::Mark(
  vtkDataSet* grid, vtkUnsignedCharArray* mask, vtkDataSet* output)
{
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
  this->UpdateProgress(1.0);
}

void vtkResampleThroughHomeomorphism::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "CoordinateSystem: " << this->CoordinateSystem << "\n";
  os << indent << "CenterPoint: " << this->CenterPoint << "\n";
  os << indent << "DiscordantTriangles: " << this->DiscordantTriangles << "\n";
  os << indent << "MaskInvalidTriangles: " << this->MaskInvalidTriangles << "\n";
  os << indent << "Inverse: " << this->Inverse << "\n";
  os << indent << "SamplingDimensions: " << this->SamplingDimensions[0] << " "
     << this->SamplingDimensions[1] << "\n";
  os << indent << "SamplingBounds: " << this->SamplingBounds[0] << " " << this->SamplingBounds[1]
     << " " << this->SamplingBounds[2] << " " << this->SamplingBounds[3] << "\n";
  os << indent << "Tolerance: " << this->Tolerance << "\n";
  os << indent << "TransformActiveAttributes: " << this->TransformActiveAttributes << "\n";
  os << indent << "BlankOutside: " << this->BlankOutside << "\n";
  os << indent << "NumberOfOutsidePoints: " << this->NumberOfOutsidePoints << "\n";
}
