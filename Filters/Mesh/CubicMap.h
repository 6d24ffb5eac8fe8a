// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CubicMap.h
/// The Cubic map of a pair of plane triangulations: C1 with a positive determinant at every
/// interior point, and one to one; and its inverse.

#ifndef homeomorphism_CubicMap_h
#define homeomorphism_CubicMap_h

#include "Kernel/Simd/CubicBatch.h"
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
  /// The number of elements; of an infinite sequence of rings, one is counted.
  std::int64_t Elements = 0;
  int Rings = 0;
  std::vector<std::int32_t> ExceptionalInteriorPoints;
  std::vector<std::int32_t> ExceptionalBoundaryPoints;
  /// The number of triangles that are not certified. It is 0 unless doubles cannot represent the
  /// elements of a triangle.
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
  /// The triangle that contains each point, in the mesh that is mapped from; negative for points
  /// that are not mapped.
  std::int32_t Triangles[Capacity];
  /// Barycentric coordinates for its corners 0, 1, 2.
  double L[3][Size];
  /// The points, and their images or preimages.
  double X[Size];
  double Y[Size];
  double ImageX[Size];
  double ImageY[Size];

  /// Calls use(begin, end, triangle) for consecutive points in the same triangle.
  template <typename Use>
  void ForEachRun(Use&& use) const
  {
    for (int begin = 0; begin < this->Count;)
    {
      const std::int32_t triangle = this->Triangles[begin];
      int end = begin + 1;
      while (end < this->Count && this->Triangles[end] == triangle)
      {
        ++end;
      }
      if (triangle >= 0)
      {
        use(begin, end, triangle);
      }
      begin = end;
    }
  }
};

/// The map. Immutable; any number of threads may use it.
class CubicMap
{
public:
  /// Coordinates should be about 1: triangles are not certified if fourth powers of lengths are not
  /// representable. The options must be possible (CubicMapOptions::IsPossible) for the number of
  /// triangles.
  CubicMap(
    PlanarPair pair, const CubicMapOptions& options, const ParallelFor& parallelFor = SerialFor);
  CubicMap(const CubicMap&) = delete;
  void operator=(const CubicMap&) = delete;

  /// The original pair, without refinement.
  const PlanarPair& GetPair() const { return this->Pair; }
  const CubicMapStatistics& GetStatistics() const { return this->Statistics; }

  /// For each triangle of the pair, the smallest Bernstein coefficient of the determinant, divided
  /// by the determinant of the piecewise linear map. The map is certified in the triangle if it is
  /// positive.
  const LargeVector<double>& GetCertificates() const { return this->Certificates; }
  bool IsCertified(int triangle) const { return this->Certificates[triangle] > 0.0; }

  /// Working data with which the functions below are fast for many points, one triangle after
  /// another. Each thread needs its own.
  CubicTriangle Prepare(std::size_t kept = CubicTriangle::FewTriangles) const
  {
    return CubicTriangle(*this->Template, this->Bending.get(), kept);
  }

  /// The net that MapPoints and FindPreimages read, null if the triangle is not a whole element;
  /// and the approximation of the inverse that FindPreimages reads.
  const CubicNet* GetNet(int triangle) const
  {
    return this->HasNets() ? &this->Bending->Nets[triangle] : nullptr;
  }
  const InverseInterpolant* GetInverse(int triangle) const
  {
    return this->HasNets() ? &this->Inverses[triangle] : nullptr;
  }

  /// Sets the images of a batch. The image of a point does not depend on the other points.
  void MapPoints(CubicBatch& batch, CubicTriangle& prepared) const;

  /// The image of one point; the same, bit for bit, as that of MapPoints. @a l are its barycentric
  /// coordinates.
  Vector2 MapPoint(
    int triangle, const Barycentric& l, const Vector2& point, CubicTriangle& prepared) const;
  Vector2 MapPoint(int triangle, const Vector2& point, CubicTriangle& prepared) const
  {
    return this->MapPoint(triangle, this->GetBarycentric(triangle, point), point, prepared);
  }

  /// Sets the preimages of a batch, and the triangles in which they lie, -1 if no preimage is
  /// found, which happens only outside the target's domain. The preimage of a point does not depend
  /// on the other points.
  void FindPreimages(CubicBatch& batch, CubicTriangle& prepared) const;

  /// The derivative at a point of a triangle.
  Matrix2 GetDerivative(int triangle, const Vector2& point, CubicTriangle& prepared) const;

