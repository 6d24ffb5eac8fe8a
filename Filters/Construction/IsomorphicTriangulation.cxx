// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "IsomorphicTriangulation.h"

#include "CommonMap.h"
#include "FaceDissection.h"
#include "FaceFilling.h"
#include "JointOptimization.h"
#include "Kernel/ExactSign.h"
#include "PairMesh.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numeric>
#include <tuple>
#include <utility>

namespace homeomorphism
{
namespace
{

using Kind = FigureProblem::Kind;

/// Corners of a face up to which all common diagonals are weighed against each other at once, and
/// the share of points whose components the figure must have connected for that: otherwise the
/// edges that connect them leave too little choice.
constexpr std::size_t LargestDissection = 2500;
constexpr std::size_t ConnectedShare = 10;
/// Segments left out, and points, up to which others are left out instead if that is better.
constexpr std::size_t ExchangedSegments = 20;
constexpr std::size_t ExchangedPoints = 3000;
/// Corners of a face up to which all diagonals are tried, and are weighed against each other.
constexpr std::size_t AllPairs = 700;
constexpr std::size_t ExactFill = 400;
/// Corners up to which a face is filled by an overlay; larger ones are divided.
constexpr std::size_t LargestOverlay = 300;
/// Points up to which edges are tried in several orders if points have to be added.
constexpr std::size_t SeveralOrders = 20000;
/// How many orders are tried, and with how many added points it is worth trying more than four.
constexpr int Orders = 12;
constexpr int FewPoints = 4;
/// Added points beyond which another order would take long and change little.
constexpr int ManyPoints = 200;
/// Components that common edges leave, from which on points are taken to be unrelated: so many, or
/// so many that are also a fifth of all points.
constexpr int Unrelated = 70;
constexpr int UnrelatedFew = 20;
/// An angle that is not too thin for any quality, in degrees.
constexpr double Thin = 5.0;
/// One that calls for points before other qualities do.
constexpr double VeryThin = 1.0;
/// How many ids a problem lists.
constexpr std::size_t ListedIds = 10;

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

/// The typical distance between points: that of as many points spread over their bounds.
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

/// Whether p, on the line of a and b, lies strictly between them.
bool IsBetween(const Vector2& p, const Vector2& a, const Vector2& b)
{
  return std::make_pair(std::min(a.x, b.x), std::min(a.y, b.y)) <= std::make_pair(p.x, p.y) &&
    (p.x != a.x || p.y != a.y) && (p.x != b.x || p.y != b.y) && p.x <= std::max(a.x, b.x) &&
    p.x >= std::min(a.x, b.x) && p.y >= std::min(a.y, b.y) && p.y <= std::max(a.y, b.y);
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

/// 1 or -1 as a simple polygon runs counterclockwise or clockwise, 0 if it is not simple.
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

/// The construction from the checked figure to the mesh. Works on points in an order of its own,
/// which depends on positions alone, and on the domain whose coordinates come first in the order of
/// numbers: so neither the order of landmarks nor which domain is the source changes the result.
class Builder
{
public:
  /// @param frameMargin how far an automatic frame is from the points, in their spacings
  /// @param dividesFrame whether an automatic frame gets points on its edges
  Builder(const FigurePair& figure, const IsomorphicTriangulationOptions& options,
    double frameMargin, bool dividesFrame)
    : Figure(figure)
    , Options(options)
    , FrameMargin(frameMargin)
    , DividesFrame(dividesFrame)
  {
  }

  /// Makes the best pair that needs few added points. False if the figure was refused.
  bool Prepare()
  {
    if (!this->CheckInput() || !this->ChooseDomain())
    {
      return false;
    }
    this->ChooseOrder();
    this->ChooseSegments();
    // Which edges are tried first can decide whether points have to be added.
    for (int order = 0; order < Orders; ++order)
    {
      std::unique_ptr<PairMesh> mesh = this->Construct(order);
      // Of equally many points, those with the better triangles.
      if (mesh &&
        (!this->Best ||
          std::make_pair(mesh->CountAdded(), -mesh->WorstQuality()) <
            std::make_pair(this->Best->CountAdded(), -this->Best->WorstQuality())))
      {
        this->Best = std::move(mesh);
      }
      const int added = this->CountAdded();
      if (!this->CanImprove() || (order == 3 && added > FewPoints) ||
        (this->Best && added > ManyPoints) || this->Refused || this->NeedsPlainFrame)
      {
        break;
      }
    }
    if (this->Best)
    {
      this->Result.Problems.clear();
      if (this->Options.OptimizeAddedPoints && this->CanImprove())
      {
        JointOptimization(*this->Best, this->KeepGoing(0.6)).RefillRegions();
      }
    }
    return this->Best != nullptr;
  }

  /// Improves the pair as the options say, and hands it over.
  void Finish()
  {
    PairMesh& mesh = *this->Best;
    JointOptimization optimization(mesh, this->KeepGoing(0.7));
    optimization.Flip();
    const int limit = this->Options.MaximumNumberOfAddedPoints;
    const int added = mesh.CountAdded();
    if (limit >= 0 && added > limit)
    {
      this->Refuse(Kind::PointLimit, -1, this->PlaceOfAdded(mesh));
      this->Result.Problems.back().Count = added;
      return;
    }
    const int maximum = limit >= 0 ? limit : added + 100;
    if (this->Options.Quality == PairQuality::Concordance ||
      this->Options.Quality == PairQuality::NonObtuse)
    {
      // Half of the points first make the angles larger where obtuse ones are to be avoided, or
      // where the triangles are too thin to be a measure.
      const bool isNonObtuse = this->Options.Quality == PairQuality::NonObtuse;
      double thin = std::min(Thin, mesh.SmallestAngle());
      if (isNonObtuse || thin < VeryThin)
      {
        optimization.AddPoints(isNonObtuse ? 90.0 : VeryThin, added + (maximum - added) / 2);
      }
      if (thin < VeryThin)
      {
        thin = std::min(VeryThin, mesh.SmallestAngle());
      }
      mesh.SetQuality({ this->Options.Quality, thin });
      const std::size_t mark = mesh.Mark();
      optimization.Flip();
      if (mesh.SmallestAngle() < 0.5 * thin)
      {
        mesh.RollBack(mark);
      }
    }
    if (this->Options.OptimizeAddedPoints || this->Options.TargetQuality > 0.0)
    {
      optimization.Settle();
      optimization.AddPoints(this->Options.TargetQuality, maximum);
    }
    if (this->Options.MaximumTriangleSize > 0.0)
    {
      std::array<double, 2> areas{ { 0.0, 0.0 } };
      for (int t = 0; t < static_cast<int>(mesh.GetTriangles().size()); ++t)
      {
        for (int d = 0; d < 2 && mesh.GetTriangles()[t].Alive; ++d)
        {
          const TrianglePoints p = mesh.PointsOf(t, d);
          areas[d] += 0.5 * Cross(p[1] - p[0], p[2] - p[0]) * this->Options.MaximumTriangleSize;
        }
      }
      optimization.Refine(areas, limit >= 0 ? limit : std::numeric_limits<int>::max());
    }
    if (this->Stopped)
    {
      this->Refuse(Kind::Aborted, -1, {});
      return;
    }
    this->Output(mesh);
  }

  int CountAdded() const
  {
    return this->Best ? this->Best->CountAdded() : std::numeric_limits<int>::max();
  }

  /// Whether another order or frame could need fewer added points, and may be tried.
  bool CanImprove() const
  {
    const int enough =
      this->Options.TargetQuality > 0.0 ? 0 : std::max(0, this->Options.MaximumNumberOfAddedPoints);
    return this->CountAdded() > enough && this->Order.size() <= SeveralOrders && !this->Stopped;
  }

  bool HasAutomaticFrame() const { return this->AutomaticFrame; }
  /// Whether the points on an automatic frame's edges prevented a result, or perhaps a better one.
  bool MayNeedPlainFrame() const
  {
    return this->NeedsPlainFrame ||
      (this->FrameIsDivided && this->Best && this->CountAdded() > ManyPoints);
  }
  IsomorphicTriangulationResult& GetResult() { return this->Result; }

private:
  void Refuse(Kind kind, int domain, std::vector<int> points, int line = -1, int loop = -1)
  {
    FigureProblem problem;
    problem.What = kind;
    problem.Domain = domain;
    problem.Count = static_cast<int>(points.size());
    points.resize(std::min(points.size(), ListedIds));
    problem.Points = std::move(points);
    problem.Line = line;
    problem.Loop = loop;
    this->Result.Problems.push_back(std::move(problem));
  }

  bool Proceed(double progress)
  {
    if (!this->KeepGoing(progress)())
    {
      this->Refuse(Kind::Aborted, -1, {});
      return false;
    }
    return true;
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

  /// The loops that bound the domain, and whether the drawings are mirror images.
  bool ChooseDomain()
  {
    this->Points = this->Figure.Points;
    this->Loops = this->Figure.Loops;
    FigureDomain domain = this->Options.Domain;
    if (domain == FigureDomain::Automatic)
    {
      domain = this->Loops.empty() ? FigureDomain::Frame : FigureDomain::Outline;
    }
    const auto& frames = this->Options.Frames;
    const bool framesGiven = !frames[0].empty() || !frames[1].empty();
    bool mirrored = false;
    if (!this->Loops.empty())
    {
      mirrored =
        Sense(this->Points[0], this->Loops[0]) * Sense(this->Points[1], this->Loops[0]) < 0;
      for (std::size_t i = 1; i < this->Loops.size(); ++i)
      {
        const int senses =
          Sense(this->Points[0], this->Loops[i]) * Sense(this->Points[1], this->Loops[i]);
        if (senses != 0 && (senses < 0) != mirrored)
        {
          this->Refuse(Kind::LoopSense, -1, this->Loops[i], -1, static_cast<int>(i));
        }
      }
    }
    else
    {
      for (int d = 0; d < 2 && (domain != FigureDomain::Frame || !framesGiven); ++d)
      {
        const auto& p = this->Points[d];
        // The point farthest from the first, and the whole on the line of the two?
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
      return false;
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
            return false;
          }
        }
        if (this->Loops.empty())
        {
          mirrored = senses[0] != senses[1];
        }
        return this->AddFrame(frames, mirrored);
      }
      const Affine fit = FitAffine(this->Points);
      if (this->Loops.empty())
      {
        mirrored = Cross(fit.X, fit.Y) < 0.0;
      }
      this->AutomaticFrame = true;
      if (!this->AddFrame(this->AutomaticFrames(fit), mirrored))
      {
        return false;
      }
      if (this->DividesFrame)
      {
        this->DivideFrame();
      }
      return true;
    }
    if (domain == FigureDomain::ConvexHull)
    {
      return this->AddHull();
    }
    if (this->Loops.empty())
    {
      this->Refuse(Kind::BadCell, -1, {});
      return false;
    }
    this->Result.Mirrored = mirrored;
    return true;
  }

  std::array<std::vector<Vector2>, 2> AutomaticFrames(const Affine& fit) const
  {
    const std::array<Vector2, 2> bounds = Bounds(this->Points[0]);
    const int sense = Cross(fit.X, fit.Y) < 0.0 ? -1 : 1;
    const double least = this->FrameMargin * Spacing(this->Points[0]);
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
      // Points nearer to the image than half the margin would make thin triangles.
      const std::vector<Vector2> inner = images(Corners(Enlarged(bounds, margin - 0.5 * least)));
      if (std::all_of(this->Points[1].begin(), this->Points[1].end(),
            [&](const Vector2& p) { return IsInside(p, inner, sense); }))
      {
        const std::vector<Vector2> corners = Corners(Enlarged(bounds, margin));
        return { corners, images(corners) };
      }
      margin *= 1.5;
    }
    return MatchRectangles(this->Figure, Enlarged(bounds, least),
      Enlarged(Bounds(this->Points[1]), this->FrameMargin * Spacing(this->Points[1])));
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
      const std::array<int, 2> ends{ { this->Loops[0][k], this->Loops[0][(k + 1) % 4] } };
      const int pieces = 1 + static_cast<int>((k % 2 == 0 ? size.x : size.y) / step);
      loop.push_back(ends[0]);
      for (int i = 1; i < pieces; ++i)
      {
        loop.push_back(static_cast<int>(this->Points[0].size()));
        ++this->Result.NumberOfFramePoints;
        for (auto& points : this->Points)
        {
          const Vector2 start = points[ends[0]];
          points.push_back(start + (static_cast<double>(i) / pieces) * (points[ends[1]] - start));
        }
      }
    }
    this->FrameIsDivided = loop.size() > 4;
    this->Loops[0] = loop;
  }

