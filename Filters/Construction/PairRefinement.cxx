// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "PairRefinement.h"

#include "Kernel/ExactSign.h"

#include "vtkPolyData.h"
#include "vtkSMPTools.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <tuple>
#include <unordered_map>

namespace homeomorphism
{
namespace
{

using Weights = std::array<double, 3>;
using Ends = std::array<vtkIdType, 2>;

/// A part of one of the original triangles.
struct Part
{
  std::array<vtkIdType, 3> Points;
  /// Barycentric coordinates of the points in the original triangle.
  std::array<Weights, 3> Corners;
  TriangleIndex Original;
  bool Divided = false;
  /// The number of grids on which the error was acceptable, and the error on the last one.
  std::size_t Passed = 0;
  double Error = 0.0;
};

struct EdgeHash
{
  std::size_t operator()(const Ends& edge) const
  {
    return std::hash<vtkIdType>()(edge[0] * vtkIdType(1000003) + edge[1]);
  }
};

/// Triangles with a smaller ratio of height to longest edge are not elongated further, because the
/// slightest bend would flip needles.
constexpr double Needle = 0.03;

/// The distance between the linear map of a part and the homeomorphism.
struct PartError
{
  /// At the inner points of the part and of its edges; infinite if the part is flipped.
  double Largest = 0.0;
  /// At the inner points of each edge.
  std::array<double, 3> OfEdges{ 0.0, 0.0, 0.0 };
};

/// The inner points of a triangle and of its edges, on a barycentric grid.
std::vector<Weights> MakeGrid(int divisions)
{
  std::vector<Weights> grid;
  for (int i = 0; i <= divisions; ++i)
  {
    for (int j = 0; j <= divisions - i; ++j)
    {
      const int k = divisions - i - j;
      if (i != divisions && j != divisions && k != divisions)
      {
        grid.push_back({ static_cast<double>(i) / divisions, static_cast<double>(j) / divisions,
          static_cast<double>(k) / divisions });
      }
    }
  }
  return grid;
}

template <typename Corner>
Vector3 Combine(const Weights& weights, Corner&& corner)
{
  Vector3 sum{ 0.0, 0.0, 0.0 };
  for (std::size_t k = 0; k < 3; ++k)
  {
    sum = Sum(sum, weights[k], corner(k));
  }
  return sum;
}

/// Moves a point that is on an edge, up to rounding, to the edge. Where the ends agree in a
/// coordinate, the result has exactly that coordinate.
Vector3 MoveToEdge(const Vector3& point, const Vector3& start, const Vector3& end)
{
  const Vector3 edge = Difference(end, start);
  std::size_t axis = 0;
  for (const std::size_t other : { 1, 2 })
  {
    axis = std::abs(edge[other]) > std::abs(edge[axis]) ? other : axis;
  }
  // Measured from the nearer end, so that points close to an end remain distinct.
  const double fromStart = (point[axis] - start[axis]) / edge[axis];
  const double fromEnd = (end[axis] - point[axis]) / edge[axis];
  return fromStart <= fromEnd ? Sum(start, std::max(fromStart, 0.0), edge)
                              : Sum(end, -std::max(fromEnd, 0.0), edge);
}

class Refiner
{
public:
  Refiner(const Homeomorphism& map, vtkPolyData* source, vtkPolyData* target)
    : Map(map)
    , NumberOfOldPoints(source->GetNumberOfPoints())
  {
    for (std::size_t side = 0; side < 2; ++side)
    {
      vtkPolyData* mesh = side == 0 ? source : target;
      this->Points[side].resize(static_cast<std::size_t>(this->NumberOfOldPoints));
      for (vtkIdType i = 0; i < this->NumberOfOldPoints; ++i)
      {
        mesh->GetPoint(i, this->Points[side][static_cast<std::size_t>(i)].data());
      }
    }
    const Triangulation& triangulation = map.GetPair().GetTriangulation();
    for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
    {
      if (!triangulation.IsMasked(t))
      {
        const Triangulation::Corners& corners = triangulation.GetCorners(t);
        this->Add({ { corners[0], corners[1], corners[2] },
          { { { 1.0, 0.0, 0.0 }, { 0.0, 1.0, 0.0 }, { 0.0, 0.0, 1.0 } } }, t });
      }
    }
  }