  /// The point that is mapped to @a image, and its triangle. On input, @a triangle is that of the
  /// preimage under the piecewise linear map. Returns false if no preimage is found, which happens
  /// only outside the target's domain. With the barycentric coordinates @a l of the image in the
  /// target's triangle, the preimage is the same, bit for bit, as that of FindPreimages.
  bool FindPreimage(const Vector2& image, const Barycentric& l, int& triangle, Vector2& point,
    CubicTriangle& prepared) const;
  bool FindPreimage(
    const Vector2& image, int& triangle, Vector2& point, CubicTriangle& prepared) const
  {
    return this->FindPreimage(image,
      ToBarycentric(this->Pair.GetTargetCorners(triangle),
        image - this->Pair.Target[this->Pair.Triangles[triangle][0]]),
      triangle, point, prepared);
  }
  bool FindPreimage(const Vector2& image, int& triangle, Vector2& point) const
  {
    CubicTriangle prepared = this->Prepare();
    return this->FindPreimage(image, triangle, point, prepared);
  }

  /// Calls @a visit with every element of a triangle of the pair, relative to the given origins in
  /// the source and in the target, and the factor by which it is shrunk about them. Of an infinite
  /// sequence of rings, the first @a endlessRings are visited.
  void VisitElements(int triangle,
    const std::function<void(const CubicElement& element, const Vector2& sourceOrigin,
      const Vector2& targetOrigin, double factor)>& visit,
    int endlessRings = 1) const;

private:
  const PlanarPair& GetFine() const { return this->Fine ? *this->Fine : this->Pair; }
  bool HasNets() const
  {
    return this->Levels == 0 && this->Bending && !this->Bending->Nets.empty();
  }
  bool IsWhole(int fineTriangle) const
  {
    return this->Bending && this->Bending->Cuts[fineTriangle] < 0;
  }
  Barycentric GetBarycentric(int triangle, const Vector2& point) const
  {
    return ToBarycentric(this->Pair.GetSourceCorners(triangle),
      point - this->Pair.Source[this->Pair.Triangles[triangle][0]]);
  }
  /// Whether a point is in the middle of a triangle, where the template is affine.
  bool IsInMiddle(int fineTriangle, const Barycentric& l) const;
  int FindChild(int triangle, const Vector2& point) const;
  /// The triangle of the refined pair that contains a point of a triangle; @a l becomes the
  /// coordinates there.
  int FindChild(int triangle, Barycentric& l) const;
  void MoveToChildren(CubicBatch& batch) const;
  struct Walkers;
  /// Replaces a triangle of the refined pair by the one that contains the point with barycentric
  /// coordinates @a l, usually outside. Sets the point relative to corner 0, and returns its
  /// coordinates.
  Barycentric Leave(int& triangle, const Barycentric& l, Vector2& point) const;
  /// Adds points of a whole triangle, at the values of the inverse's interpolant.
  void StartWalking(
    const CubicBatch& batch, int begin, int end, int triangle, Walkers& walkers) const;
  /// Adds points that enter whole triangles, as long as there is room.
  void EnterTriangles(const CubicBatch& batch, Walkers& walkers) const;
  /// Finds the preimages of all walkers in whole triangles. Points for which the iteration fails
  /// are left to FindByWalking.
  void FindByNets(CubicBatch& batch, Walkers& walkers, CubicTriangle& prepared) const;
  /// Finds the preimage that is near a point relative to corner 0 of a triangle of the refined
  /// pair; both are changed.
  bool FindByWalking(
    const Vector2& image, int& triangle, Vector2& point, CubicTriangle& prepared) const;
  /// MapPoint in a triangle of the refined pair.
  Vector2 MapFinePoint(
    int child, const Barycentric& l, const Vector2& point, CubicTriangle& prepared) const;
  void MapFine(int triangle, const Vector2& point, Vector2& image, Matrix2& derivative) const;
  /// Replaces the triangle by the one that contains the point, and makes the point relative to its
  /// corner 0.
  void Walk(int& triangle, Vector2& point) const;
  /// The largest distance between the image of a preimage and the given image that is accepted if
  /// it cannot be reduced. @a derivative is that at the preimage.
  double GetTolerance(int fineTriangle, const Matrix2& derivative) const;
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
  /// For whole triangles; empty if all triangles are cut.
  LargeArray<InverseInterpolant> Inverses;
  LargeVector<double> Certificates;
  /// Residuals of this many ulp of the target's coordinates are rounding.
  static constexpr double ResidualUlps = 4.0;
  double ResidualTolerance = 0.0;
  CubicMapStatistics Statistics;
};

} // namespace homeomorphism

#endif
