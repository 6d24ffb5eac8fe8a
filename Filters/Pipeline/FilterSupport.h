// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FilterSupport.h
/// What the module's filters have in common: telling users of defects, running over points in
/// parallel, and going through composite data sets.

#ifndef homeomorphism_FilterSupport_h
#define homeomorphism_FilterSupport_h

#include "CellPoints.h"

#include "Mesh/MeshValidation.h"
#include "Pipeline/DiagnosticMessages.h"
#include "Pipeline/HomeomorphismCache.h"

#include "VTKVersions.h"

#include "vtkAOSDataArrayTemplate.h"
#include "vtkAlgorithm.h"
#include "vtkArrayDispatch.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"
#include "vtkDataObject.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkExecutive.h"
#include "vtkIdList.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationVector.h"
#include "vtkObject.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkSMPTools.h"
#include "vtkSmartPointer.h"
#include "vtkStreamingDemandDrivenPipeline.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <limits>
#include <set>
#include <string>
#include <type_traits>
#include <vector>

namespace homeomorphism
{

/// The relative rounding error of coordinates of a VTK type.
inline double PrecisionOfType(int dataType)
{
  return 0.5 *
    (dataType == VTK_FLOAT ? static_cast<double>(std::numeric_limits<float>::epsilon())
                           : std::numeric_limits<double>::epsilon());
}

/// Reads a block's points, of which the first is tuple @a first of an array of 3 components.
inline void ReadPoints(vtkDataArray* array, vtkIdType first, PointBlock& block)
{
  double* coordinates = &block.Points[0][0];
  if (auto* doubles = vtkAOSDataArrayTemplate<double>::FastDownCast(array))
  {
    std::copy_n(doubles->GetPointer(3 * first), 3 * block.Count, coordinates);
    return;
  }
  const auto read = [first, coordinates, &block](auto* typed) {
    const auto values = vtk::DataArrayValueRange<3>(typed, 3 * first, 3 * (first + block.Count));
    std::transform(values.begin(), values.end(), coordinates,
      [](auto value) { return static_cast<double>(value); });
  };
  if (!vtkArrayDispatch::DispatchByValueType<vtkArrayDispatch::Reals>::Execute(array, read))
  {
    read(array);
  }
}

/// Reads a block's points from a data set.
inline void ReadPoints(vtkDataSet* data, vtkIdType first, PointBlock& block)
{
  auto* pointSet = vtkPointSet::SafeDownCast(data);
  if (pointSet && pointSet->GetPoints())
  {
    ReadPoints(pointSet->GetPoints()->GetData(), first, block);
    return;
  }
  if (auto* image = vtkImageData::SafeDownCast(data))
  {
    // As GetPoint, without finding the row anew for each point.
    const int* extent = image->GetExtent();
    const int* dimensions = image->GetDimensions();
    const vtkIdType row = first / dimensions[0];
    int index[3] = { static_cast<int>(first % dimensions[0]), static_cast<int>(row % dimensions[1]),
      static_cast<int>(row / dimensions[1]) };
    for (int i = 0; i < block.Count; ++i)
    {
      image->TransformIndexToPhysicalPoint(
        extent[0] + index[0], extent[2] + index[1], extent[4] + index[2], block.Points[i]);
      if (++index[0] == dimensions[0])
      {
        index[0] = 0;
        if (++index[1] == dimensions[1])
        {
          index[1] = 0;
          ++index[2];
        }
      }
    }
    return;
  }
  for (int i = 0; i < block.Count; ++i)
  {
    data->GetPoint(first + i, block.Points[i]);
  }
}

/// Writes a block's points to an array of 3 components.
inline void WritePoints(const PointBlock& block, vtkIdType first, vtkDataArray* array)
{
  const double* coordinates = &block.Points[0][0];
  if (auto* doubles = vtkAOSDataArrayTemplate<double>::FastDownCast(array))
  {
    std::copy_n(coordinates, 3 * block.Count, doubles->GetPointer(3 * first));
    return;
  }
  const auto write = [first, coordinates, &block](auto* typed) {
    using Value = vtk::GetAPIType<std::remove_pointer_t<decltype(typed)>>;
    auto values = vtk::DataArrayValueRange<3>(typed, 3 * first, 3 * (first + block.Count));
    std::transform(coordinates, coordinates + 3 * block.Count, values.begin(),
      [](double value) { return static_cast<Value>(value); });
  };
  if (!vtkArrayDispatch::DispatchByValueType<vtkArrayDispatch::Reals>::Execute(array, write))
  {
    write(array);
  }
}

/// Calls work(begin, end) in parallel over [0, count), in blocks between which progress is reported
/// and a request to abort is honored; a block should take a fraction of a second. Returns the
/// number of items done: less than count only if aborted.
template <typename Work>
vtkIdType RunInBlocks(vtkAlgorithm* self, vtkIdType count, double progressBegin, double progressEnd,
  Work&& work, vtkIdType blockSize = 1 << 17)
{
  for (vtkIdType begin = 0; begin < count; begin += blockSize)
  {
    self->UpdateProgress(progressBegin +
      (progressEnd - progressBegin) * static_cast<double>(begin) / static_cast<double>(count));
    if (ShouldAbort(self))
    {
      return begin;
    }
    vtkSMPTools::For(begin, std::min(count, begin + blockSize), work);
  }
  return count;
}

/// Whether the algorithm's input may be a data set or a tree of them. The type of trees comes
/// first: executives that iterate over composite inputs on behalf of simple filters look only at
/// it.
inline void AcceptDataSetsAndTrees(vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObjectTree");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
}

/// Tells that an output may change whenever one of the first @a ports inputs does: its time steps
/// and time range are all of theirs. By default they are those of port 0, and at other times the
/// executive takes what was made before for good.
inline void DescribeTimesInOutput(vtkInformationVector** inputs, int ports, vtkInformation* outInfo)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  std::set<double> steps;
  std::set<double> ends;
  for (int port = 0; port < ports; ++port)
  {
    vtkInformation* info = inputs[port]->GetInformationObject(0);
    if (info && info->Has(Pipeline::TIME_STEPS()))
    {
      const double* values = info->Get(Pipeline::TIME_STEPS());
      steps.insert(values, values + info->Length(Pipeline::TIME_STEPS()));
    }
    if (info && info->Has(Pipeline::TIME_RANGE()))
    {
      ends.insert(info->Get(Pipeline::TIME_RANGE()), info->Get(Pipeline::TIME_RANGE()) + 2);
    }
  }
  outInfo->Remove(Pipeline::TIME_STEPS());
  outInfo->Remove(Pipeline::TIME_RANGE());
  if (!steps.empty())
  {
    const std::vector<double> values(steps.begin(), steps.end());
    outInfo->Set(Pipeline::TIME_STEPS(), values.data(), static_cast<int>(values.size()));
  }
  if (!ends.empty())
  {
    const double range[2] = { *ends.begin(), *ends.rbegin() };
    outInfo->Set(Pipeline::TIME_RANGE(), range, 2);
  }
}