  vtkIdType GetNumberOfParts() const { return this->NumberOfParts; }
  bool IsDivided(std::size_t index) const { return this->Parts[index].Divided; }
  /// Whether an edge could not be bisected.
  bool IsBelowRounding() const { return this->BelowRounding; }

  /// The undivided parts that have passed a given number of grids, ascending.
  std::vector<std::size_t> GetParts(std::size_t passed) const
  {
    std::vector<std::size_t> parts;
    for (std::size_t i = 0; i < this->Parts.size(); ++i)
    {
      if (!this->Parts[i].Divided && this->Parts[i].Passed == passed)
      {
        parts.push_back(i);
      }
    }
    return parts;
  }

  /// Records that a part has passed another grid.
  void Pass(std::size_t index, double error)
  {
    ++this->Parts[index].Passed;
    this->Parts[index].Error = error;
  }

  /// Measures some parts at the points of a grid.
  std::vector<PartError> MeasureErrors(
    const std::vector<std::size_t>& parts, const std::vector<Weights>& grid) const
  {
    std::vector<PartError> errors(parts.size());
    vtkSMPTools::For(0, static_cast<vtkIdType>(parts.size()), [&](vtkIdType begin, vtkIdType end) {
      for (vtkIdType i = begin; i < end; ++i)
      {
        const auto n = static_cast<std::size_t>(i);
        errors[n] = this->MeasureError(this->Parts[parts[n]], grid);
      }
    });
    return errors;
  }

  /// Bisects edges of a part whose error is too large: those whose own error is too large or, if
  /// there are none, the one with the largest error. If the part is flipped, bisects its longest
  /// edge.
  void Divide(std::size_t index, const PartError& error, double maximum)
  {
    std::size_t worst = 0;
    for (const std::size_t edge : { 1, 2 })
    {
      worst = error.OfEdges[edge] > error.OfEdges[worst] ? edge : worst;
    }
    if (std::isinf(error.Largest) || error.OfEdges[worst] == 0.0)
    {
      worst = this->LongestEdge(index);
    }
    std::array<Ends, 3> edges;
    for (std::size_t edge = 0; edge < 3; ++edge)
    {
      edges[edge] = this->Edge(index, edge);
    }
    for (std::size_t edge = 0; edge < 3; ++edge)
    {
      if (edge == worst || error.OfEdges[edge] > maximum)
      {
        this->BisectAvoidingNeedles(edges[edge]);
      }
    }
  }

  /// Moves the finer pair out of this object.
  void Finish(RefinedPair& result)
  {
    std::vector<std::size_t> parts;
    result.LargestError = 0.0;
    for (std::size_t i = 0; i < this->Parts.size(); ++i)
    {
      if (!this->Parts[i].Divided)
      {
        parts.push_back(i);
        result.LargestError = std::max(result.LargestError, this->Parts[i].Error);
      }
    }
    std::stable_sort(parts.begin(), parts.end(), [this](std::size_t a, std::size_t b) {
      return this->Parts[a].Original < this->Parts[b].Original;
    });
    for (const std::size_t part : parts)
    {
      result.Triangles.push_back(this->Parts[part].Points);
      result.Originals.push_back(this->Parts[part].Original);
    }
    result.NewPoints = std::move(this->NewPoints);
    for (std::size_t side = 0; side < 2; ++side)
    {
      result.NewPositions[side].assign(
        this->Points[side].begin() + this->NumberOfOldPoints, this->Points[side].end());
    }
  }

private:
  const Vector3& GetPoint(std::size_t side, vtkIdType point) const
  {
    return this->Points[side][static_cast<std::size_t>(point)];
  }

