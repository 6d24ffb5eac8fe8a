// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "FigureBoundary.h"

#include "Kernel/ExactSign.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>
#include <tuple>
#include <utility>

namespace homeomorphism
{
namespace
{

using Kind = FigureProblem::Kind;

struct Affine
{
  Vector2 SourceCenter;
  Vector2 TargetCenter;
  // Images of the unit vectors.
  Vector2 X;
  Vector2 Y;

  Vector2 operator()(const Vector2& p) const
  {
    const Vector2 q = p - this->SourceCenter;
    return this->TargetCenter + q.x * this->X + q.y * this->Y;
  }
};

Vector2 Center(const std::vector<Vector2>& points)
{
  Vector2 center;
  for (const Vector2& p : points)
  {
    center = center + (1.0 / static_cast<double>(points.size())) * p;
  }
  return center;
}

/// The affine map that fits best in the sense of least squares.
Affine FitAffine(const std::array<std::vector<Vector2>, 2>& points)
{
  Affine fit{ Center(points[0]), Center(points[1]), {}, {} };
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  Vector2 x;
  Vector2 y;
  for (std::size_t i = 0; i < points[0].size(); ++i)
  {
    const Vector2 p = points[0][i] - fit.SourceCenter;
    const Vector2 q = points[1][i] - fit.TargetCenter;
    xx += p.x * p.x;
    xy += p.x * p.y;
    yy += p.y * p.y;
    x = x + p.x * q;
    y = y + p.y * q;
  }
  const double determinant = DifferenceOfProducts(xx, yy, xy, xy);
  fit.X = (1.0 / determinant) * (yy * x - xy * y);
  fit.Y = (1.0 / determinant) * (xx * y - xy * x);
  return fit;
}

std::array<Vector2, 2> Bounds(const std::vector<Vector2>& points)
{
  std::array<Vector2, 2> bounds{ { points[0], points[0] } };
  for (const Vector2& p : points)
  {
    bounds[0] = { std::min(bounds[0].x, p.x), std::min(bounds[0].y, p.y) };
    bounds[1] = { std::max(bounds[1].x, p.x), std::max(bounds[1].y, p.y) };
  }
  return bounds;
}

std::array<Vector2, 2> Enlarged(const std::array<Vector2, 2>& bounds, double margin)
{
  return { { { bounds[0].x - margin, bounds[0].y - margin },
    { bounds[1].x + margin, bounds[1].y + margin } } };
}

/// The spacing of the same number of points distributed evenly over the bounds.
double Spacing(const std::vector<Vector2>& points)
{
  const std::array<Vector2, 2> bounds = Bounds(points);
  const Vector2 size = bounds[1] - bounds[0];
  const double n = static_cast<double>(points.size());
  return std::max(std::sqrt(size.x / n * size.y), std::max(size.x, size.y) / n);
}

std::vector<Vector2> Corners(const std::array<Vector2, 2>& r)
{
  return { r[0], { r[1].x, r[0].y }, r[1], { r[0].x, r[1].y } };
}

bool IsInside(const Vector2& p, const std::vector<Vector2>& convex, int sense)
{
  for (std::size_t i = 0; i < convex.size(); ++i)
  {
    if (sense * Orientation(convex[i], convex[(i + 1) % convex.size()], p) <= 0)
    {
      return false;
    }
  }
  return true;
}

/// All points on the boundary of the convex hull, counterclockwise from the least x.
std::vector<int> Hull(const std::vector<Vector2>& points)
{
  std::vector<int> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    return std::make_pair(points[a].x, points[a].y) < std::make_pair(points[b].x, points[b].y);
  });
  std::vector<int> hull;
  for (int pass = 0; pass < 2; ++pass)
  {
    const std::size_t first = hull.size();
    for (const int i : order)
    {
      while (hull.size() >= first + 2 &&
        Orientation(points[hull[hull.size() - 2]], points[hull.back()], points[i]) < 0)
      {
        hull.pop_back();
      }
      hull.push_back(i);
    }
    hull.pop_back();
    std::reverse(order.begin(), order.end());
  }
  return hull;
}