/// Of a filter whose other inputs are meshes: lets the information of the data's port, if there is
/// data, describe the output's extent, which by default comes from port 0.
inline void DescribeDataInOutput(vtkInformation* dataInfo, vtkInformation* outInfo)
{
  if (!dataInfo)
  {
    return;
  }
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  if (dataInfo->Has(Pipeline::WHOLE_EXTENT()))
  {
    outInfo->CopyEntry(dataInfo, Pipeline::WHOLE_EXTENT());
  }
  outInfo->Set(vtkAlgorithm::CAN_HANDLE_PIECE_REQUEST(), 1);
}

/// Asks for an input as a whole, whatever piece of the output is asked for.
inline void RequestWhole(vtkInformation* info)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  if (!info)
  {
    return;
  }
  info->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
  info->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
  info->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  // The extent there is the output's, which means nothing to this input.
  if (info->Has(Pipeline::WHOLE_EXTENT()))
  {
    info->Set(Pipeline::UPDATE_EXTENT(), info->Get(Pipeline::WHOLE_EXTENT()), 6);
  }
  else
  {
    info->Remove(Pipeline::UPDATE_EXTENT());
  }
}

/// In the information of an input port: it is always asked for whole.
inline vtkInformationIntegerKey* AskedForWhole()
{
  static vtkInformationIntegerKey* const key =
    vtkInformationIntegerKey::MakeKey("ASKED_FOR_WHOLE", "FiltersHomeomorphism");
  return key;
}

