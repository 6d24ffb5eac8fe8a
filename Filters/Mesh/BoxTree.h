// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file BoxTree.h
/// A bounding volume hierarchy of triangles.

#ifndef homeomorphism_BoxTree_h
#define homeomorphism_BoxTree_h

#include "Box.h"
#include "LargeArray.h"
#include "Triangulation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace homeomorphism
{

/// A binary tree of boxes over triangles sorted along a Morton curve. Construction takes linear
/// time. Immutable once built; any number of threads may search it.
template <int Dimension>
class BoxTree
{
public:
  using BoxType = Box<Dimension>;

  /// @a boxOf returns the box of a triangle whose coordinates are all finite.
  template <typename BoxOf>
  void Build(std::vector<TriangleIndex> triangles, BoxOf&& boxOf)
  {
    this->Triangles = std::move(triangles);
    this->SortAlongCurve(boxOf);
    this->Nodes.clear();
    this->Levels.clear();
    if (this->Triangles.empty())
    {
      return;
    }
    const std::size_t leaves = (this->Triangles.size() + LeafSize - 1) / LeafSize;
    this->Nodes.reserve(2 * leaves + MaximumLevels);
    this->Levels.push_back(0);
    for (std::size_t leaf = 0; leaf < leaves; ++leaf)
    {
      BoxType bounds;
      const std::size_t last = std::min(this->Triangles.size(), (leaf + 1) * LeafSize);
      for (std::size_t i = leaf * LeafSize; i < last; ++i)
      {
        bounds.Add(boxOf(this->Triangles[i]));
      }
      this->Nodes.emplace_back(bounds);
    }
    for (std::size_t count = leaves; count > 1; count = (count + 1) / 2)
    {
      const std::size_t below = this->Levels.back();
      this->Levels.push_back(this->Nodes.size());
      for (std::size_t i = 0; i < count; i += 2)
      {
        this->Nodes.push_back(this->Nodes[below + i]);
        if (i + 1 < count)
        {
          this->Nodes.back().Add(this->Nodes[below + i + 1]);
        }
      }
    }
  }

  /// Calls visit(triangle) for every triangle in the leaves whose boxes intersect @a box, until it
  /// returns false. The box is read again at each step, so @a visit may shrink it.
  template <typename Visit>
  void Search(const BoxType& box, Visit&& visit) const
  {
    if (this->Nodes.empty())
    {
      return;
    }
    struct NodeIndex
    {
      std::size_t Level;
      std::size_t Index;
    };
    std::array<NodeIndex, 2 * MaximumLevels> stack;
    std::size_t depth = 0;
    stack[depth++] = { this->Levels.size() - 1, 0 };
    while (depth > 0)
    {
      const NodeIndex node = stack[--depth];
      if (!this->Nodes[this->Levels[node.Level] + node.Index].Meets(box))
      {
        continue;
      }
      if (node.Level > 0)
      {
        const std::size_t child = 2 * node.Index;
        if (child + 1 < this->Levels[node.Level] - this->Levels[node.Level - 1])
        {
          stack[depth++] = { node.Level - 1, child + 1 };
        }
        stack[depth++] = { node.Level - 1, child };
        continue;
      }
      const std::size_t last = std::min(this->Triangles.size(), (node.Index + 1) * LeafSize);
      for (std::size_t i = node.Index * LeafSize; i < last; ++i)
      {
        if (!visit(this->Triangles[i]))
        {
          return;
        }
      }
    }
  }

private:
  static constexpr std::size_t LeafSize = 4;
  static constexpr std::size_t MaximumLevels = 32;

  /// A box in single precision, rounded outward.
  struct Node
  {
    std::array<float, Dimension> Least;
    std::array<float, Dimension> Greatest;

    explicit Node(const BoxType& box)
    {
      for (int axis = 0; axis < Dimension; ++axis)
      {
        constexpr float infinity = std::numeric_limits<float>::infinity();
        const auto least = static_cast<float>(box.Least[axis]);
        const auto greatest = static_cast<float>(box.Greatest[axis]);
        this->Least[axis] =
          static_cast<double>(least) > box.Least[axis] ? std::nextafter(least, -infinity) : least;
        this->Greatest[axis] = static_cast<double>(greatest) < box.Greatest[axis]
          ? std::nextafter(greatest, infinity)
          : greatest;
      }
    }

    void Add(const Node& other)
    {
      for (int axis = 0; axis < Dimension; ++axis)
      {
        this->Least[axis] = std::min(this->Least[axis], other.Least[axis]);
        this->Greatest[axis] = std::max(this->Greatest[axis], other.Greatest[axis]);
      }
    }

    bool Meets(const BoxType& box) const
    {
      for (int axis = 0; axis < Dimension; ++axis)
      {
        if (this->Least[axis] > box.Greatest[axis] || box.Least[axis] > this->Greatest[axis])
        {
          return false;
        }
      }
      return true;
    }
  };

  /// Moves the bits of a number @a Dimension positions apart.
  static std::uint64_t SpreadBits(std::uint64_t x)
  {
    if (Dimension == 2)
    {
      x = (x | (x << 16)) & 0x0000ffff0000ffff;
      x = (x | (x << 8)) & 0x00ff00ff00ff00ff;
      x = (x | (x << 4)) & 0x0f0f0f0f0f0f0f0f;
      x = (x | (x << 2)) & 0x3333333333333333;
      return (x | (x << 1)) & 0x5555555555555555;
    }
    x = (x | (x << 32)) & 0x001f00000000ffff;
    x = (x | (x << 16)) & 0x001f0000ff0000ff;
    x = (x | (x << 8)) & 0x100f00f00f00f00f;
    x = (x | (x << 4)) & 0x10c30c30c30c30c3;
    return (x | (x << 2)) & 0x1249249249249249;
  }

  template <typename BoxOf>
  void SortAlongCurve(BoxOf& boxOf)
  {
    struct Entry
    {
      std::uint64_t Code;
      TriangleIndex Triangle;
    };
    const auto centerOf = [](const BoxType& box, int axis) {
      return 0.5 * box.Least[axis] + 0.5 * box.Greatest[axis];
    };
    BoxType bounds;
    for (const TriangleIndex t : this->Triangles)
    {
      bounds.Add(boxOf(t));
    }
    constexpr int bits = Dimension == 2 ? 22 : 21;
    std::array<double, Dimension> scale;
    for (int axis = 0; axis < Dimension; ++axis)
    {
      const double length = bounds.Greatest[axis] - bounds.Least[axis];
      scale[axis] = length > 0.0 ? std::ldexp(1.0, bits) * (1.0 - 1e-9) / length : 0.0;
      scale[axis] = std::isfinite(scale[axis]) ? scale[axis] : 0.0;
    }
    LargeArray<Entry> entries(this->Triangles.size());
    for (std::size_t i = 0; i < entries.size(); ++i)
    {
      const BoxType box = boxOf(this->Triangles[i]);
      std::uint64_t code = 0;
      for (int axis = 0; axis < Dimension; ++axis)
      {
        const double scaled = (centerOf(box, axis) - bounds.Least[axis]) * scale[axis];
        code |= SpreadBits(static_cast<std::uint64_t>(scaled)) << axis;
      }
      entries[i] = { code, this->Triangles[i] };
    }
    // Radix sort, from the least significant digit.
    constexpr int digitBits = 11;
    constexpr std::size_t digits = std::size_t(1) << digitBits;
    LargeArray<Entry> sorted(entries.size());
    for (int shift = 0; shift < Dimension * bits; shift += digitBits)
    {
      std::array<std::size_t, digits + 1> start{};
      for (const Entry& entry : entries)
      {
        ++start[((entry.Code >> shift) & (digits - 1)) + 1];
      }
      for (std::size_t digit = 0; digit < digits; ++digit)
      {
        start[digit + 1] += start[digit];
      }
      for (const Entry& entry : entries)
      {
        sorted[start[(entry.Code >> shift) & (digits - 1)]++] = entry;
      }
      std::swap(entries, sorted);
    }
    for (std::size_t i = 0; i < entries.size(); ++i)
    {
      this->Triangles[i] = entries[i].Triangle;
    }
  }

  // All leaves, then the parents of pairs of them, and so on. Levels contains the start of each
  // level.
  std::vector<Node> Nodes;
  std::vector<std::size_t> Levels;
  std::vector<TriangleIndex> Triangles;
};

} // namespace homeomorphism

#endif
