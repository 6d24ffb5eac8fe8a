// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Requests.h
/// What filters request from their inputs and announce of their outputs.

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

/// Whether the algorithm's input may be a data set or a tree of them. The type of trees comes
/// first: executives that iterate over composite inputs on behalf of simple filters look only at
/// it.
void AcceptDataSetsAndTrees(vtkInformation* info);

/// Whether the information of an input port allows data of this type. So it does if there is none,
/// and if the data is composite and the executive goes through its blocks.
bool IsAcceptedType(vtkInformation* portInformation, vtkDataObject* data);

/// Tells that an output may change whenever one of the first @a ports inputs does: its time steps
/// and time range are all of theirs. By default they are those of port 0, and at other times the
/// executive takes what was made before for good.
void DescribeTimesInOutput(vtkInformationVector** inputs, int ports, vtkInformation* outInfo);

/// Of a filter whose other inputs are meshes: lets the information of the data's port, if there is
/// data, describe the output's extent, which by default comes from port 0.
void DescribeDataInOutput(vtkInformation* dataInfo, vtkInformation* outInfo);

/// Asks for an input as a whole, whatever piece of the output is asked for.
void RequestWhole(vtkInformation* info);

/// In the information of an input port: it is always asked for whole.
vtkInformationIntegerKey* RequestedWhole();

/// Adds the algorithms that the ones connected to a port depend on, themselves included; @a
/// inPieces: only if the same piece is asked from them.
void CollectUpstream(
  vtkAlgorithm* algorithm, int port, bool inPieces, std::set<vtkAlgorithm*>& found);

/// Whether what comes in at a port and what comes in at the ports before it, which are asked for
/// whole, are made from the same things. Those cannot be asked for both whole and in pieces at the
/// same time: then this port must be asked for whole, too, and what becomes of it is part of piece
/// 0.
bool SharesUpstreamWithPortsBefore(vtkAlgorithm* algorithm, int port);

/// Puts a new object of a type into an output, unless one of that type is there.
template <typename Type>
void MakeOutput(vtkInformation* outInfo)
{
  if (!Type::SafeDownCast(vtkDataObject::GetData(outInfo)))
  {
    outInfo->Set(vtkDataObject::DATA_OBJECT(), vtkSmartPointer<Type>::New());
  }
}

/// Puts a new object of the type of @a data into an output, unless it has one of that type.
void MakeOutputLike(vtkDataObject* data, vtkInformation* outInfo);

/// Whether what is made from the meshes alone belongs to a request: they are read whole for every
/// piece, and only the first piece gets what they make.
bool IsFirstPiece(vtkInformation* request, vtkInformationVector* outputs);

} // namespace homeomorphism

#endif
