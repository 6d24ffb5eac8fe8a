// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "GridFilling.h"

#include "Kernel/ExactSign.h"
#include "PairQuality.h"

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <utility>

namespace homeomorphism
{
namespace
{

/// The least distance of a point from the edges, in coordinates of the parallelogram.
constexpr double LeastMargin = 1e-6;

class Grid
{
public:
  Grid(const std::array<int, 4>& corners, const std::vector<int>& landmarks,
    std::array<std::vector<Vector2>, 2>& points)
    : Corners(corners)
    , Landmarks(landmarks)
    , Points(points)
    , Side(static_cast<int>(landmarks.size()) + 2)
  {
  }

  bool Fill(std::vector<std::array<int, 3>>& triangles)
  {
    this->FindPositions();
    if (!(this->Margin > LeastMargin))
    {
      return false;
    }
    this->SortLines();
    this->NumberNodes();
    this->PlaceNodes();
    if (!this->Triangulate(triangles))
    {
      triangles.clear();
      return false;
    }
    return true;
  }

private:
  /// Computes coordinates from 0 to 1 in the parallelogram, and their least distance from 0 and 1.
  void FindPositions()
  {
    for (int d = 0; d < 2; ++d)
    {
      const Axes axes = this->GetAxes(d);
      for (const int v : this->Landmarks)
      {
        const Vector2 p = this->Points[d][v] - axes.Origin;
        const double area = Cross(axes.X, axes.Y);
        const Vector2 u{ Cross(p, axes.Y) / area, Cross(axes.X, p) / area };
        this->Positions[d].push_back(u);
        this->Margin = std::min({ this->Margin, u.x, u.y, 1.0 - u.x, 1.0 - u.y });
      }
    }
  }

  /// Sorts the lines through the landmarks. They are slightly inclined, so that no two landmarks
  /// are on one line. The axes of the second domain are exchanged, so that x is constant on the
  /// lines of both domains.
  void SortLines()
  {
    this->Slope = 0.31 * this->Margin;
    for (int d = 0; d < 2; ++d)
    {
      auto& positions = this->Positions[d];
      for (Vector2& u : positions)
      {
        u = d == 0 ? u : Vector2{ u.y, u.x };
        u.x += this->Slope * u.y;
      }
      auto& order = this->Order[d];
      order.resize(positions.size());
      std::iota(order.begin(), order.end(), 0);
      std::sort(
        order.begin(), order.end(), [&](int a, int b) { return positions[a].x < positions[b].x; });
      this->Rank[d].resize(positions.size());
      for (std::size_t i = 0; i < positions.size(); ++i)
      {
        this->Rank[d][order[i]] = static_cast<int>(i) + 1;
      }
    }
  }

  /// A landmark is the node where its two lines meet. The other nodes are new points.
  void NumberNodes()
  {
    const auto side = static_cast<std::size_t>(this->Side);
    this->Nodes.assign(side * side, -1);
    for (std::size_t i = 0; i < this->Landmarks.size(); ++i)
    {
      this->Nodes[this->Rank[0][i] * side + this->Rank[1][i]] = this->Landmarks[i];
    }
    this->FirstAdded = static_cast<int>(this->Points[0].size());
    int count = this->FirstAdded;
    for (int& v : this->Nodes)
    {
      v = v < 0 ? count++ : v;
    }
    for (auto& points : this->Points)
    {
      points.resize(static_cast<std::size_t>(count));
    }
  }

  void PlaceNodes()
  {
    const double low = 0.5 * this->Margin;
    for (int d = 0; d < 2; ++d)
    {
      const Axes axes = this->GetAxes(d);
      for (int line = 0; line < this->Side; ++line)
      {
        const bool inside = line > 0 && line + 1 < this->Side;
        const int landmark = inside ? this->Order[d][line - 1] : -1;
        const double at =
          inside ? this->Positions[d][landmark].x : (line == 0 ? low : 1.0 - low + this->Slope);
        const int middle = inside ? this->Rank[1 - d][landmark] : this->Side - 1;
        const double height = inside ? this->Positions[d][landmark].y : 1.0 - low;
        for (int k = 0; k < this->Side; ++k)
        {
          const double along = k <= middle
            ? low + (height - low) * k / middle
            : height + (1.0 - low - height) * (k - middle) / (this->Side - 1 - middle);
          const int v = d == 0 ? this->At(line, k) : this->At(k, line);
          if (v >= this->FirstAdded)
          {
            const double across = at - this->Slope * along;
            const Vector2 u = d == 0 ? Vector2{ across, along } : Vector2{ along, across };
            this->Points[d][v] = axes.Origin + u.x * axes.X + u.y * axes.Y;
          }
        }
      }
    }
  }

