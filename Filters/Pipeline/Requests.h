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

/// Whether the information of an input port allows the type of @a data. This is also true if @a
/// data is null, and if it is composite and the executive iterates over its blocks.
bool IsAcceptedType(vtkInformation* portInformation, vtkDataObject* data);

/// Declares that an output changes with the time steps of the first @a ports inputs: its time steps
/// and time range are the union of theirs. By default, they are those of port 0, and for other
/// times the executive would reuse the previous output.
void DescribeTimesInOutput(vtkInformationVector** inputs, int ports, vtkInformation* outInfo);

/// For filters whose other inputs are meshes: copies the information of the data's port, if there
/// is data, so that it describes the extent of the output. By default, the information is that of
/// port 0.
void DescribeDataInOutput(vtkInformation* dataInfo, vtkInformation* outInfo);

/// Requests an input as a whole, whatever piece of the output is requested.
void RequestWhole(vtkInformation* info);

/// A key in the information of an input port: the input is always requested as a whole.
vtkInformationIntegerKey* RequestedWhole();

/// Adds the algorithms upstream of a port, including those connected to it, to @a found. With
/// @a inPieces, adds only those from which the same piece is requested.
void CollectUpstream(
  vtkAlgorithm* algorithm, int port, bool inPieces, std::set<vtkAlgorithm*>& found);

/// Whether a port depends upstream on the same algorithms as the ports before it, which are
/// requested as a whole. An algorithm cannot be requested both as a whole and in pieces. This port
/// must then also be requested as a whole, and its results are part of piece 0.
bool SharesUpstreamWithPortsBefore(vtkAlgorithm* algorithm, int port);

/// Puts a new object of a type into an output, unless it already has one of that type.
template <typename Type>
void MakeOutput(vtkInformation* outInfo)
{
  if (!Type::SafeDownCast(vtkDataObject::GetData(outInfo)))
  {
    outInfo->Set(vtkDataObject::DATA_OBJECT(), vtkSmartPointer<Type>::New());
  }
}

/// Puts a new object of the type of @a data into an output, unless it already has one of that type.
void MakeOutputLike(vtkDataObject* data, vtkInformation* outInfo);

/// Whether a request includes the results that depend only on the meshes. The meshes are read as a
/// whole for every piece, but only the first piece contains these results.
bool IsFirstPiece(vtkInformation* request, vtkInformationVector* outputs);

} // namespace homeomorphism

#endif