/// Adds the algorithms that the ones connected to a port depend on, themselves included; @a
/// inPieces: only if the same piece is asked from them.
inline void CollectUpstream(
  vtkAlgorithm* algorithm, int port, bool inPieces, std::set<vtkAlgorithm*>& found)
{
  for (int i = 0; i < algorithm->GetNumberOfInputConnections(port); ++i)
  {
    vtkAlgorithm* producer = algorithm->GetInputAlgorithm(port, i);
    if (!producer || !found.insert(producer).second)
    {
      continue;
    }
    for (int next = 0; next < producer->GetNumberOfInputPorts(); ++next)
    {
      if (!inPieces || !producer->GetInputPortInformation(next)->Has(AskedForWhole()))
      {
        CollectUpstream(producer, next, inPieces, found);
      }
    }
  }
}

/// Whether what comes in at a port and what comes in at the ports before it, which are asked for
/// whole, are made from the same things. Those cannot be asked for both whole and in pieces at the
/// same time: then this port must be asked for whole, too, and what becomes of it is part of piece
/// 0.
inline bool SharesUpstreamWithPortsBefore(vtkAlgorithm* algorithm, int port)
{
  std::set<vtkAlgorithm*> whole;
  for (int i = 0; i < port; ++i)
  {
    CollectUpstream(algorithm, i, false, whole);
  }
  std::set<vtkAlgorithm*> pieces;
  CollectUpstream(algorithm, port, true, pieces);
  return std::any_of(pieces.begin(), pieces.end(),
    [&whole](vtkAlgorithm* producer) { return whole.count(producer) > 0; });
}

/// Puts a new object of a type into an output, unless one of that type is there.
template <typename Type>
void MakeOutput(vtkInformation* outInfo)
{
  if (!Type::SafeDownCast(vtkDataObject::GetData(outInfo)))
  {
    outInfo->Set(vtkDataObject::DATA_OBJECT(), vtkSmartPointer<Type>::New());
  }
}

/// The same with an object's own type.
inline void MakeOutputLike(vtkDataObject* data, vtkInformation* outInfo)
{
  vtkDataObject* current = vtkDataObject::GetData(outInfo);
  if (!current || std::string(current->GetClassName()) != data->GetClassName())
  {
    outInfo->Set(
      vtkDataObject::DATA_OBJECT(), vtkSmartPointer<vtkDataObject>::Take(data->NewInstance()));
  }
}

/// Whether what is made from the meshes alone belongs to a request: they are read whole for every
/// piece, and only the first piece gets what they make.
inline bool IsFirstPiece(vtkInformation* request, vtkInformationVector* outputs)
{
  const int port = request->Has(vtkExecutive::FROM_OUTPUT_PORT())
    ? std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()))
    : 0;
  return outputs->GetInformationObject(port)->Get(
           vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER()) <= 0;
}

/// How a filter or transform wants its meshes understood.
template <typename Algorithm>
HomeomorphismOptions GetOptions(Algorithm* self)
{
  HomeomorphismOptions options;
  options.System = static_cast<CoordinateSystem>(self->GetCoordinateSystem());
  options.Center = static_cast<CenterPoint>(self->GetCenterPoint());
  options.MaskInvalidTriangles = self->GetMaskInvalidTriangles();
  options.DiscordantByLinear = self->GetDiscordantTriangles() == Algorithm::USE_LINEAR;
  return options;
}