  Vector3 MapInTriangle(TriangleIndex triangle, const Weights& weights) const
  {
    SurfacePoint point;
    point.Triangle = triangle;
    point.Corner = -1;
    point.Point.InPlane =
      this->Map.GetPair().GetGeometry(Domain::Source).GetShape(triangle).FromBarycentric(weights);
    Vector3 image;
    this->Map.MapPoint(Domain::Source, point, image.data());
    return image;
  }

  PartError MeasureError(const Part& part, const std::vector<Weights>& grid) const
  {
    PartError error;
    for (const Weights& weights : grid)
    {
      const Weights inOriginal =
        Combine(weights, [&part](std::size_t k) -> const Weights& { return part.Corners[k]; });
      const Vector3 image = this->MapInTriangle(part.Original, inOriginal);
      const Vector3 linear = Combine(weights,
        [&](std::size_t k) -> const Vector3& { return this->GetPoint(1, part.Points[k]); });
      const double distance = Length(Difference(image, linear));
      error.Largest = std::max(error.Largest, distance);
      for (std::size_t edge = 0; edge < 3; ++edge)
      {
        if (weights[edge] == 0.0)
        {
          error.OfEdges[edge] = std::max(error.OfEdges[edge], distance);
        }
      }
    }
    if (this->IsFlipped(part))
    {
      error.Largest = std::numeric_limits<double>::infinity();
    }
    return error;
  }

  /// Whether the part, in source or target, is degenerate or differs in orientation from its
  /// original triangle.
  bool IsFlipped(const Part& part) const
  {
    for (const Domain domain : { Domain::Source, Domain::Target })
    {
      const MeshGeometry& geometry = this->Map.GetPair().GetGeometry(domain);
      std::array<Vector3, 3> p;
      for (std::size_t k = 0; k < 3; ++k)
      {
        p[k] = geometry.ToNormalized(
          this->GetPoint(static_cast<std::size_t>(domain), part.Points[k]).data());
      }
      const Triangulation::Corners& corners =
        this->Map.GetPair().GetTriangulation().GetCorners(part.Original);
      if (geometry.IsPlanar())
      {
        if (Orientation({ p[0][0], p[0][1] }, { p[1][0], p[1][1] }, { p[2][0], p[2][1] }) !=
          geometry.GetOrientation(corners))
        {
          return true;
        }
        continue;
      }
      const Vector3 a = geometry.GetPoint(corners[0]);
      const Vector3 normal = Cross3(
        Difference(geometry.GetPoint(corners[1]), a), Difference(geometry.GetPoint(corners[2]), a));
      if (!(Dot3(Cross3(Difference(p[1], p[0]), Difference(p[2], p[0])), normal) > 0.0))
      {
        return true;
      }
    }
    return false;
  }

  /// The two points of an edge, which is opposite a point of the part.
  Ends Edge(std::size_t part, std::size_t edge) const
  {
    const auto& points = this->Parts[part].Points;
    const vtkIdType a = points[(edge + 1) % 3];
    const vtkIdType b = points[(edge + 2) % 3];
    return { std::min(a, b), std::max(a, b) };
  }

  double LengthOf(const Ends& ends) const
  {
    return Length(Difference(this->GetPoint(0, ends[1]), this->GetPoint(0, ends[0])));
  }

  /// Point ids decide between edges of equal length, consistently for both parts.
  std::size_t LongestEdge(std::size_t part) const
  {
    const auto key = [&](std::size_t edge) {
      const Ends ends = this->Edge(part, edge);
      return std::make_tuple(this->LengthOf(ends), ends[0], ends[1]);
    };
    std::size_t longest = 0;
    for (const std::size_t edge : { 1, 2 })
    {
      longest = key(edge) > key(longest) ? edge : longest;
    }
    return longest;
  }

