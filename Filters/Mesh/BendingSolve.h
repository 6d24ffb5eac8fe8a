// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file BendingSolve.h
/// The certified cubic map of least bending.

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

/// A node of a map: the displacement from the piecewise linear image, and the map's derivative.
struct BendingNode
{
  Vector2 Value;
  Matrix2 Gradient;
};

struct BendingOptions
{
  /// The greatest distance from the piecewise linear map.
  double MaximumDeviation = std::numeric_limits<double>::infinity();
  /// The smallest accepted Bernstein coefficient of the determinant, divided by the affine
  /// determinant in a whole triangle, and by the template's smallest coefficient in an element of a
  /// cut triangle.
  double CertificateMargin = 0.02;
  /// The number of unknowns above which systems are solved by conjugate gradients.
  int DirectUnknowns = 200000;
};

struct BendingStatistics
{
  /// Linear systems solved.
  int Rounds = 0;
  /// How often a certified solution replaced the template in the penalty.
  int ProximalRounds = 0;
  /// The number of cut triangles, and of those among them that differ from the template by less
  /// than a thousandth of its derivatives.
  int CutTriangles = 0;
  int TemplateTriangles = 0;
  /// The integral of the squared second derivatives, in the units of the target, squared.
  double Energy = 0.0;
  /// The minimized energy, in which thin elements have less weight, of each certified map that was
  /// found. The energies decrease; the last one is that of the result.
  std::vector<double> MinimizedEnergies;
  /// Whether the result is the template itself, because the limit of rounds was reached or a system
  /// could not be solved.
  bool TookTemplate = false;
};

/// A map in which every triangle is either one element (whole) or cut as in the template.
struct BendingSolution
{
  /// The nodes at the points.
  LargeVector<BendingNode> Points;
  /// For each triangle, the index of its nodes in CutNodes, or -1.
  LargeVector<std::int32_t> Cuts;
  /// The nets of whole triangles, relative to corner 0; empty if all triangles are cut.
  LargeArray<CubicNet> Nets;
  /// For each triangle, a lower bound of the determinant divided by the affine one; empty unless
  /// SolveWithWholeTriangles made the map.
  LargeVector<double> Certificates;
  /// Nodes 3 to 14 of each TriangleCut.
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

/// Minimizes the integral of the squared second derivatives over the gradients at the points, with
/// every triangle as one element. Returns whether the solution is certified. If so, it is also the
/// result of SolveForLeastBending, in a fraction of the time. Uses only the boundary of the
/// template.
bool SolveWithWholeTriangles(const CubicTemplate& cubicTemplate, const BendingOptions& options,
  BendingSolution& solution, const ParallelFor& parallelFor = SerialFor);

/// Minimizes the integral of the squared second derivatives over all gradients and over the values
/// of all nodes except those at points. Where the determinant is not certified, a penalty is
/// added to the energy: the squared distance from a certified map, first from the triangle's affine
/// map and then, in cut triangles, from the template. Its weight grows until all triangles are
/// certified. The solution then replaces the template in the penalty, and the weight is reduced as
/// long as the bending decreases. In elements that are much thinner than their triangles, only a
/// fraction of the bending is minimized. @a isFree marks points whose value is also an unknown.
/// Corners at vertices at which the template is not differentiable keep the template's elements.
/// See Documentation/cubic.md.
BendingSolution SolveForLeastBending(const CubicTemplate& cubicTemplate,
  const BendingOptions& options, const std::vector<std::uint8_t>& isFree,
  const ParallelFor& parallelFor = SerialFor);

} // namespace homeomorphism

#endif