/// Fills @a output, a tree of the same structure, with convert(leaf) for each data set of @a input.
/// Each conversion's progress counts as a part of the whole.
template <typename Convert>
void ConvertLeaves(
  vtkAlgorithm* self, vtkCompositeDataSet* input, vtkCompositeDataSet* output, Convert&& convert)
{
  output->CopyStructure(input);
  const auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(input->NewIterator());
  int leaves = 0;
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    ++leaves;
  }
  const double shift = self->GetProgressShift();
  const double scale = self->GetProgressScale();
  int done = 0;
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    self->SetProgressShiftScale(shift + scale * done++ / leaves, scale / leaves);
    if (auto* leaf = vtkDataSet::SafeDownCast(iterator->GetCurrentDataObject()))
    {
      const vtkSmartPointer<vtkDataSet> converted = convert(leaf);
      output->SetDataSet(iterator, converted);
    }
  }
  self->SetProgressShiftScale(shift, scale);
}

/// Replaces the ghost array of some attributes, if it fits them, by a copy, else by a new one.
inline vtkUnsignedCharArray* RenewGhosts(vtkDataSetAttributes* attributes, vtkIdType tuples)
{
  const auto ghosts = vtkSmartPointer<vtkUnsignedCharArray>::New();
  if (vtkUnsignedCharArray* current = GhostsOf(attributes, tuples))
  {
    ghosts->DeepCopy(current);
  }
  else
  {
    ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
    ghosts->SetNumberOfTuples(tuples);
    ghosts->FillValue(0);
  }
  attributes->AddArray(ghosts);
  return ghosts;
}

/// Number of points that @a mask leaves out, those of @a data that belong to another piece
/// excepted.
inline vtkIdType CountOutside(vtkDataSet* data, vtkUnsignedCharArray* mask)
{
  const vtkIdType numberOfPoints = mask->GetNumberOfTuples();
  vtkUnsignedCharArray* ghosts = GhostsOf(data->GetPointData(), numberOfPoints);
  vtkIdType outside = 0;
  for (vtkIdType i = 0; i < numberOfPoints; ++i)
  {
    outside += !mask->GetValue(i) &&
      !(ghosts && (ghosts->GetValue(i) & vtkDataSetAttributes::DUPLICATEPOINT));
  }
  return outside;
}

/// Hides (vtkGhostType) the points of @a output that @a mask leaves out, and the cells that use
/// them or points that do not exist; nothing if it leaves none out. @a cells has the output's
/// cells.
inline void HidePoints(vtkDataSet* cells, vtkUnsignedCharArray* mask, vtkDataSet* output)
{
  const vtkIdType numberOfPoints = mask->GetNumberOfTuples();
  const vtkIdType numberOfCells = output->GetNumberOfCells();
  const unsigned char* isShown = mask->GetPointer(0);
  if (std::find(isShown, isShown + numberOfPoints, 0) == isShown + numberOfPoints)
  {
    return;
  }
  vtkUnsignedCharArray* pointGhosts = RenewGhosts(output->GetPointData(), numberOfPoints);
  vtkUnsignedCharArray* cellGhosts = RenewGhosts(output->GetCellData(), numberOfCells);
  for (vtkIdType i = 0; i < numberOfPoints; ++i)
  {
    if (!mask->GetValue(i))
    {
      pointGhosts->SetValue(i, pointGhosts->GetValue(i) | vtkDataSetAttributes::HIDDENPOINT);
    }
  }
  const CellPoints cellPoints(cells);
  const auto ids = vtkSmartPointer<vtkIdList>::New();
  for (vtkIdType cell = 0; cell < numberOfCells; ++cell)
  {
    cellPoints.Get(cell, ids);
    if (std::any_of(ids->begin(), ids->end(), [=](vtkIdType point) {
          return point < 0 || point >= numberOfPoints || !mask->GetValue(point);
        }))
    {
      cellGhosts->SetValue(cell, cellGhosts->GetValue(cell) | vtkDataSetAttributes::HIDDENCELL);
    }
  }
}

} // namespace homeomorphism

#endif