  void Add(const Part& part)
  {
    const std::size_t index = this->Parts.size();
    this->Parts.push_back(part);
    ++this->NumberOfParts;
    for (std::size_t edge = 0; edge < 3; ++edge)
    {
      const auto found = this->PartsOfEdge.emplace(
        this->Edge(index, edge), std::array<std::size_t, 2>{ index, index });
      if (!found.second)
      {
        found.first->second[1] = index;
      }
    }
  }

  /// Removes a part that has been divided, and its edges that belong to no other part.
  void Remove(std::size_t index)
  {
    this->Parts[index].Divided = true;
    --this->NumberOfParts;
    for (std::size_t edge = 0; edge < 3; ++edge)
    {
      const auto found = this->PartsOfEdge.find(this->Edge(index, edge));
      auto& parts = found->second;
      const std::size_t other = parts[0] == index ? parts[1] : parts[0];
      if (other == index)
      {
        this->PartsOfEdge.erase(found);
      }
      else
      {
        parts = { other, other };
      }
    }
  }

  /// Bisects an edge unless that has been done. If a part at the edge is a needle, bisects the
  /// longest edge of the needle first.
  void BisectAvoidingNeedles(const Ends& ends)
  {
    for (auto found = this->PartsOfEdge.find(ends);
         found != this->PartsOfEdge.end() && !this->BelowRounding;
         found = this->PartsOfEdge.find(ends))
    {
      Ends first = ends;
      for (const std::size_t part : found->second)
      {
        const Ends longest = this->Edge(part, this->LongestEdge(part));
        if (this->LengthOf(longest) > this->LengthOf(first) && this->IsNeedle(part))
        {
          first = longest;
        }
      }
      if (first == ends)
      {
        this->Bisect(ends);
        return;
      }
      // Each recursion bisects a longer edge, so it ends.
      this->BisectAvoidingNeedles(first);
    }
  }

  bool IsNeedle(std::size_t index) const
  {
    const auto& points = this->Parts[index].Points;
    const double length = this->LengthOf(this->Edge(index, this->LongestEdge(index)));
    const Vector3 a =
      Scaled(Difference(this->GetPoint(0, points[1]), this->GetPoint(0, points[0])), 1.0 / length);
    const Vector3 b =
      Scaled(Difference(this->GetPoint(0, points[2]), this->GetPoint(0, points[0])), 1.0 / length);
    return Length(Cross3(a, b)) < Needle;
  }

  /// Bisects an edge and the parts on both sides of it.
  void Bisect(const Ends& ends)
  {
    const std::array<std::size_t, 2> parts = this->PartsOfEdge.find(ends)->second;
    const Part part = this->Parts[parts[0]];
    const std::size_t edge = this->FindEdge(parts[0], ends);
    const Weights weights = Middle(part, edge);
    const Triangulation::Corners& corners =
      this->Map.GetPair().GetTriangulation().GetCorners(part.Original);
    // An edge without a second part lies on the boundary, where all maps but Cubic are linear.
    const bool isOnBoundary = parts[0] == parts[1];
    std::array<Vector3, 2> positions;
    for (std::size_t side = 0; side < 2; ++side)
    {
      positions[side] = side == 1 && (!isOnBoundary || this->Map.GetCubic())
        ? this->MapInTriangle(part.Original, weights)
        : Combine(weights,
            [&](std::size_t k) -> const Vector3& { return this->GetPoint(side, corners[k]); });
      if (isOnBoundary)
      {
        const auto opposite = static_cast<std::size_t>(
          std::find(weights.begin(), weights.end(), 0.0) - weights.begin());
        positions[side] =
          MoveToEdge(positions[side], this->GetPoint(side, corners[(opposite + 1) % 3]),
            this->GetPoint(side, corners[(opposite + 2) % 3]));
      }
      for (const vtkIdType end : ends)
      {
        if (positions[side] == this->GetPoint(side, end))
        {
          this->BelowRounding = true;
          return;
        }
      }
    }
    const auto middle = static_cast<vtkIdType>(this->Points[0].size());
    this->NewPoints.push_back({ part.Original, weights });
    for (std::size_t side = 0; side < 2; ++side)
    {
      this->Points[side].push_back(positions[side]);
    }
    this->HalvePart(parts[0], ends, middle);
    if (parts[1] != parts[0])
    {
      this->HalvePart(parts[1], ends, middle);
    }
  }

