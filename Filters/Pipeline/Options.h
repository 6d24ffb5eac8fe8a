// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Options.h
/// Conversion and printing of the options of filters and transforms.

#ifndef homeomorphism_Options_h
#define homeomorphism_Options_h

#include "vtkHomeomorphismOptions.h"

#include "Mesh/Homeomorphism.h"

#include "vtkIndent.h"
#include "vtkType.h"

#include <limits>

namespace homeomorphism
{

/// The options of a vtkHomeomorphismAlgorithm or vtkHomeomorphismTransform.
template <typename Algorithm>
HomeomorphismOptions GetOptions(Algorithm* self)
{
  HomeomorphismOptions options;
  options.System = static_cast<CoordinateSystem>(self->GetCoordinateSystem());
  options.Center = static_cast<CenterPoint>(self->GetCenterPoint());
  options.MaskInvalidTriangles = self->GetMaskInvalidTriangles();
  options.DiscordantByLinear = self->GetDiscordantTriangles() == Algorithm::USE_LINEAR;
  options.Cubic.Bending = static_cast<CubicBending>(self->GetCubicBending());
  // The greatest value of the option, 1e299, limits nothing, however large the meshes are.
  options.Cubic.MaximumDeviation = self->GetMaximumDeviation() < VTK_DOUBLE_MAX
    ? self->GetMaximumDeviation()
    : std::numeric_limits<double>::infinity();
  options.Cubic.CertificateMargin = self->GetCertificateMargin();
  options.Cubic.FairnessRefinement = self->GetFairnessRefinement();
  return options;
}

/// Sets the options of @a to to those of @a from.
template <typename From, typename To>
void CopyOptions(From* from, To* to)
{
#define CopyOption(name, ...) to->Set##name(from->Get##name())
  vtkHomeomorphismOptionsList(CopyOption, CopyOption);
#undef CopyOption
}

/// Prints the options.
template <typename Algorithm>
void PrintOptions(Algorithm* self, ostream& os, vtkIndent indent)
{
#define PrintOption(name, ...) os << indent << #name ": " << self->Get##name() << "\n"
  vtkHomeomorphismOptionsList(PrintOption, PrintOption);
#undef PrintOption
}

/// Prints the options of filters that map data.
template <typename Algorithm>
void PrintMappingOptions(Algorithm* self, ostream& os, vtkIndent indent)
{
#define PrintOption(name, ...) os << indent << #name ": " << self->Get##name() << "\n"
  vtkHomeomorphismMappingList(PrintOption);
#undef PrintOption
}

} // namespace homeomorphism

#endif
