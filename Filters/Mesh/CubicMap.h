// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CubicMap.h
/// The Cubic map of a pair of plane triangulations: C1 with a positive determinant at every inner
/// point, one to one, with its inverse.

#ifndef homeomorphism_CubicMap_h
#define homeomorphism_CubicMap_h

#include "Mesh/BendingSolve.h"
#include "Mesh/CubicTemplate.h"
#include "Mesh/CubicTriangle.h"
#include "Mesh/PlanarPair.h"

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

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

struct CubicMapStatistics
{
  /// Elements, endless sequences of rings counted once.
  std::int64_t Elements = 0;
  int Rings = 0;
  std::vector<std::int32_t> ExceptionalInteriorPoints;
  std::vector<std::int32_t> ExceptionalBoundaryPoints;
  /// Triangles that are not certified: none, unless doubles cannot represent their elements.
  int UncertifiedTriangles = 0;
  BendingStatistics Bending;
};

/// Immutable; any number of threads may use it.
class CubicMap
{
public:
  CubicMap(
    PlanarPair pair, const CubicMapOptions& options, const ParallelFor& parallelFor = SerialFor);
  CubicMap(const CubicMap&) = delete;
  void operator=(const CubicMap&) = delete;

  /// The pair, not refined.
  const PlanarPair& GetPair() const { return this->Pair; }
  const CubicMapStatistics& GetStatistics() const { return this->Statistics; }

  /// Of each triangle of the pair: the least Bernstein coefficient of the determinant over the
  /// determinant of the piecewise linear map. The map is certified in the triangle if it is
  /// positive.
  const std::vector<double>& GetCertificates() const { return this->Certificates; }

  /// What the functions below need to be fast for many points, one triangle after another.
  CubicTriangle Prepare() const { return CubicTriangle(*this->Template, this->Bending.get()); }

  /// The image of a point of a triangle.
  Vector2 MapPoint(int triangle, const Vector2& point, CubicTriangle& prepared) const;

  /// The image of a point of a triangle, and the derivative there.
  void MapPoint(int triangle, const Vector2& point, Vector2& image, Matrix2& derivative) const;

  /// The point that is mapped to @a image, and the triangle in which it lies. @a triangle is where
  /// the piecewise linear map has it. Returns false if no point of the domain is found, which
  /// happens to an image outside the target's domain only.
  bool FindPreimage(
    const Vector2& image, int& triangle, Vector2& point, CubicTriangle& prepared) const;
  bool FindPreimage(const Vector2& image, int& triangle, Vector2& point) const
  {
    CubicTriangle prepared = this->Prepare();
    return this->FindPreimage(image, triangle, point, prepared);
  }

  /// Calls @a visit with every element of a triangle of the pair, relative to the given origins in
  /// the source and in the target, and the factor by which it is shrunk about them. Endless rings
  /// are visited down to @a endlessRings.
  void VisitElements(int triangle,
    const std::function<void(const CubicElement& element, const Vector2& sourceOrigin,
      const Vector2& targetOrigin, double factor)>& visit,
    int endlessRings = 1) const;

private:
  const PlanarPair& GetFine() const { return this->Fine ? *this->Fine : this->Pair; }
  int FindChild(int triangle, const Vector2& point) const;
  void MapFine(int triangle, const Vector2& point, Vector2& image, Matrix2& derivative) const;
  /// Moves a point relative to corner 0 of a triangle, and the triangle, to where the point is.
  void Walk(int& triangle, Vector2& point) const;
  bool SearchPreimage(const Vector2& image, int& triangle, Vector2& point) const;
  void VisitFine(int triangle,
    const std::function<void(const CubicElement& element, const Vector2& sourceOrigin,
      const Vector2& targetOrigin, double factor)>& visit,
    int endlessRings) const;

  PlanarPair Pair;
  /// The refined pair, each triangle cut into four Levels times.
  std::unique_ptr<PlanarPair> Fine;
  int Levels = 0;
  std::unique_ptr<CubicTemplate> Template;
  std::unique_ptr<BendingSolution> Bending;
  std::vector<double> Certificates;
  double ResidualTolerance = 0.0;
  CubicMapStatistics Statistics;
};

} // namespace homeomorphism

#endif