  bool AddFrame(const std::array<std::vector<Vector2>, 2>& frames, bool mirrored)
  {
    const int n = static_cast<int>(this->Points[0].size());
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
        const Vector2& p = this->Points[d][i];
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
        cornerIds[k] = static_cast<int>(this->Points[0].size());
        this->Points[0].push_back(frames[0][k]);
        this->Points[1].push_back(frames[1][k]);
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
          const Vector2 p = this->Points[0][i] - frames[0][k];
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
      this->ClosedLines.push_back(given);
    }
    this->Loops.assign(1, loop);
    this->Result.Mirrored = mirrored;
    return true;
  }

  bool AddHull()
  {
    std::array<std::vector<int>, 2> hulls{ { Hull(this->Points[0]), Hull(this->Points[1]) } };
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
      return false;
    }
    for (const auto& given : this->Figure.Loops)
    {
      this->ClosedLines.push_back(given);
    }
    this->Loops.assign(1, hulls[0]);
    this->Result.Mirrored = mirrored;
    return true;
  }

  void ChooseOrder()
  {
    const auto sorted = [](const std::vector<Vector2>& points) {
      std::vector<std::pair<double, double>> keys;
      keys.reserve(points.size());
      for (const Vector2& p : points)
      {
        keys.emplace_back(p.x, p.y);
      }
      std::sort(keys.begin(), keys.end());
      return keys;
    };
    this->First = sorted(this->Points[1]) < sorted(this->Points[0]) ? 1 : 0;
    this->Order = HilbertOrder(this->Points[this->First]);
    this->Vertex.resize(this->Order.size());
    for (std::size_t i = 0; i < this->Order.size(); ++i)
    {
      this->Vertex[this->Order[i]] = static_cast<int>(i) + ConstrainedTriangulation::BoxCorners;
      for (int d = 0; d < 2; ++d)
      {
        Vector2 p = this->Points[d == 0 ? this->First : 1 - this->First][this->Order[i]];
        if (d == 1 && this->Result.Mirrored)
        {
          p.y = -p.y;
        }
        this->Ordered[d].push_back(p);
      }
    }
  }

  /// The figure's number of a vertex of the map, -1 for those that were added.
  int PointOf(int vertex) const
  {
    const std::size_t i = static_cast<std::size_t>(vertex - ConstrainedTriangulation::BoxCorners);
    return i < this->Order.size() ? this->Order[i] : -1;
  }

  std::vector<int> PointsOf(const std::vector<int>& vertices) const
  {
    std::vector<int> points;
    for (const int v : vertices)
    {
      if (this->PointOf(v) >= 0)
      {
        points.push_back(this->PointOf(v));
      }
    }
    std::sort(points.begin(), points.end());
    points.erase(std::unique(points.begin(), points.end()), points.end());
    return points;
  }

  /// Draws a segment of the figure, in pieces if it runs through points in both domains. Returns
  /// why it cannot be drawn.
  FigureProblems Draw(int from, int to, std::vector<std::array<int, 2>>& edges)
  {
    const CommonMap::Answer answer = this->Map->Add(from, to);
    FigureProblem problem;
    const int f = this->PointOf(from);
    const int t = this->PointOf(to);
    problem.Domain = answer.Domain < 0 ? -1 : (answer.Domain == 0 ? this->First : 1 - this->First);
    switch (answer.Why)
    {
      case CommonMap::Refusal::None:
      case CommonMap::Refusal::Exists:
        edges.push_back({ from, to });
        return {};
      case CommonMap::Refusal::MeetsVertex:
      {
        const int v = answer.Vertices[0];
        const auto& other = this->Map->GetPoints(1 - answer.Domain);
        if (Orientation(other[from], other[to], other[v]) == 0 &&
          IsBetween(other[v], other[from], other[to]))
        {
          FigureProblems problems = this->Draw(from, v, edges);
          return problems.empty() ? this->Draw(v, to, edges) : problems;
        }
        problem.What = Kind::PointOnSegment;
        problem.Points = { this->PointOf(v), std::min(f, t), std::max(f, t) };
        break;
      }
      case CommonMap::Refusal::Crosses:
      {
        const int a = this->PointOf(answer.Vertices[0]);
        const int b = this->PointOf(answer.Vertices[1]);
        problem.What = Kind::Crossing;
        problem.Points = { std::min(f, t), std::max(f, t), std::min(a, b), std::max(a, b) };
        break;
      }
      case CommonMap::Refusal::CyclicOrder:
        problem.What = Kind::CyclicOrder;
        problem.Points = this->PointsOf(answer.Vertices);
        break;
      case CommonMap::Refusal::Outside:
        problem.What = Kind::OutsideDomain;
        problem.Points = { std::min(f, t), std::max(f, t) };
        break;
      case CommonMap::Refusal::Separates:
        problem.What = Kind::OtherFace;
        problem.Points = this->PointsOf(answer.Vertices);
        problem.Count = static_cast<int>(problem.Points.size());
        for (const int p : problem.Points)
        {
          if (!this->LoopOf.empty() && this->LoopOf[p] >= 0)
          {
            problem.What = Kind::OutlineAgainstHole;
            problem.Loop = this->LoopOf[p];
          }
        }
        problem.Points.resize(std::min(problem.Points.size(), ListedIds));
        break;
    }
    return { problem };
  }

  /// Which of the segments that contradict each other are left out: as few as possible, and such
  /// that few components lie on different sides of others, which would take many points. Segments
  /// that had to be left out are drawn first, one after the other, as long as that is better.
  void ChooseSegments()
  {
    using Cost = std::pair<std::size_t, std::size_t>;
    std::vector<std::array<int, 2>> conflicting;
    const auto draw = [&]() -> Cost {
      this->StartMap();
      this->DrawFigure();
      conflicting = this->Conflicting;
      this->ConnectComponents(this->Map->Candidates());
      std::vector<std::array<int, 3>> closed;
      std::vector<CommonMap::Face> faces;
      this->Map->Faces(closed, faces);
      std::size_t apart = 0;
      for (const CommonMap::Face& face : faces)
      {
        apart += face.Walks.size() - 1;
      }
      return { conflicting.size(), apart };
    };
    if (!this->Options.LeaveOutConflictingSegments || this->Order.size() > ExchangedPoints)
    {
      return;
    }
    for (Cost best = draw(); best.first > 0 && best.first <= ExchangedSegments;)
    {
      const std::vector<std::array<int, 2>> first = this->FirstSegments;
      std::vector<std::array<int, 2>> better = first;
      for (const auto& segment : std::vector<std::array<int, 2>>(conflicting))
      {
        this->FirstSegments = first;
        this->FirstSegments.push_back(segment);
        const Cost cost = this->Proceed(0.05) ? draw() : best;
        if (cost < best)
        {
          best = cost;
          better = this->FirstSegments;
        }
      }
      this->FirstSegments = better;
      if (better == first)
      {
        break;
      }
      draw();
    }
    this->Result.Problems.clear();
  }

  void StartMap()
  {
    this->Map = std::make_unique<CommonMap>(this->Ordered);
    this->LoopEdges.clear();
    this->Segments.clear();
    this->Conflicting.clear();
    this->Result.LeftOut.clear();
  }

  /// A pair with the points that are necessary; null if it had to be refused.
  std::unique_ptr<PairMesh> Construct(int order)
  {
    this->StartMap();
    this->Refused = !this->DrawFigure() || !this->Proceed(0.1);
    if (this->Refused)
    {
      return nullptr;
    }
    const bool isConnected =
      ConnectedShare * static_cast<std::size_t>(this->Map->GetNumberOfComponents()) <
      this->Order.size();
    this->Map->SetOrder(order);
    this->FillFaces();
    const std::vector<std::array<int, 2>> candidates = this->Map->Candidates();
    this->ConnectComponents(candidates);
    if (order > 0 && isConnected && !this->DissectFaces())
    {
      return nullptr;
    }
    for (const auto& edge : candidates)
    {
      this->Map->Add(edge[0], edge[1]);
    }
    if (this->FrameIsDivided && this->AreUnrelated())
    {
      // A grid needs a frame of four corners.
      this->NeedsPlainFrame = true;
      return nullptr;
    }
    std::array<std::vector<Vector2>, 2> points;
    std::vector<std::array<int, 3>> triangles;
    if (!this->Proceed(0.3) ||
      (!(this->AreUnrelated() && this->FillByGrid(points, triangles)) &&
        (!this->BridgeComponents() || !this->Triangulate(points, triangles))) ||
      !this->Proceed(0.5))
    {
      return nullptr;
    }
    std::vector<std::array<int, 2>> fixed = this->LoopEdges;
    fixed.insert(fixed.end(), this->Segments.begin(), this->Segments.end());
    const int firstAdded =
      ConstrainedTriangulation::BoxCorners + static_cast<int>(this->Order.size());
    // Angles first if obtuse ones are to be avoided then.
    auto mesh = std::make_unique<PairMesh>(points, triangles, fixed, firstAdded,
      this->Options.Quality == PairQuality::Distortion ? PairQuality::Distortion
                                                       : PairQuality::MinimumAngle);
    JointOptimization(*mesh, this->KeepGoing(0.6)).RemovePoints(this->Options.OptimizeAddedPoints);
    return mesh;
  }

  /// Asks the caller, once and for all, whether to go on.
  std::function<bool()> KeepGoing(double progress)
  {
    return [this, progress]() {
      this->Stopped =
        this->Stopped || (this->Options.Progress && !this->Options.Progress(progress));
      return !this->Stopped;
    };
  }

  bool DrawFigure()
  {
    this->LoopOf.assign(this->Points[0].size(), -1);
    for (std::size_t i = 0; i < this->Loops.size(); ++i)
    {
      for (const int p : this->Loops[i])
      {
        this->LoopOf[p] = static_cast<int>(i);
      }
    }
    const auto note = [](
                        const FigureProblems& found, int line, int loop, FigureProblems& problems) {
      for (FigureProblem problem : found)
      {
        problem.Line = line;
        problem.Loop = problem.Loop < 0 ? loop : problem.Loop;
        problems.push_back(problem);
      }
    };
    for (std::size_t i = 0; i < this->Loops.size(); ++i)
    {
      const auto& loop = this->Loops[i];
      for (std::size_t k = 0; k < loop.size(); ++k)
      {
        note(this->Draw(
               this->Vertex[loop[k]], this->Vertex[loop[(k + 1) % loop.size()]], this->LoopEdges),
          -1, static_cast<int>(i), this->Result.Problems);
      }
    }
    if (!this->Result.Problems.empty())
    {
      return false;
    }
    this->Map->MarkOutside(this->LoopEdges);
    std::vector<int> outside;
    for (int p = 0; p < static_cast<int>(this->Figure.Points[0].size()); ++p)
    {
      if (this->Map->IsOutside(this->Vertex[p], 0))
      {
        outside.push_back(p);
      }
    }
    if (!outside.empty())
    {
      this->Refuse(Kind::OutsideDomain, -1, outside);
      return false;
    }
    // Short segments first: where some have to be left out, these are the more certain ones.
    struct Segment
    {
      std::ptrdiff_t Preference;
      double Length;
      std::array<int, 2> Ends;
      int Line;
    };
    std::vector<Segment> segments;
    const auto collect = [&](const std::vector<int>& points, int line, bool closed) {
      for (std::size_t k = 0; k + (closed ? 0 : 1) < points.size(); ++k)
      {
        const auto [a, b] =
          std::minmax(this->Vertex[points[k]], this->Vertex[points[(k + 1) % points.size()]]);
        const std::array<int, 2> ends{ { a, b } };
        const auto& first = this->FirstSegments;
        segments.push_back({ std::find(first.begin(), first.end(), ends) - first.begin(),
          this->Map->ScaledLength(a, b), ends, line });
      }
    };
    for (std::size_t i = 0; i < this->Figure.Lines.size(); ++i)
    {
      collect(this->Figure.Lines[i], static_cast<int>(i), false);
    }
    for (const auto& line : this->ClosedLines)
    {
      collect(line, -1, true);
    }
    std::sort(segments.begin(), segments.end(), [](const Segment& a, const Segment& b) {
      return std::tie(a.Preference, a.Length, a.Ends, a.Line) <
        std::tie(b.Preference, b.Length, b.Ends, b.Line);
    });
    for (const Segment& segment : segments)
    {
      const FigureProblems found = this->Draw(segment.Ends[0], segment.Ends[1], this->Segments);
      if (!found.empty())
      {
        this->Conflicting.push_back(segment.Ends);
      }
      note(found, segment.Line, -1,
        this->Options.LeaveOutConflictingSegments ? this->Result.LeftOut : this->Result.Problems);
    }
    return this->Result.Problems.empty();
  }

  /// Draws the best diagonals of faces that need no added points.
  void FillFaces()
  {
    std::vector<std::array<int, 3>> closed;
    std::vector<CommonMap::Face> faces;
    this->Map->Faces(closed, faces);
    for (const CommonMap::Face& face : faces)
    {
      CornerTriangles triangles;
      if (face.Walks.size() == 1 && face.Walks[0].size() <= ExactFill &&
        FillByDiagonals(this->Polygons(face), this->Options.Quality, triangles))
      {
        for (const auto& t : triangles)
        {
          for (int k = 0; k < 3; ++k)
          {
            this->Map->Add(face.Walks[0][t[k]], face.Walks[0][t[NextCorner(k)]]);
          }
        }
      }
    }
  }

  PolygonPair Polygons(const CommonMap::Face& face) const
  {
    PolygonPair polygons;
    for (int d = 0; d < 2; ++d)
    {
      for (const int v : face.Walks[0])
      {
        polygons[d].push_back(this->Map->GetPoints(d)[v]);
      }
    }
    return polygons;
  }

  /// Connects components by those of some edges that agree.
  void ConnectComponents(const std::vector<std::array<int, 2>>& candidates)
  {
    for (const auto& edge : candidates)
    {
      if (this->Map->Component(edge[0]) != this->Map->Component(edge[1]))
      {
        this->Map->Add(edge[0], edge[1]);
      }
    }
  }

  /// Draws the common diagonals that leave the fewest faces for added points.
  bool DissectFaces()
  {
    if (!this->DrawBridges())
    {
      return false;
    }
    std::vector<std::array<int, 3>> closed;
    std::vector<CommonMap::Face> faces;
    this->Map->Faces(closed, faces);
    for (const CommonMap::Face& face : faces)
    {
      const auto& walk = face.Walks[0];
      if (walk.size() <= LargestDissection)
      {
        for (const auto& chord :
          Dissect(this->Polygons(face), face.Triangles, this->Options.Quality))
        {
          this->Map->Add(walk[chord[0]], walk[chord[1]]);
        }
      }
    }
    return this->Proceed(0.45);
  }

  /// Tries all pairs of corners of the open faces.
  void AddDiagonals()
  {
    std::vector<std::array<int, 3>> closed;
    std::vector<CommonMap::Face> faces;
    this->Map->Faces(closed, faces);
    for (const CommonMap::Face& face : faces)
    {
      std::vector<int> vertices;
      for (const auto& walk : face.Walks)
      {
        vertices.insert(vertices.end(), walk.begin(), walk.end());
      }
      std::sort(vertices.begin(), vertices.end());
      vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
      if (vertices.size() > AllPairs)
      {
        continue;
      }
      std::vector<std::pair<double, std::array<int, 2>>> pairs;
      for (std::size_t i = 0; i < vertices.size(); ++i)
      {
        for (std::size_t k = i + 1; k < vertices.size(); ++k)
        {
          pairs.push_back({ this->Map->ScaledLength(vertices[i], vertices[k]),
            { { vertices[i], vertices[k] } } });
        }
      }
      std::sort(pairs.begin(), pairs.end());
      for (const auto& pair : pairs)
      {
        this->Map->Add(pair.second[0], pair.second[1]);
      }
    }
  }

  /// Joins components by polygonal lines.
  bool DrawBridges()
  {
    for (bool bridged = true; bridged;)
    {
      bridged = false;
      std::vector<std::array<int, 3>> closed;
      std::vector<CommonMap::Face> faces;
      this->Map->Faces(closed, faces);
      for (const CommonMap::Face& face : faces)
      {
        if (face.Walks.size() > 1)
        {
          if (this->Map->Bridge(face) != CommonMap::Drawn::Yes)
          {
            this->Refuse(Kind::Precision, -1, this->PointsOf(face.Walks[0]));
            return false;
          }
          bridged = true;
        }
      }
      if (bridged && !this->Proceed(0.45))
      {
        return false;
      }
    }
    return true;
  }

  bool BridgeComponents()
  {
    this->FillFaces();
    this->AddDiagonals();
    if (!this->DrawBridges())
    {
      return false;
    }
    this->FillFaces();
    this->AddDiagonals();
    return this->SplitFaces();
  }

  /// Divides large faces, whose overlay would have too many crossings.
  bool SplitFaces()
  {
    for (bool split = true; split && this->Proceed(0.45);)
    {
      split = false;
      std::vector<std::array<int, 3>> closed;
      std::vector<CommonMap::Face> faces;
      this->Map->Faces(closed, faces);
      for (const CommonMap::Face& face : faces)
      {
        if (face.Walks[0].size() > LargestOverlay)
        {
          const CommonMap::Drawn drawn = this->Map->Split(face);
          split = split || drawn == CommonMap::Drawn::Yes;
          if (drawn == CommonMap::Drawn::Broken)
          {
            this->Refuse(Kind::Precision, -1, this->PointsOf(face.Walks[0]));
            return false;
          }
        }
      }
    }
    this->FillFaces();
    this->AddDiagonals();
    return !this->Stopped;
  }

  bool AreUnrelated() const
  {
    const int components = this->Map->GetNumberOfComponents();
    return components > Unrelated ||
      (components > UnrelatedFew && 5 * static_cast<std::size_t>(components) > this->Order.size());
  }

  /// For points in frames whose positions have little to do with each other. A line runs through
  /// each point in both domains: in the first along one direction of the frame, in the order of the
  /// points along the other; in the second these lines pass each other point on the right side of
  /// it. With the lines that are straight in the second domain they make a grid of (n + 2)^2 points
  /// whose cells are convex in both domains. False if the figure has other parts, or rounding does
  /// not allow it.
  bool FillByGrid(
    std::array<std::vector<Vector2>, 2>& points, std::vector<std::array<int, 3>>& triangles)
  {
    if (this->Loops.size() != 1 || this->Loops[0].size() != 4 || !this->Segments.empty() ||
      this->Result.NumberOfFramePoints != 4)
    {
      return false;
    }
    constexpr int box = ConstrainedTriangulation::BoxCorners;
    points = { { this->Map->GetPoints(0), this->Map->GetPoints(1) } };
    for (auto& p : points)
    {
      p.resize(this->Order.size() + box);
    }
    std::array<int, 4> corners;
    for (int k = 0; k < 4; ++k)
    {
      corners[k] = this->Vertex[this->Loops[0][k]];
    }
    if (Orientation(points[0][corners[0]], points[0][corners[1]], points[0][corners[2]]) < 0)
    {
      std::swap(corners[1], corners[3]);
    }
    std::vector<int> landmarks;
    for (int v = box; v < static_cast<int>(points[0].size()); ++v)
    {
      if (std::find(corners.begin(), corners.end(), v) == corners.end())
      {
        landmarks.push_back(v);
      }
    }
    // Coordinates in the parallelogram of three corners, from 0 to 1.
    const std::size_t n = landmarks.size();
    std::array<std::vector<Vector2>, 2> unit;
    double margin = 0.5;
    for (int d = 0; d < 2; ++d)
    {
      const Vector2 origin = points[d][corners[0]];
      const Vector2 x = points[d][corners[1]] - origin;
      const Vector2 y = points[d][corners[3]] - origin;
      for (const int v : landmarks)
      {
        const Vector2 p = points[d][v] - origin;
        const Vector2 u{ Cross(p, y) / Cross(x, y), Cross(x, p) / Cross(x, y) };
        unit[d].push_back(u);
        margin = std::min({ margin, u.x, u.y, 1.0 - u.x, 1.0 - u.y });
      }
    }
    if (!(margin > 1e-6))
    {
      return false;
    }
    // Slightly inclined, so that no two points are on one line. The second domain's axes are
    // exchanged, so that in both the lines are those of constant x.
    const double slope = 0.31 * margin;
    std::array<std::vector<int>, 2> order;
    std::array<std::vector<int>, 2> rank;
    for (int d = 0; d < 2; ++d)
    {
      for (Vector2& u : unit[d])
      {
        u = d == 0 ? u : Vector2{ u.y, u.x };
        u.x += slope * u.y;
      }
      order[d].resize(n);
      rank[d].resize(n);
      std::iota(order[d].begin(), order[d].end(), 0);
      std::sort(order[d].begin(), order[d].end(),
        [&](int a, int b) { return unit[d][a].x < unit[d][b].x; });
      for (std::size_t i = 0; i < n; ++i)
      {
        rank[d][order[d][i]] = static_cast<int>(i) + 1;
      }
    }
    const int side = static_cast<int>(n) + 2;
    const int first = static_cast<int>(points[0].size());
    std::vector<int> node(static_cast<std::size_t>(side) * side, -1);
    for (std::size_t i = 0; i < n; ++i)
    {
      node[static_cast<std::size_t>(rank[0][i]) * side + rank[1][i]] = landmarks[i];
    }
    int count = first;
    for (int& v : node)
    {
      v = v < 0 ? count++ : v;
    }
    const double low = 0.5 * margin;
    for (int d = 0; d < 2; ++d)
    {
      points[d].resize(static_cast<std::size_t>(count));
      const Vector2 origin = points[d][corners[0]];
      const Vector2 x = points[d][corners[1]] - origin;
      const Vector2 y = points[d][corners[3]] - origin;
      for (int line = 0; line < side; ++line)
      {
        const bool inside = line > 0 && line + 1 < side;
        const int landmark = inside ? order[d][line - 1] : -1;
        const double at = inside ? unit[d][landmark].x : (line == 0 ? low : 1.0 - low + slope);
        const int middle = inside ? rank[1 - d][landmark] : side - 1;
        const double height = inside ? unit[d][landmark].y : 1.0 - low;
        for (int k = 0; k < side; ++k)
        {
          const double along = k <= middle
            ? low + (height - low) * k / middle
            : height + (1.0 - low - height) * (k - middle) / (side - 1 - middle);
          const int v = d == 0 ? node[static_cast<std::size_t>(line) * side + k]
                               : node[static_cast<std::size_t>(k) * side + line];
          if (v >= first)
          {
            const double across = at - slope * along;
            points[d][v] =
              d == 0 ? origin + across * x + along * y : origin + along * x + across * y;
          }
        }
      }
    }
    const auto at = [&](int line, int level) {
      return node[static_cast<std::size_t>(line) * side + level];
    };
    const auto quality = [&](const std::array<int, 3>& t) {
      return QualityOf(PairQuality::MinimumAngle,
        { points[0][t[0]], points[0][t[1]], points[0][t[2]] },
        { points[1][t[0]], points[1][t[1]], points[1][t[2]] });
    };
    const auto add = [&](int a, int b, int c) {
      triangles.push_back({ a, b, c });
      return quality(triangles.back()) >= 0.0;
    };
    const int last = side - 1;
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
    if (!good)
    {
      triangles.clear();
    }
    return good;
  }

  /// Fills the faces that are still open, with added points where they are necessary.
  bool Triangulate(
    std::array<std::vector<Vector2>, 2>& points, std::vector<std::array<int, 3>>& triangles)
  {
    std::vector<CommonMap::Face> faces;
    this->Map->Faces(triangles, faces);
    points = { { this->Map->GetPoints(0), this->Map->GetPoints(1) } };
    for (const CommonMap::Face& face : faces)
    {
      const auto& walk = face.Walks[0];
      const int m = static_cast<int>(walk.size());
      const PolygonPair polygons = this->Polygons(face);
      CornerTriangles filled;
      std::array<std::vector<Vector2>, 2> added;
      std::array<Vector2, 2> center;
      if (m <= static_cast<int>(ExactFill) &&
        FillByDiagonals(polygons, this->Options.Quality, filled))
      {
      }
      else if (FindStarCenter(polygons, center))
      {
        added = { { { center[0] }, { center[1] } } };
        for (int i = 0; i < m; ++i)
        {
          filled.push_back({ m, i, (i + 1) % m });
        }
      }
      else if (!FillByOverlay(polygons, face.Triangles, this->Options.Quality, added, filled))
      {
        this->Refuse(Kind::Precision, -1, this->PointsOf(walk));
        return false;
      }
      const int first = static_cast<int>(points[0].size());
      for (int d = 0; d < 2; ++d)
      {
        points[d].insert(points[d].end(), added[d].begin(), added[d].end());
      }
      for (const auto& t : filled)
      {
        std::array<int, 3> triangle;
        for (int k = 0; k < 3; ++k)
        {
          triangle[k] = t[k] < m ? walk[t[k]] : first + t[k] - m;
        }
        triangles.push_back(triangle);
      }
    }
    return true;
  }

  /// Points of the figure beside the first added one.
  std::vector<int> PlaceOfAdded(const PairMesh& mesh) const
  {
    std::vector<int> vertices;
    std::vector<int> star;
    for (int v = mesh.GetFirstAdded(); v < mesh.GetNumberOfPoints() && vertices.empty(); ++v)
    {
      if (mesh.IsUsed(v))
      {
        mesh.Star(v, star);
        for (const int t : mesh.Grow(star))
        {
          const auto& corners = mesh.GetTriangles()[t].Vertices;
          vertices.insert(vertices.end(), corners.begin(), corners.end());
        }
      }
    }
    return this->PointsOf(vertices);
  }

  void Output(const PairMesh& mesh)
  {
    const int given = static_cast<int>(this->Figure.Points[0].size());
    const int known = static_cast<int>(this->Points[0].size());
    auto& result = this->Result;
    result.Points = this->Points;
    std::vector<int> number(mesh.GetNumberOfPoints(), -1);
    for (int p = 0; p < known; ++p)
    {
      result.OriginalIds.push_back(p < given ? p : -1);
      number[this->Vertex[p]] = p;
    }
    for (int v = mesh.GetFirstAdded(); v < mesh.GetNumberOfPoints(); ++v)
    {
      if (mesh.IsUsed(v))
      {
        number[v] = static_cast<int>(result.OriginalIds.size());
        result.OriginalIds.push_back(-1);
        ++result.NumberOfAddedPoints;
        for (int d = 0; d < 2; ++d)
        {
          Vector2 p = mesh.GetPoints(d)[v];
          if (d == 1 && result.Mirrored)
          {
            p.y = -p.y;
          }
          result.Points[d == 0 ? this->First : 1 - this->First].push_back(p);
        }
      }
    }
    const bool reversed = result.Mirrored && this->First == 1;
    for (const auto& t : mesh.GetTriangles())
    {
      if (t.Alive)
      {
        std::array<int, 3> triangle{ { number[t.Vertices[0]], number[t.Vertices[1]],
          number[t.Vertices[2]] } };
        if (reversed)
        {
          std::swap(triangle[1], triangle[2]);
        }
        result.Triangles.push_back(triangle);
      }
    }
    for (const auto& edge : this->LoopEdges)
    {
      result.LoopEdges.push_back({ number[edge[0]], number[edge[1]] });
    }
    for (const auto& edge : this->Segments)
    {
      result.Segments.push_back({ number[edge[0]], number[edge[1]] });
    }
  }

  const FigurePair& Figure;
  const IsomorphicTriangulationOptions& Options;
  double FrameMargin;
  IsomorphicTriangulationResult Result;
  std::unique_ptr<PairMesh> Best;
  bool DividesFrame;
  bool AutomaticFrame = false;
  bool FrameIsDivided = false;
  bool NeedsPlainFrame = false;
  bool Refused = false;

  // The figure's points, then the frame's corners.
  std::array<std::vector<Vector2>, 2> Points;
  std::vector<std::vector<int>> Loops;
  std::vector<std::vector<int>> ClosedLines;
  std::vector<int> LoopOf;
  // Which domain comes first, the points in their order, and what vertex of the map each is.
  int First = 0;
  std::vector<int> Order;
  std::vector<int> Vertex;
  std::array<std::vector<Vector2>, 2> Ordered;
  std::unique_ptr<CommonMap> Map;
  bool Stopped = false;
  std::vector<std::array<int, 2>> LoopEdges;
  std::vector<std::array<int, 2>> Segments;
  // Segments that contradict others and could not be drawn, and those that are drawn first.
  std::vector<std::array<int, 2>> Conflicting;
  std::vector<std::array<int, 2>> FirstSegments;
};

} // namespace

