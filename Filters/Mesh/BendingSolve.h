// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file BendingSolve.h
/// The cubic map of least bending among certified ones.

#ifndef homeomorphism_BendingSolve_h
#define homeomorphism_BendingSolve_h

#include "Mesh/CubicTemplate.h"
#include "Mesh/LargeArray.h"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace homeomorphism
{

/// A node of a map: displacement from the piecewise linear image, and the map's derivative.
struct BendingNode
{
  Vector2 Value;
  Matrix2 Gradient;
};

struct BendingOptions
{
  /// The greatest distance from the piecewise linear map.
  double MaximumDeviation = std::numeric_limits<double>::infinity();
  /// A determinant's least Bernstein coefficient, over the affine determinant in a whole triangle
  /// and over the template's own least coefficient in an element of a cut one.
  double CertificateMargin = 0.02;
  /// Above this number of unknowns systems are solved by conjugate gradients.
  int DirectUnknowns = 200000;
};

struct BendingStatistics
{
  /// Linear systems solved.
  int Rounds = 0;
  /// How often the certified solution became the new aim.
  int ProximalRounds = 0;
  /// Cut triangles, and those of them that are the template to a thousandth of its derivatives.
  int CutTriangles = 0;
  int TemplateTriangles = 0;
  /// The integral of the squared second derivatives, in the units of the target, squared.
  double Energy = 0.0;
  /// Of the certified maps that were found in rounds, the energy that is minimized, in which thin
  /// elements count less. Each is below the one before; the last is the result's.
  std::vector<double> MinimizedEnergies;
  /// Whether the rounds ran out or a system could not be solved, so that the template itself had to
  /// be taken.
  bool TookTemplate = false;
};

/// Every triangle is one element between its corners, or cut like the template's.
struct BendingSolution
{
  /// At the points.
  LargeVector<BendingNode> Points;
  /// Of each triangle, where its nodes are in CutNodes, or -1.
  LargeVector<std::int32_t> Cuts;
  /// Of whole triangles, relative to corner 0; empty if all triangles are cut.
  LargeArray<CubicNet> Nets;
  /// Of each triangle, a lower bound of the determinant over the affine one, from
  /// SolveWithWholeTriangles; empty otherwise.
  LargeVector<double> Certificates;
  /// Nodes 3 to 14 of a TriangleCut.
  std::vector<std::array<BendingNode, 12>> CutNodes;
  BendingStatistics Statistics;

  BendingNode GetNode(const PlanarPair& pair, int triangle, int node) const
  {
    return node < 3 ? this->Points[pair.Triangles[triangle][node]]
                    : this->CutNodes[this->Cuts[triangle]][node - 3];
  }

  /// A whole triangle's element, relative to corner 0.
  CubicElement GetWhole(const PlanarPair& pair, const Matrix2& affine, int triangle) const;

  /// An element of a cut triangle, relative to the cut's GetOrigin(element).
  CubicElement GetElement(const PlanarPair& pair, const TriangleCut& cut, const Matrix2& affine,
    int triangle, int element) const;
};

/// Minimizes the integral of the squared second derivatives over the gradients at the points, every
/// triangle being one element. Returns whether the solution is certified: then it is the result of
/// SolveForLeastBending, in a fraction of the time. Of the template, only the boundary is needed.
bool SolveWithWholeTriangles(const CubicTemplate& cubicTemplate, const BendingOptions& options,
  BendingSolution& solution, const ParallelFor& parallelFor = SerialFor);

/// Minimizes the integral of the squared second derivatives over all gradients and over the values
/// of all nodes but the points'. Where the determinant is not certified, the solution is pulled
/// towards a certified map, first the triangle's own affine one, then, the triangle being cut, the
/// template, ever harder until all is certified; it then becomes the aim from which the pull
/// is relaxed, as long as the bending falls. Of elements far thinner than their triangles, only a
/// share of the bending is minimized. @a isFree marks points whose value is an unknown too.
/// Corners that the template does not find differentiable keep the template's elements.
BendingSolution SolveForLeastBending(const CubicTemplate& cubicTemplate,
  const BendingOptions& options, const std::vector<std::uint8_t>& isFree,
  const ParallelFor& parallelFor = SerialFor);

} // namespace homeomorphism

#endif