  std::size_t FindEdge(std::size_t part, const Ends& ends) const
  {
    std::size_t edge = 0;
    while (this->Edge(part, edge) != ends)
    {
      ++edge;
    }
    return edge;
  }

  static Weights Middle(const Part& part, std::size_t edge)
  {
    const Weights& a = part.Corners[(edge + 1) % 3];
    const Weights& b = part.Corners[(edge + 2) % 3];
    return { 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2]) };
  }

  void HalvePart(std::size_t index, const Ends& ends, vtkIdType middle)
  {
    const Part part = this->Parts[index];
    const std::size_t edge = this->FindEdge(index, ends);
    const Weights weights = Middle(part, edge);
    this->Remove(index);
    for (const std::size_t end : { (edge + 1) % 3, (edge + 2) % 3 })
    {
      Part half = part;
      half.Passed = 0;
      half.Points[end] = middle;
      half.Corners[end] = weights;
      this->Add(half);
    }
  }

  const Homeomorphism& Map;
  vtkIdType NumberOfOldPoints;
  std::array<std::vector<Vector3>, 2> Points;
  std::vector<RefinedPair::Point> NewPoints;
  std::vector<Part> Parts;
  vtkIdType NumberOfParts = 0;
  /// The one or two undivided parts at an edge; the same part twice on the boundary.
  std::unordered_map<Ends, std::array<std::size_t, 2>, EdgeHash> PartsOfEdge;
  bool BelowRounding = false;
};

} // namespace

RefinedPair Refine(const Homeomorphism& map, vtkPolyData* source, vtkPolyData* target,
  double maximumError, vtkIdType maximumTriangles, const std::function<bool()>& isAborted)
{
  Refiner refiner(map, source, target);
  RefinedPair result;
  // Parts are measured on increasingly fine grids. The first two leave a margin for larger errors
  // between their points.
  const std::array<std::vector<Weights>, 3> grids{ MakeGrid(6), MakeGrid(20), MakeGrid(33) };
  const std::array<double, 3> limits{ 0.8 * maximumError, 0.8 * maximumError, maximumError };
  while (true)
  {
    std::size_t grid = 0;
    std::vector<std::size_t> parts;
    for (; grid < grids.size() && parts.empty(); ++grid)
    {
      parts = refiner.GetParts(grid);
    }
    if (parts.empty())
    {
      break;
    }
    --grid;
    if (isAborted())
    {
      result.Result = RefinedPair::Outcome::Aborted;
      return result;
    }
    const std::vector<PartError> errors = refiner.MeasureErrors(parts, grids[grid]);
    result.LargestError = 0.0;
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
      result.LargestError = std::max(result.LargestError, errors[i].Largest);
      if (errors[i].Largest <= limits[grid])
      {
        refiner.Pass(parts[i], errors[i].Largest);
      }
    }
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
      if (!(errors[i].Largest <= limits[grid]) && !refiner.IsDivided(parts[i]))
      {
        refiner.Divide(parts[i], errors[i], limits[grid]);
      }
      if (refiner.IsBelowRounding() || refiner.GetNumberOfParts() > maximumTriangles)
      {
        result.Result = refiner.IsBelowRounding() ? RefinedPair::Outcome::BelowRounding
                                                  : RefinedPair::Outcome::TooManyTriangles;
        return result;
      }
    }
  }
  refiner.Finish(result);
  result.Samples =
    static_cast<vtkIdType>(result.Triangles.size()) * static_cast<vtkIdType>(grids.back().size());
  return result;
}

} // namespace homeomorphism