/// The orientation of a simple polygon: 1 if it is counterclockwise, -1 if it is clockwise. Can be
/// 0 only if the polygon is not simple.
int Sense(const std::vector<Vector2>& points, const std::vector<int>& loop)
{
  std::size_t least = 0;
  for (std::size_t i = 1; i < loop.size(); ++i)
  {
    const Vector2& p = points[loop[i]];
    const Vector2& q = points[loop[least]];
    if (std::make_pair(p.x, p.y) < std::make_pair(q.x, q.y))
    {
      least = i;
    }
  }
  const std::size_t n = loop.size();
  return Orientation(
    points[loop[(least + n - 1) % n]], points[loop[least]], points[loop[(least + 1) % n]]);
}

class Boundary
{
public:
  Boundary(const FigurePair& figure, const BoundaryOptions& options)
    : Figure(figure)
    , Options(options)
  {
  }

  BoundedFigure Find()
  {
    if (this->CheckInput())
    {
      this->ChooseDomain();
    }
    return std::move(this->Result);
  }

private:
  void Refuse(Kind kind, int domain, std::vector<int> points, int line = -1, int loop = -1)
  {
    this->Result.Problems.push_back(MakeProblem(kind, domain, std::move(points), line, loop));
  }

  bool CheckInput()
  {
    const auto& points = this->Figure.Points;
    if (points[0].size() != points[1].size())
    {
      this->Refuse(Kind::PointCountsDiffer, -1, {});
      return false;
    }
    const int n = static_cast<int>(points[0].size());
    if (n < 3)
    {
      this->Refuse(Kind::Empty, -1, {});
      return false;
    }
    for (int kind = 0; kind < 2; ++kind)
    {
      const auto& cells = kind == 0 ? this->Figure.Loops : this->Figure.Lines;
      for (std::size_t i = 0; i < cells.size(); ++i)
      {
        bool good = cells[i].size() >= (kind == 0 ? 3u : 2u);
        for (std::size_t k = 0; k < cells[i].size() && good; ++k)
        {
          const bool last = k + 1 == cells[i].size();
          good = cells[i][k] >= 0 && cells[i][k] < n &&
            ((last && kind == 1) || cells[i][k] != cells[i][last ? 0 : k + 1]);
        }
        if (!good)
        {
          this->Refuse(Kind::BadCell, -1, cells[i], kind == 1 ? static_cast<int>(i) : -1,
            kind == 0 ? static_cast<int>(i) : -1);
        }
      }
    }
    for (int d = 0; d < 2; ++d)
    {
      std::vector<int> bad;
      for (int i = 0; i < n; ++i)
      {
        if (!(std::abs(points[d][i].x) < 1e150 && std::abs(points[d][i].y) < 1e150))
        {
          bad.push_back(i);
        }
      }
      if (!bad.empty())
      {
        this->Refuse(Kind::NotFinite, d, bad);
        continue;
      }
      std::vector<int> order(n);
      std::iota(order.begin(), order.end(), 0);
      const auto key = [&](int i) { return std::make_tuple(points[d][i].x, points[d][i].y, i); };
      std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
      for (int i = 0; i + 1 < n; ++i)
      {
        const Vector2& p = points[d][order[i]];
        const Vector2& q = points[d][order[i + 1]];
        if (p.x == q.x && p.y == q.y)
        {
          if (bad.empty() || bad.back() != order[i])
          {
            bad.push_back(order[i]);
          }
          bad.push_back(order[i + 1]);
        }
      }
      if (!bad.empty())
      {
        this->Refuse(Kind::Coincident, d, bad);
      }
    }
    return this->Result.Problems.empty();
  }

