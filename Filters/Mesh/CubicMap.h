// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CubicMap.h
/// The Cubic map of a pair of plane triangulations: C1 with a positive determinant at every inner
/// point, one to one, with its inverse.

#ifndef homeomorphism_CubicMap_h
#define homeomorphism_CubicMap_h

#include "Mesh/BendingSolve.h"
#include "Mesh/CubicMapOptions.h"
#include "Mesh/CubicTemplate.h"
#include "Mesh/CubicTriangle.h"
#include "Mesh/PlanarPair.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

namespace homeomorphism
{

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

/// Points that are mapped together, as a structure of arrays.
struct CubicBatch
{
  static constexpr int Capacity = 256;
  /// Capacity rounded up to whole SIMD vectors.
  static constexpr int Size = Capacity + WidestVector;

  int Count = 0;
  /// The triangle of each point where the piecewise linear map, or its inverse, has it; negative
  /// for a point that is not to be mapped.
  std::int32_t Triangles[Capacity];
  /// Barycentric coordinates for its corners 0, 1, 2.
  double L[3][Size];
  /// The points, and their images or preimages.
  double X[Size];
  double Y[Size];
  double ImageX[Size];
  double ImageY[Size];
};

/// Immutable; any number of threads may use it.
class CubicMap
{
public:
  /// Fourth powers of lengths must be representable: coordinates should be about 1. Otherwise
  /// triangles are not certified. The options must be possible for the number of triangles.
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
  const LargeVector<double>& GetCertificates() const { return this->Certificates; }
  bool IsCertified(int triangle) const { return this->Certificates[triangle] > 0.0; }

  /// What the functions below need to be fast for many points, one triangle after another.
  CubicTriangle Prepare(std::size_t kept = CubicTriangle::FewTriangles) const
  {
    return CubicTriangle(*this->Template, this->Bending.get(), kept);
  }

  /// What MapPoints reads of a triangle, null if little.
  const CubicNet* GetNet(int triangle) const
  {
    return this->Levels == 0 && this->Bending && !this->Bending->Nets.empty()
      ? &this->Bending->Nets[triangle]
      : nullptr;
  }

  /// Sets the images of a batch. They do not depend on what else is in the batch.
  void MapPoints(CubicBatch& batch, CubicTriangle& prepared) const;

  /// Sets the preimages of a batch, and the triangles in which they lie: -1 where no point of the
  /// domain is found, which happens to an image outside the target's domain only. They do not
  /// depend on what else is in the batch.
  void FindPreimages(CubicBatch& batch, CubicTriangle& prepared) const;

  /// The image of a point of a triangle.
  Vector2 MapPoint(int triangle, const Vector2& point, CubicTriangle& prepared) const;

  /// The derivative at a point of a triangle.
  Matrix2 GetDerivative(int triangle, const Vector2& point) const;

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
  bool IsWhole(int fineTriangle) const
  {
    return this->Bending && this->Bending->Cuts[fineTriangle] < 0;
  }
  int FindChild(int triangle, const Vector2& point) const;
  /// The triangle of the refined pair at a point of a triangle, whose coordinates become those in
  /// it.
  int FindChild(int triangle, Barycentric& l) const;
  void MoveToChildren(CubicBatch& batch) const;
  struct Walkers;
  /// Chebyshev's method in whole triangles, as far as it goes; the rest is left to FindByWalking.
  void FindByNets(CubicBatch& batch, Walkers& walkers, CubicTriangle& prepared) const;
  /// Finds the preimage that is near a point relative to corner 0 of a triangle of the refined
  /// pair; both are changed.
  bool FindByWalking(
    const Vector2& image, int& triangle, Vector2& point, CubicTriangle& prepared) const;
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
  LargeVector<double> Certificates;
  double ResidualTolerance = 0.0;
  CubicMapStatistics Statistics;
};

} // namespace homeomorphism

#endif
