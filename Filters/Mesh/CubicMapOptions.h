// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CubicMapOptions.h
/// The options of the Cubic map of a pair.

#ifndef homeomorphism_CubicMapOptions_h
#define homeomorphism_CubicMapOptions_h

#include <cstdint>
#include <limits>

namespace homeomorphism
{

/// The choice among certified maps.
enum class CubicBending
{
  /// The template: in closed form; it depends only on nearby vertices.
  Local = 0,
  /// The map of least bending for which a certificate was found.
  Least = 1
};

struct CubicMapOptions
{
  CubicBending Bending = CubicBending::Least;
  /// The largest allowed distance from the piecewise linear map, in the units of the target.
  double MaximumDeviation = std::numeric_limits<double>::infinity();
  /// See BendingOptions.
  double CertificateMargin = 0.02;
  /// With least bending, the number of times that triangles are first divided into four.
  int FairnessRefinement = 0;

  /// With least bending, the largest number of triangles after refinement. Each may have 27
  /// unknowns, which are numbered with 32 bits.
  static constexpr std::int64_t MostTriangles = std::int64_t(1) << 26;

  /// The number of triangles of a map of @a count triangles.
  std::int64_t GetNumberOfRefined(std::int64_t count) const
  {
    return this->Bending == CubicBending::Least ? count << (2 * this->FairnessRefinement) : count;
  }
  bool IsPossible(std::int64_t count) const
  {
    return this->Bending != CubicBending::Least || this->GetNumberOfRefined(count) <= MostTriangles;
  }

  bool operator==(const CubicMapOptions& other) const
  {
    return this->Bending == other.Bending && this->MaximumDeviation == other.MaximumDeviation &&
      this->CertificateMargin == other.CertificateMargin &&
      this->FairnessRefinement == other.FairnessRefinement;
  }
};

} // namespace homeomorphism

#endif