  /// Determines the loops that bound the domain, and whether the drawings are mirror images.
  void ChooseDomain()
  {
    this->Result.Points = this->Figure.Points;
    this->Result.Loops = this->Figure.Loops;
    FigureDomain domain = this->Options.Domain;
    if (domain == FigureDomain::Automatic)
    {
      domain = this->Result.Loops.empty() ? FigureDomain::Frame : FigureDomain::Outline;
    }
    const auto& frames = this->Options.Frames;
    const bool framesGiven = !frames[0].empty() || !frames[1].empty();
    bool mirrored = false;
    if (!this->Result.Loops.empty())
    {
      mirrored = Sense(this->Result.Points[0], this->Result.Loops[0]) *
          Sense(this->Result.Points[1], this->Result.Loops[0]) <
        0;
      for (std::size_t i = 1; i < this->Result.Loops.size(); ++i)
      {
        const int senses = Sense(this->Result.Points[0], this->Result.Loops[i]) *
          Sense(this->Result.Points[1], this->Result.Loops[i]);
        if (senses != 0 && (senses < 0) != mirrored)
        {
          this->Refuse(Kind::LoopSense, -1, this->Result.Loops[i], -1, static_cast<int>(i));
        }
      }
    }
    else
    {
      for (int d = 0; d < 2 && (domain != FigureDomain::Frame || !framesGiven); ++d)
      {
        const auto& p = this->Result.Points[d];
        // All points are collinear if they lie on the line through the first point and the farthest
        // one from it.
        std::size_t far = 0;
        for (std::size_t i = 1; i < p.size(); ++i)
        {
          far = Dot(p[i] - p[0], p[i] - p[0]) > Dot(p[far] - p[0], p[far] - p[0]) ? i : far;
        }
        if (std::all_of(p.begin(), p.end(),
              [&](const Vector2& q) { return Orientation(p[0], p[far], q) == 0; }))
        {
          this->Refuse(Kind::Collinear, d, {});
        }
      }
    }
    if (!this->Result.Problems.empty())
    {
      return;
    }
    if (domain == FigureDomain::Frame)
    {
      if (framesGiven)
      {
        std::vector<int> corners(frames[0].size());
        std::iota(corners.begin(), corners.end(), 0);
        std::array<int, 2> senses{ { 0, 0 } };
        for (int d = 0; d < 2; ++d)
        {
          const std::size_t n = frames[d].size();
          bool good = n >= 3 && n == frames[0].size();
          for (const Vector2& p : frames[d])
          {
            good = good && std::abs(p.x) < 1e150 && std::abs(p.y) < 1e150;
          }
          for (std::size_t i = 0; i < n && good; ++i)
          {
            const int sign =
              Orientation(frames[d][i], frames[d][(i + 1) % n], frames[d][(i + 2) % n]);
            good = sign != 0 && (i == 0 || sign == senses[d]);
            senses[d] = sign;
          }
          if (!good)
          {
            this->Refuse(Kind::BadFrame, d, {});
            return;
          }
        }
        if (this->Result.Loops.empty())
        {
          mirrored = senses[0] != senses[1];
        }
        this->AddFrame(frames, mirrored);
        return;
      }
      const Affine fit = FitAffine(this->Result.Points);
      if (this->Result.Loops.empty())
      {
        mirrored = Cross(fit.X, fit.Y) < 0.0;
      }
      this->Result.HasAutomaticFrame = true;
      if (this->AddFrame(this->AutomaticFrames(fit), mirrored) && this->Options.DividesFrame)
      {
        this->DivideFrame();
      }
      return;
    }
    if (domain == FigureDomain::ConvexHull)
    {
      this->AddHull();
      return;
    }
    if (this->Result.Loops.empty())
    {
      this->Refuse(Kind::BadCell, -1, {});
      return;
    }
    this->Result.Mirrored = mirrored;
  }

  std::array<std::vector<Vector2>, 2> AutomaticFrames(const Affine& fit) const
  {
    const std::array<Vector2, 2> bounds = Bounds(this->Result.Points[0]);
    const int sense = Cross(fit.X, fit.Y) < 0.0 ? -1 : 1;
    const double least = this->Options.FrameMargin * Spacing(this->Result.Points[0]);
    const double most =
      least + 0.5 * std::max(bounds[1].x - bounds[0].x, bounds[1].y - bounds[0].y);
    const auto images = [&](const std::vector<Vector2>& corners) {
      std::vector<Vector2> mapped;
      mapped.reserve(corners.size());
      for (const Vector2& corner : corners)
      {
        mapped.push_back(fit(corner));
      }
      return mapped;
    };
    double margin = least;
    while (margin < most)
    {
      // Points nearer to the edges of the frame than half the least margin would make thin
      // triangles.
      const std::vector<Vector2> inner = images(Corners(Enlarged(bounds, margin - 0.5 * least)));
      if (std::all_of(this->Result.Points[1].begin(), this->Result.Points[1].end(),
            [&](const Vector2& p) { return IsInside(p, inner, sense); }))
      {
        const std::vector<Vector2> corners = Corners(Enlarged(bounds, margin));
        return { corners, images(corners) };
      }
      margin *= 1.5;
    }
    return MatchRectangles(this->Figure, Enlarged(bounds, least),
      Enlarged(Bounds(this->Result.Points[1]),
        this->Options.FrameMargin * Spacing(this->Result.Points[1])));
  }