IsomorphicTriangulationResult MakeIsomorphicTriangulation(
  const FigurePair& figure, const IsomorphicTriangulationOptions& options)
{
  // An automatic frame that is too near the points can require points that a wider one does not.
  std::unique_ptr<Builder> best;
  for (const double margin : { 0.5, 1.5, 4.0 })
  {
    auto builder = std::make_unique<Builder>(figure, options, margin, true);
    bool made = builder->Prepare();
    if (builder->MayNeedPlainFrame())
    {
      auto plain = std::make_unique<Builder>(figure, options, margin, false);
      const bool madePlain = plain->Prepare();
      if (!made || (madePlain && plain->CountAdded() < builder->CountAdded()))
      {
        builder = std::move(plain);
        made = madePlain;
      }
    }
    if (!best || (made && builder->CountAdded() < best->CountAdded()))
    {
      best = std::move(builder);
    }
    const int enough = margin < 1.0 ? ManyPoints : FewPoints;
    if (!best->CanImprove() || !best->HasAutomaticFrame() || best->CountAdded() > enough)
    {
      break;
    }
  }
  if (best->GetResult().IsComplete())
  {
    best->Finish();
  }
  return std::move(best->GetResult());
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
  // Of the four rotations the one whose corners lie in the directions of the affine images.
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

PairStatistics MeasurePair(const std::array<std::vector<Vector2>, 2>& points,
  const std::vector<std::array<int, 3>>& triangles)
{
  PairStatistics statistics;
  statistics.MinimumAngle = { { 180.0, 180.0 } };
  int obtuse = 0;
  int discordant = 0;
  for (int t = 0; t < static_cast<int>(triangles.size()); ++t)
  {
    std::array<TrianglePoints, 2> p;
    bool isObtuse = false;
    bool isDiscordant = false;
    double smallest = 180.0;
    for (int d = 0; d < 2; ++d)
    {
      for (int k = 0; k < 3; ++k)
      {
        p[d][k] = points[d][triangles[t][k]];
      }
      if (Cross(p[d][1] - p[d][0], p[d][2] - p[d][0]) < 0.0)
      {
        for (Vector2& corner : p[d])
        {
          corner.y = -corner.y;
        }
      }
      for (const double angle : Angles(p[d]))
      {
        for (int i = 0; i < 3; ++i)
        {
          statistics.SharesBelow[d][i] += angle < 10.0 + 5.0 * i ? 1.0 : 0.0;
        }
        isObtuse = isObtuse || angle > 90.0;
        smallest = std::min(smallest, angle);
        if (angle < statistics.MinimumAngle[d])
        {
          statistics.MinimumAngle[d] = angle;
          statistics.MinimumAngleTriangle[d] = t;
        }
      }
      isDiscordant = isDiscordant || !IsConcordant(&p[d][0].x, &p[d][1].x, &p[d][2].x, 2);
    }
    obtuse += isObtuse ? 1 : 0;
    discordant += isDiscordant ? 1 : 0;
    const double distortion = Distortion(p[0], p[1]);
    statistics.MinimumAngles.push_back(smallest);
    statistics.Distortions.push_back(distortion);
    if (statistics.LargestDistortionTriangle < 0 || distortion > statistics.LargestDistortion)
    {
      statistics.LargestDistortion = distortion;
      statistics.LargestDistortionTriangle = t;
    }
  }
  const double n = static_cast<double>(std::max<std::size_t>(triangles.size(), 1));
  for (auto& shares : statistics.SharesBelow)
  {
    for (double& share : shares)
    {
      share /= 3.0 * n;
    }
  }
  statistics.ObtuseShare = obtuse / n;
  statistics.DiscordantShare = discordant / n;
  return statistics;
}

} // namespace homeomorphism
