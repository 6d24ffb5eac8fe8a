// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Requests.h
/// Pipeline requests of the filters.

#ifndef homeomorphism_Requests_h
#define homeomorphism_Requests_h

#include "vtkAlgorithm.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkSmartPointer.h"

#include <set>

class vtkInformationIntegerKey;

namespace homeomorphism
{

/// Declares that the input of a port may be a data set or a tree of data sets. The type of trees
/// comes first, because executives that iterate over composite inputs for simple filters check only
/// the first type.
void AcceptDataSetsAndTrees(vtkInformation* info);

/// Whether the information of an input port allows data of this type. So it does if there is none,
/// and if the data is composite and the executive goes through its blocks.
bool IsAcceptedType(vtkInformation* portInformation, vtkDataObject* data);

/// Announces that an output changes with the time steps of the first @a ports inputs: its time
/// steps and time range are the union of theirs. By default they are those of port 0, and for other
/// times the executive reuses the previous output.
void DescribeTimesInOutput(vtkInformationVector** inputs, int ports, vtkInformation* outInfo);

/// For a filter whose other inputs are meshes: copies the information of the data's port, if there
/// is data, so that it describes the extent of the output. By default that comes from port 0.
void DescribeDataInOutput(vtkInformation* dataInfo, vtkInformation* outInfo);

/// Requests an input as a whole, whatever piece of the output is requested.
void RequestWhole(vtkInformation* info);

/// In the information of an input port: the input is always requested whole.
vtkInformationIntegerKey* RequestedWhole();

/// Adds the algorithms upstream of a port, including those connected to it. @a inPieces: only if
/// the same piece is requested from them.
void CollectUpstream(
  vtkAlgorithm* algorithm, int port, bool inPieces, std::set<vtkAlgorithm*>& found);

/// Whether a port and the ports before it, which are requested whole, depend
/// on the same algorithms. Those cannot be requested both whole and in pieces,
/// so this port must be requested whole too, and its results are part of piece
/// 0.
bool SharesUpstreamWithPortsBefore(vtkAlgorithm* algorithm, int port);

/// Puts a new object of a type into an output unless it has one of that type.
template <typename Type>
void MakeOutput(vtkInformation* outInfo)
{
  if (!Type::SafeDownCast(vtkDataObject::GetData(outInfo)))
  {
    outInfo->Set(vtkDataObject::DATA_OBJECT(), vtkSmartPointer<Type>::New());
  }
}

/// Puts a new object of the type of @a data into an output unless it has one of that type.
void MakeOutputLike(vtkDataObject* data, vtkInformation* outInfo);

/// Whether a request includes the results of the meshes alone. The meshes are read whole for every
/// piece, and only the first piece contains these results.
bool IsFirstPiece(vtkInformation* request, vtkInformationVector* outputs);

} // namespace homeomorphism

#endif