  /// Puts points on the edges of an automatic frame, about two spacings of the points apart: long
  /// edges would make thin triangles with the points along them.
  void DivideFrame()
  {
    const std::vector<Vector2>& given = this->Figure.Points[0];
    const std::array<Vector2, 2> bounds = Bounds(given);
    const Vector2 size = bounds[1] - bounds[0];
    const double step = 2.0 * Spacing(given);
    std::vector<int> loop;
    for (std::size_t k = 0; k < 4; ++k)
    {
      const std::array<int, 2> ends{ { this->Result.Loops[0][k],
        this->Result.Loops[0][(k + 1) % 4] } };
      const int pieces = 1 + static_cast<int>((k % 2 == 0 ? size.x : size.y) / step);
      loop.push_back(ends[0]);
      for (int i = 1; i < pieces; ++i)
      {
        loop.push_back(static_cast<int>(this->Result.Points[0].size()));
        ++this->Result.NumberOfFramePoints;
        for (auto& points : this->Result.Points)
        {
          const Vector2 start = points[ends[0]];
          points.push_back(start + (static_cast<double>(i) / pieces) * (points[ends[1]] - start));
        }
      }
    }
    this->Result.FrameIsDivided = loop.size() > 4;
    this->Result.Loops[0] = loop;
  }

  bool AddFrame(const std::array<std::vector<Vector2>, 2>& frames, bool mirrored)
  {
    const int n = static_cast<int>(this->Result.Points[0].size());
    const int corners = static_cast<int>(frames[0].size());
    std::vector<int> loop;
    // Landmarks at a corner or on an edge of both frames belong to the loop.
    std::array<std::vector<int>, 2> outside;
    std::array<std::vector<int>, 2> edgeOf;
    std::vector<int> cornerIds(corners, -1);
    for (int d = 0; d < 2; ++d)
    {
      const auto& frame = frames[d];
      const int sense = Orientation(frame[0], frame[1], frame[2]);
      edgeOf[d].assign(n, -1);
      for (int i = 0; i < n; ++i)
      {
        const Vector2& p = this->Result.Points[d][i];
        for (int k = 0; k < corners; ++k)
        {
          const int sign = sense * Orientation(frame[k], frame[(k + 1) % corners], p);
          if (p.x == frame[k].x && p.y == frame[k].y)
          {
            edgeOf[d][i] = corners + k;
            break;
          }
          if (sign < 0)
          {
            outside[d].push_back(i);
            break;
          }
          if (sign == 0 && IsBetween(p, frame[k], frame[(k + 1) % corners]))
          {
            edgeOf[d][i] = k;
          }
        }
      }
      if (!outside[d].empty())
      {
        this->Refuse(Kind::OutsideDomain, d, outside[d]);
      }
    }
    if (!this->Result.Problems.empty())
    {
      return false;
    }
    for (int d = 0; d < 2; ++d)
    {
      std::vector<int> onOne;
      for (int i = 0; i < n; ++i)
      {
        if (edgeOf[d][i] >= 0 && edgeOf[1 - d][i] != edgeOf[d][i])
        {
          onOne.push_back(i);
        }
        else if (edgeOf[d][i] >= corners)
        {
          cornerIds[edgeOf[d][i] - corners] = i;
        }
      }
      if (!onOne.empty())
      {
        this->Refuse(Kind::PointOnSegment, d, onOne);
        return false;
      }
    }
    for (int k = 0; k < corners; ++k)
    {
      if (cornerIds[k] < 0)
      {
        cornerIds[k] = static_cast<int>(this->Result.Points[0].size());
        this->Result.Points[0].push_back(frames[0][k]);
        this->Result.Points[1].push_back(frames[1][k]);
        ++this->Result.NumberOfFramePoints;
      }
    }
    for (int k = 0; k < corners; ++k)
    {
      std::vector<std::pair<double, int>> between;
      for (int i = 0; i < n; ++i)
      {
        if (edgeOf[0][i] == k)
        {
          const Vector2 p = this->Result.Points[0][i] - frames[0][k];
          between.emplace_back(Dot(p, p), i);
        }
      }
      std::sort(between.begin(), between.end());
      loop.push_back(cornerIds[k]);
      for (const auto& entry : between)
      {
        loop.push_back(entry.second);
      }
    }
    // Loops given beside a frame are constraints only.
    for (const auto& given : this->Figure.Loops)
    {
      this->Result.ClosedLines.push_back(given);
    }
    this->Result.Loops.assign(1, loop);
    this->Result.Mirrored = mirrored;
    return true;
  }