  /// Divides each cell by the better diagonal, and the rim by fans around the corners of the frame.
  bool Triangulate(std::vector<std::array<int, 3>>& triangles) const
  {
    const auto quality = [this](const std::array<int, 3>& t) {
      return QualityOf(PairQuality::MinimumAngle,
        { this->Points[0][t[0]], this->Points[0][t[1]], this->Points[0][t[2]] },
        { this->Points[1][t[0]], this->Points[1][t[1]], this->Points[1][t[2]] });
    };
    const auto add = [&](int a, int b, int c) {
      triangles.push_back({ a, b, c });
      return quality(triangles.back()) >= 0.0;
    };
    const auto& corners = this->Corners;
    const auto at = [this](int line, int level) { return this->At(line, level); };
    const int last = this->Side - 1;
    bool good = add(corners[0], corners[1], at(last, 0)) &&
      add(corners[1], corners[2], at(last, last)) && add(corners[2], corners[3], at(0, last)) &&
      add(corners[3], corners[0], at(0, 0));
    for (int a = 0; a < last && good; ++a)
    {
      good = add(corners[0], at(a + 1, 0), at(a, 0)) &&
        add(corners[1], at(last, a + 1), at(last, a)) &&
        add(corners[2], at(a, last), at(a + 1, last)) && add(corners[3], at(0, a), at(0, a + 1));
      for (int b = 0; b < last && good; ++b)
      {
        const std::array<int, 4> q{ { at(a, b), at(a + 1, b), at(a + 1, b + 1), at(a, b + 1) } };
        const bool rising = std::min(quality({ q[0], q[1], q[2] }), quality({ q[0], q[2], q[3] })) >
          std::min(quality({ q[0], q[1], q[3] }), quality({ q[1], q[2], q[3] }));
        good = rising ? add(q[0], q[1], q[2]) && add(q[0], q[2], q[3])
                      : add(q[0], q[1], q[3]) && add(q[1], q[2], q[3]);
      }
    }
    return good;
  }

  struct Axes
  {
    Vector2 Origin;
    Vector2 X;
    Vector2 Y;
  };

  Axes GetAxes(int domain) const
  {
    const auto& points = this->Points[domain];
    const Vector2 origin = points[this->Corners[0]];
    return { origin, points[this->Corners[1]] - origin, points[this->Corners[3]] - origin };
  }

  /// The node where a line of the first domain meets one of the second.
  int At(int line, int level) const
  {
    return this->Nodes[static_cast<std::size_t>(line) * this->Side + level];
  }

  const std::array<int, 4>& Corners;
  const std::vector<int>& Landmarks;
  std::array<std::vector<Vector2>, 2>& Points;
  /// The number of lines, and of nodes on each line: one line passes through each landmark, and one
  /// passes beside each of two opposite edges.
  int Side;
  int FirstAdded = 0;
  double Margin = 0.5;
  double Slope = 0.0;
  std::array<std::vector<Vector2>, 2> Positions;
  /// Landmarks in the order of the lines, and the number of each one's line.
  std::array<std::vector<int>, 2> Order;
  std::array<std::vector<int>, 2> Rank;
  std::vector<int> Nodes;
};

} // namespace

bool FillByGrid(std::array<int, 4> corners, const std::vector<int>& landmarks,
  std::array<std::vector<Vector2>, 2>& points, std::vector<std::array<int, 3>>& triangles)
{
  if (Orientation(points[0][corners[0]], points[0][corners[1]], points[0][corners[2]]) < 0)
  {
    std::swap(corners[1], corners[3]);
  }
  return Grid(corners, landmarks, points).Fill(triangles);
}

} // namespace homeomorphism
