// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Requests.h"

#include "vtkCompositeDataSet.h"
#include "vtkExecutive.h"
#include "vtkInformationIntegerKey.h"
#include "vtkInformationStringVectorKey.h"
#include "vtkStreamingDemandDrivenPipeline.h"

#include <algorithm>
#include <string>
#include <vector>

namespace homeomorphism
{

void AcceptDataSetsAndTrees(vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataObjectTree");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkDataSet");
}

bool IsAcceptedType(vtkInformation* portInformation, vtkDataObject* data)
{
  auto* types = vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE();
  const int count = types->Length(portInformation);
  bool accepted = !data || count == 0 || vtkCompositeDataSet::SafeDownCast(data);
  for (int i = 0; i < count && !accepted; ++i)
  {
    accepted = data->IsA(types->Get(portInformation, i)) != 0;
  }
  return accepted;
}

void DescribeTimesInOutput(vtkInformationVector** inputs, int ports, vtkInformation* outInfo)
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

void DescribeDataInOutput(vtkInformation* dataInfo, vtkInformation* outInfo)
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

void RequestWhole(vtkInformation* info)
{
  using Pipeline = vtkStreamingDemandDrivenPipeline;
  if (!info)
  {
    return;
  }
  info->Set(Pipeline::UPDATE_PIECE_NUMBER(), 0);
  info->Set(Pipeline::UPDATE_NUMBER_OF_PIECES(), 1);
  info->Set(Pipeline::UPDATE_NUMBER_OF_GHOST_LEVELS(), 0);
  // The extent in the request is that of the output, which has no meaning for this input.
  if (info->Has(Pipeline::WHOLE_EXTENT()))
  {
    info->Set(Pipeline::UPDATE_EXTENT(), info->Get(Pipeline::WHOLE_EXTENT()), 6);
  }
  else
  {
    info->Remove(Pipeline::UPDATE_EXTENT());
  }
}

vtkInformationIntegerKey* RequestedWhole()
{
  static vtkInformationIntegerKey* const key =
    vtkInformationIntegerKey::MakeKey("REQUESTED_WHOLE", "FiltersHomeomorphism");
  return key;
}

void CollectUpstream(
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
      if (!inPieces || !producer->GetInputPortInformation(next)->Has(RequestedWhole()))
      {
        CollectUpstream(producer, next, inPieces, found);
      }
    }
  }
}

bool SharesUpstreamWithPortsBefore(vtkAlgorithm* algorithm, int port)
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

void MakeOutputLike(vtkDataObject* data, vtkInformation* outInfo)
{
  vtkDataObject* current = vtkDataObject::GetData(outInfo);
  if (!current || std::string(current->GetClassName()) != data->GetClassName())
  {
    outInfo->Set(
      vtkDataObject::DATA_OBJECT(), vtkSmartPointer<vtkDataObject>::Take(data->NewInstance()));
  }
}

bool IsFirstPiece(vtkInformation* request, vtkInformationVector* outputs)
{
  const int port = request->Has(vtkExecutive::FROM_OUTPUT_PORT())
    ? std::max(0, request->Get(vtkExecutive::FROM_OUTPUT_PORT()))
    : 0;
  return outputs->GetInformationObject(port)->Get(
           vtkStreamingDemandDrivenPipeline::UPDATE_PIECE_NUMBER()) <= 0;
}

} // namespace homeomorphism