  void AddHull()
  {
    std::array<std::vector<int>, 2> hulls{ { Hull(this->Result.Points[0]),
      Hull(this->Result.Points[1]) } };
    for (auto& hull : hulls)
    {
      std::rotate(hull.begin(), std::min_element(hull.begin(), hull.end()), hull.end());
    }
    bool mirrored = false;
    if (hulls[0] != hulls[1])
    {
      std::reverse(hulls[1].begin() + 1, hulls[1].end());
      mirrored = true;
    }
    if (hulls[0] != hulls[1])
    {
      std::array<std::vector<int>, 2> sorted = hulls;
      std::sort(sorted[0].begin(), sorted[0].end());
      std::sort(sorted[1].begin(), sorted[1].end());
      std::vector<int> difference;
      std::set_symmetric_difference(sorted[0].begin(), sorted[0].end(), sorted[1].begin(),
        sorted[1].end(), std::back_inserter(difference));
      this->Refuse(Kind::HullsDiffer, -1, difference);
      return;
    }
    for (const auto& given : this->Figure.Loops)
    {
      this->Result.ClosedLines.push_back(given);
    }
    this->Result.Loops.assign(1, hulls[0]);
    this->Result.Mirrored = mirrored;
  }

  const FigurePair& Figure;
  const BoundaryOptions& Options;
  BoundedFigure Result;
};

} // namespace

BoundedFigure FindBoundary(const FigurePair& figure, const BoundaryOptions& options)
{
  return Boundary(figure, options).Find();
}

bool IsBetween(const Vector2& p, const Vector2& a, const Vector2& b)
{
  return std::make_pair(std::min(a.x, b.x), std::min(a.y, b.y)) <= std::make_pair(p.x, p.y) &&
    (p.x != a.x || p.y != a.y) && (p.x != b.x || p.y != b.y) && p.x <= std::max(a.x, b.x) &&
    p.x >= std::min(a.x, b.x) && p.y >= std::min(a.y, b.y) && p.y <= std::max(a.y, b.y);
}

std::array<std::vector<Vector2>, 2> MatchRectangles(const FigurePair& figure,
  const std::array<Vector2, 2>& source, const std::array<Vector2, 2>& target)
{
  std::array<std::vector<Vector2>, 2> frames{ { Corners(source), Corners(target) } };
  const Affine fit = FitAffine(figure.Points);
  if (Cross(fit.X, fit.Y) < 0.0)
  {
    std::reverse(frames[1].begin(), frames[1].end());
  }
  // Of the four rotations, choose the one whose corners lie best in the directions of the affine
  // images.
  const Vector2 center = 0.5 * (target[0] + target[1]);
  const Vector2 sourceCenter = 0.5 * (source[0] + source[1]);
  double best = -std::numeric_limits<double>::infinity();
  std::vector<Vector2> bestFrame;
  for (int turn = 0; turn < 4; ++turn)
  {
    double sum = 0.0;
    for (int k = 0; k < 4; ++k)
    {
      const Vector2 q = frames[0][k] - sourceCenter;
      const Vector2 image = q.x * fit.X + q.y * fit.Y;
      const Vector2 corner = frames[1][k] - center;
      const double lengths = std::sqrt(Dot(image, image) * Dot(corner, corner));
      sum += lengths > 0.0 ? Dot(image, corner) / lengths : 0.0;
    }
    if (sum > best)
    {
      best = sum;
      bestFrame = frames[1];
    }
    std::rotate(frames[1].begin(), frames[1].begin() + 1, frames[1].end());
  }
  frames[1] = bestFrame;
  return frames;
}

} // namespace homeomorphism
