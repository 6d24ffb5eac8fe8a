// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CubicMapOptions.h
/// Which Cubic map of a pair is meant.

#ifndef homeomorphism_CubicMapOptions_h
#define homeomorphism_CubicMapOptions_h

#include <limits>

namespace homeomorphism
{

/// Which certified map is taken.
enum class CubicBending
{
  /// The template: in closed form, as local as the pair.
  Local = 0,
  /// The one of least bending that could be certified.
  Least = 1
};

struct CubicMapOptions
{
  CubicBending Bending = CubicBending::Least;
  /// The greatest distance from the piecewise linear map, in the units of the target.
  double MaximumDeviation = std::numeric_limits<double>::infinity();
  /// See BendingOptions.
  double CertificateMargin = 0.02;
  /// With least bending: how often triangles are cut into four before.
  int FairnessRefinement = 0;

  bool operator==(const CubicMapOptions& other) const
  {
    return this->Bending == other.Bending && this->MaximumDeviation == other.MaximumDeviation &&
      this->CertificateMargin == other.CertificateMargin &&
      this->FairnessRefinement == other.FairnessRefinement;
  }
};

} // namespace homeomorphism

#endif
