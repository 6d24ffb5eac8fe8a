// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file BoxTree.h
/// A hierarchy of boxes around triangles, for finding the few that are near a point or a box.

#ifndef homeomorphism_BoxTree_h
#define homeomorphism_BoxTree_h

#include "Triangulation.h"

#include <algorithm>
#include <array>
#include <limits>
#include <vector>

namespace homeomorphism
{

/// An axis-parallel box in the plane or in 3-space. It starts empty.
template <int Dimension>
struct Box
{
  std::array<double, Dimension> Least;
  std::array<double, Dimension> Greatest;

  Box()
  {
    this->Least.fill(std::numeric_limits<double>::infinity());
    this->Greatest.fill(-std::numeric_limits<double>::infinity());
  }

  void Add(const std::array<double, Dimension>& point)
  {
    for (int axis = 0; axis < Dimension; ++axis)
    {
      this->Least[axis] = std::min(this->Least[axis], point[axis]);
      this->Greatest[axis] = std::max(this->Greatest[axis], point[axis]);
    }
  }

  void Add(const Box& other)
  {
    this->Add(other.Least);
    this->Add(other.Greatest);
  }

  bool Meets(const Box& other) const
  {
    for (int axis = 0; axis < Dimension; ++axis)
    {
      if (this->Least[axis] > other.Greatest[axis] || other.Least[axis] > this->Greatest[axis])
      {
        return false;
      }
    }
    return true;
  }

  /// The box of all points at most @a distance from @a point in each coordinate.
  static Box Around(const std::array<double, Dimension>& point, double distance)
  {
    Box box;
    for (int axis = 0; axis < Dimension; ++axis)
    {
      box.Least[axis] = point[axis] - distance;
      box.Greatest[axis] = point[axis] + distance;
    }
    return box;
  }
};

/// A binary tree of boxes, split at the median of the longest side. Immutable once built; any number
/// of threads may search it.
template <int Dimension>
class BoxTree
{
public:
  using BoxType = Box<Dimension>;

  /// @a boxOf gives the box of a triangle.
  template <typename BoxOf>
  void Build(std::vector<TriangleIndex> triangles, BoxOf&& boxOf)
  {
    this->Triangles = std::move(triangles);
    this->Nodes.clear();
    if (!this->Triangles.empty())
    {
      this->Nodes.reserve(this->Triangles.size());
      this->Split(0, static_cast<std::int32_t>(this->Triangles.size()), boxOf);
    }
  }

  /// Calls visit(triangle) for every triangle in the leaves whose box meets @a box, until it returns
  /// false. The box is read anew at each step, so that a visit may shrink it.
  template <typename Visit>
  void Search(const BoxType& box, Visit&& visit) const
  {
    if (this->Nodes.empty())
    {
      return;
    }
    // The tree is balanced: its depth is at most that of 2^31 triangles.
    std::array<std::int32_t, 64> stack;
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0)
    {
      const std::int32_t index = stack[--depth];
      const Node& node = this->Nodes[index];
      if (!node.Bounds.Meets(box))
      {
        continue;
      }
      if (node.Count == 0)
      {
        stack[depth++] = node.First;
        stack[depth++] = index + 1;
        continue;
      }
      for (std::int32_t i = node.First; i < node.First + node.Count; ++i)
      {
        if (!visit(this->Triangles[i]))
        {
          return;
        }
      }
    }
  }

private:
  static constexpr std::int32_t LeafSize = 4;

  struct Node
  {
    BoxType Bounds;
    /// Of a leaf, its first triangle; of an inner node, its second child (the first comes next).
    std::int32_t First;
    /// Number of a leaf's triangles; 0 for an inner node.
    std::int32_t Count;
  };

  template <typename BoxOf>
  void Split(std::int32_t begin, std::int32_t end, BoxOf& boxOf)
  {
    const auto index = static_cast<std::int32_t>(this->Nodes.size());
    BoxType bounds;
    for (std::int32_t i = begin; i < end; ++i)
    {
      bounds.Add(boxOf(this->Triangles[i]));
    }
    this->Nodes.push_back({ bounds, begin, end - begin });
    if (end - begin <= LeafSize)
    {
      return;
    }
    int axis = 0;
    for (int other = 1; other < Dimension; ++other)
    {
      if (bounds.Greatest[other] - bounds.Least[other] >
        bounds.Greatest[axis] - bounds.Least[axis])
      {
        axis = other;
      }
    }
    const std::int32_t middle = begin + (end - begin) / 2;
    std::nth_element(this->Triangles.begin() + begin, this->Triangles.begin() + middle,
      this->Triangles.begin() + end, [&boxOf, axis](TriangleIndex a, TriangleIndex b) {
        const BoxType boxA = boxOf(a);
        const BoxType boxB = boxOf(b);
        const double centerA = 0.5 * boxA.Least[axis] + 0.5 * boxA.Greatest[axis];
        const double centerB = 0.5 * boxB.Least[axis] + 0.5 * boxB.Greatest[axis];
        return centerA != centerB ? centerA < centerB : a < b;
      });
    this->Split(begin, middle, boxOf);
    const auto second = static_cast<std::int32_t>(this->Nodes.size());
    this->Split(middle, end, boxOf);
    this->Nodes[index].First = second;
    this->Nodes[index].Count = 0;
  }

  std::vector<Node> Nodes;
  std::vector<TriangleIndex> Triangles;
};

} // namespace homeomorphism

#endif
