// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The inverse of the CubicMap.

#include "Mesh/CubicMap.h"

#include <algorithm>
#include <cmath>
#include <deque>
#include <limits>
#include <unordered_set>

namespace homeomorphism
{
namespace
{

constexpr int NewtonSteps = 300;
// Residuals that are this many times greater than the tolerance can be rounding errors, but rarely
// are.
constexpr double UsualRounding = 64.0;
// Half the second derivatives times the size of a triangle, divided by the smallest stretch, rarely
// exceed this.
constexpr double MostBending = 10.0;

// A cubic Bezier triangle with ten control points.
struct CubicPatch
{
  std::array<Vector2, 3> Corners;
  // Rows with the same index of the third corner, each from the first to the second corner.
  std::array<Vector2, 10> Points;
};

constexpr int PatchNumber(int second, int third)
{
  return 4 * third - third * (third - 1) / 2 + second;
}

// Bisects a patch at the middle of the edge from the first to the second corner, by de Casteljau's
// algorithm. Numbers the corners of the halves so that another edge is bisected next.
std::array<CubicPatch, 2> Bisect(const CubicPatch& patch)
{
  const Vector2 middle = 0.5 * (patch.Corners[0] + patch.Corners[1]);
  std::array<CubicPatch, 2> halves;
  halves[0].Corners = { patch.Corners[2], patch.Corners[0], middle };
  halves[1].Corners = { patch.Corners[1], patch.Corners[2], middle };
  for (int third = 0; third <= 3; ++third)
  {
    const int degree = 3 - third;
    Vector2 row[4];
    for (int n = 0; n <= degree; ++n)
    {
      row[n] = patch.Points[PatchNumber(n, third)];
    }
    for (int step = 0; step <= degree; ++step)
    {
      halves[0].Points[PatchNumber(degree - step, step)] = row[0];
      halves[1].Points[PatchNumber(third, step)] = row[degree - step];
      for (int n = 0; n + step < degree; ++n)
      {
        row[n] = 0.5 * (row[n] + row[n + 1]);
      }
    }
  }
  return halves;
}

std::array<CubicPatch, 3> GetPatches(const CubicElement& element)
{
  const CubicOrdinates<Vector2> b = GetOrdinates(element);
  const std::array<Vector2, 3>& p = element.Points;
  const Vector2 centroid = p[0] + (1.0 / 3.0) * ((p[1] - p[0]) + (p[2] - p[0]));
  std::array<CubicPatch, 3> patches;
  for (int k = 0; k < 3; ++k)
  {
    const int i = NextCorner(k);
    const int j = PreviousCorner(k);
    CubicPatch& patch = patches[k];
    patch.Corners = { p[i], p[j], centroid };
    patch.Points = { b.Corner[i], b.AfterStart[k], b.BeforeEnd[k], b.Corner[j], b.Inner[i],
      b.Middle[k], b.Inner[j], b.Spoke[i], b.Spoke[j], b.Center };
    for (int third = 0; third <= 3; ++third)
    {
      for (int second = 0; second + third <= 3; ++second)
      {
        const Vector2 at = (1.0 / 3.0) *
          ((3.0 - second - third) * patch.Corners[0] + double(second) * patch.Corners[1] +
            double(third) * patch.Corners[2]);
        Vector2& point = patch.Points[PatchNumber(second, third)];
        point = point + element.Affine * at;
      }
    }
  }
  return patches;
}

// Whether the bounding boxes of the control points contain an image. Returns the extent of the
// control points.
bool Contains(const CubicPatch& patch, const Vector2& image, double tolerance, double& extent)
{
  Vector2 least = patch.Points[0];
  Vector2 greatest = patch.Points[0];
  for (const Vector2& point : patch.Points)
  {
    least = { std::min(least.x, point.x), std::min(least.y, point.y) };
    greatest = { std::max(greatest.x, point.x), std::max(greatest.y, point.y) };
  }
  extent = MaxNorm(greatest - least);
  if (!(image.x >= least.x - tolerance && image.x <= greatest.x + tolerance &&
        image.y >= least.y - tolerance && image.y <= greatest.y + tolerance))
  {
    return false;
  }
  // An axis-aligned box is far too large for a thin patch, so test a parallelogram along two of its
  // edges, too.
  const Vector2 origin = patch.Points[0];
  const Vector2 first = patch.Points[PatchNumber(3, 0)] - origin;
  const Vector2 second = patch.Points[PatchNumber(0, 3)] - origin;
  const double area = Cross(first, second);
  const Vector2 local = image - origin;
  const Vector2 along{ Cross(local, second), Cross(first, local) };
  const Vector2 slack{ tolerance * (std::abs(second.x) + std::abs(second.y)),
    tolerance * (std::abs(first.x) + std::abs(first.y)) };
  least = { std::min(0.0, area), std::min(0.0, area) };
  greatest = { std::max(0.0, area), std::max(0.0, area) };
  for (const Vector2& point : patch.Points)
  {
    const Vector2 d = point - origin;
    const Vector2 at{ Cross(d, second), Cross(first, d) };
    least = { std::min(least.x, at.x), std::min(least.y, at.y) };
    greatest = { std::max(greatest.x, at.x), std::max(greatest.y, at.y) };
  }
  return along.x >= least.x - slack.x && along.x <= greatest.x + slack.x &&
    along.y >= least.y - slack.y && along.y <= greatest.y + slack.y;
}

// The number of bisections after which a patch is as small as rounding allows.
constexpr int Bisections = 110;
// The number of bisections between attempts to find the preimage by Newton's method.
constexpr int BisectionsPerAttempt = 6;

// Bisects a patch recursively where it may contain an image. Calls found(middle, smallest) for
// parts, where smallest tells whether a part is not bisected further. Stops when found returns
// true.
template <typename Found>
bool Subdivide(
  const CubicPatch& patch, const Vector2& image, double tolerance, int depth, Found&& found)
{
  double extent;
  if (!Contains(patch, image, tolerance, extent))
  {
    return false;
  }
  const bool smallest = extent <= 4.0 * tolerance || depth == Bisections;
  if ((smallest || depth % BisectionsPerAttempt == 0) &&
    found((1.0 / 3.0) * (patch.Corners[0] + patch.Corners[1] + patch.Corners[2]), smallest))
  {
    return true;
  }
  for (const CubicPatch& half : Bisect(patch))
  {
    if (Subdivide(half, image, tolerance, depth + 1, found))
    {
      return true;
    }
  }
  return false;
}

// The edge beyond which a point, relative to corner 0, is farthest outside; -1 if it is inside.
int FindExit(const std::array<Vector2, 3>& corners, const Vector2& point)
{
  // Corner 0 is the origin, so a point on an edge is on it from both sides.
  std::array<double, 3> heights;
  for (int k = 0; k < 3; ++k)
  {
    const Vector2 start = corners[NextCorner(k)];
    heights[k] = Cross(corners[PreviousCorner(k)] - start, point - start);
  }
  if (heights[0] >= 0.0 && heights[1] >= 0.0 && heights[2] >= 0.0)
  {
    return -1;
  }
  int exit = -1;
  double farthest = 0.0;
  for (int k = 0; k < 3; ++k)
  {
    const Vector2 edge = corners[PreviousCorner(k)] - corners[NextCorner(k)];
    const double relative = heights[k] / Dot(edge, edge);
    if (relative < farthest)
    {
      farthest = relative;
      exit = k;
    }
  }
  return exit;
}

// A point relative to corner 0 of one triangle, relative to that of another.
Vector2 MoveOrigin(const PlanarPair& pair, int from, int to, const Vector2& point)
{
  return point + (pair.Source[pair.Triangles[from][0]] - pair.Source[pair.Triangles[to][0]]);
}

// Sets the preimage of a point of the batch, relative to corner 0 of a triangle.
void SetPreimage(const PlanarPair& pair, CubicBatch& batch, int number, bool found, int triangle,
  const Vector2& point)
{
  const Vector2 preimage = pair.Source[pair.Triangles[triangle][0]] + point;
  batch.Triangles[number] = found ? triangle : -1;
  batch.ImageX[number] = preimage.x;
  batch.ImageY[number] = preimage.y;
}

} // anonymous namespace

//------------------------------------------------------------------------------
void CubicMap::Walk(int& triangle, Vector2& point) const
{
  const PlanarPair& pair = this->GetFine();
  for (int step = 0; step < 1000; ++step)
  {
    const std::array<Vector2, 3> corners = pair.GetSourceCorners(triangle);
    const int exit = FindExit(corners, point);
    if (exit < 0)
    {
      return;
    }
    const int neighbor = pair.Neighbors[triangle][exit];
    if (neighbor < 0)
    {
      // The nearest point of the boundary edge.
      const Vector2 start = corners[NextCorner(exit)];
      const Vector2 edge = corners[PreviousCorner(exit)] - start;
      const double s = std::clamp(Dot(point - start, edge) / Dot(edge, edge), 0.0, 1.0);
      point = start + s * edge;
      return;
    }
    point = MoveOrigin(pair, triangle, neighbor, point);
    triangle = neighbor;
  }
}

//------------------------------------------------------------------------------
// Points whose preimages are searched for in whole triangles of the refined pair.
struct CubicMap::Walkers
{
  static constexpr int MostRuns = CubicWalkers::Size / WidestVector;

  // The points that start in the triangle of a run are consecutive in the batch. Those that enter
  // it later are after them.
  struct Start
  {
    int Triangle;
    int First;
    int Count;
  };

  // A point that enters a triangle, from a run if that is not negative.
  struct Entry
  {
    int Number;
    int Triangle;
    int From;
    Barycentric L;
  };

  int NumberOfRuns = 0;
  int Stop = 0;
  CubicRun Runs[MostRuns];
  Start Starts[MostRuns];
  // The indices in the batch of the points that enter.
  std::int32_t Numbers[CubicWalkers::Size];
  int NumberOfEntries = 0;
  Entry Entries[CubicBatch::Capacity];
  CubicWalkers Arrays;

  bool HasRoom(int count) const
  {
    return this->NumberOfRuns < MostRuns &&
      this->Stop + InWholeVectors(count) <= CubicWalkers::Size;
  }

  void Add(int triangle, const CubicNet* net, int first, int count)
  {
    this->Runs[this->NumberOfRuns] = { net, this->Stop, this->Stop + count, false };
    this->Starts[this->NumberOfRuns] = { triangle, first, count };
    this->Stop += InWholeVectors(count);
    ++this->NumberOfRuns;
  }

  // A run in an entry's triangle with an unused element, -1 if there is none.
  int FindRun(const Entry& entry) const
  {
    for (int run : { entry.From + 1, entry.From - 1, this->NumberOfRuns - 1 })
    {
      if (run >= 0 && run < this->NumberOfRuns && this->Starts[run].Triangle == entry.Triangle &&
        this->Runs[run].End % WidestVector != 0)
      {
        return run;
      }
    }
    return -1;
  }
};

//------------------------------------------------------------------------------
Barycentric CubicMap::Leave(int& triangle, const Barycentric& l, Vector2& point) const
{
  const PlanarPair& pair = this->GetFine();
  const std::array<Vector2, 3> corners = pair.GetSourceCorners(triangle);
  // The coordinates of walkers that failed may be NaN.
  const bool isFinite = std::isfinite(l[1]) && std::isfinite(l[2]);
  point =
    isFinite ? l[1] * corners[1] + l[2] * corners[2] : (1.0 / 3.0) * (corners[1] + corners[2]);
  // Most points are in the neighbor beyond the edge with the least coordinate.
  const int neighbor = pair.Neighbors[triangle][FindPiece(l).Opposite];
  if (neighbor >= 0)
  {
    const Vector2 moved = MoveOrigin(pair, triangle, neighbor, point);
    const Barycentric there = ToBarycentricByAreas(pair.GetSourceCorners(neighbor), moved);
    if (there[0] >= 0.0 && there[1] >= 0.0 && there[2] >= 0.0)
    {
      triangle = neighbor;
      point = moved;
      return there;
    }
  }
  this->Walk(triangle, point);
  return ToBarycentricByAreas(pair.GetSourceCorners(triangle), point);
}

//------------------------------------------------------------------------------
void CubicMap::StartWalking(
  const CubicBatch& batch, int begin, int end, int triangle, Walkers& walkers) const
{
  const PlanarPair& pair = this->GetFine();
  CubicWalkers& arrays = walkers.Arrays;
  const double* const l[3] = { batch.L[0] + begin, batch.L[1] + begin, batch.L[2] + begin };
  const int run = walkers.NumberOfRuns;
  walkers.Add(triangle, &this->Bending->Nets[triangle], begin, end - begin);
  const int first = walkers.Runs[run].Begin;
  if (StartWalkers(this->Inverses[triangle], pair.Target[pair.Triangles[triangle][0]], l,
        batch.X + begin, batch.Y + begin, end - begin, first, arrays))
  {
    return;
  }
  for (int i = first; i < walkers.Runs[run].End; ++i)
  {
    // If the starting point is outside the triangle, begin in the triangle that contains it.
    if (arrays.States[i] == CubicWalkers::Left)
    {
      int next = triangle;
      Vector2 point;
      const Barycentric there =
        this->Leave(next, { arrays.L[0][i], arrays.L[1][i], arrays.L[2][i] }, point);
      if (this->IsWhole(next))
      {
        arrays.States[i] = CubicWalkers::Found;
        walkers.Entries[walkers.NumberOfEntries++] = { begin + (i - first), next, run, there };
      }
    }
  }
}

//------------------------------------------------------------------------------
void CubicMap::EnterTriangles(const CubicBatch& batch, Walkers& walkers) const
{
  const PlanarPair& pair = this->GetFine();
  CubicWalkers& arrays = walkers.Arrays;
  int waiting = 0;
  for (int n = 0; n < walkers.NumberOfEntries; ++n)
  {
    const Walkers::Entry entry = walkers.Entries[n];
    int run = walkers.FindRun(entry);
    if (run < 0)
    {
      if (!walkers.HasRoom(1))
      {
        walkers.Entries[waiting++] = { entry.Number, entry.Triangle, -1, entry.L };
        continue;
      }
      run = walkers.NumberOfRuns;
      walkers.Add(entry.Triangle, &this->Bending->Nets[entry.Triangle], 0, 0);
      std::fill_n(arrays.States + walkers.Stop, WidestVector, CubicWalkers::Found);
      walkers.Stop += WidestVector;
    }
    const int i = walkers.Runs[run].End++;
    const Vector2 image = Vector2{ batch.X[entry.Number], batch.Y[entry.Number] } -
      pair.Target[pair.Triangles[entry.Triangle][0]];
    walkers.Numbers[i] = entry.Number;
    for (int k = 0; k < 3; ++k)
    {
      // Rounding errors of these coordinates are corrected by Newton's method.
      arrays.L[k][i] = entry.L[k];
    }
    arrays.X[i] = image.x;
    arrays.Y[i] = image.y;
    arrays.States[i] = CubicWalkers::OnTheWay;
  }
  walkers.NumberOfEntries = waiting;
}

//------------------------------------------------------------------------------
void CubicMap::FindByNets(CubicBatch& batch, Walkers& walkers, CubicTriangle& prepared) const
{
  constexpr int mostRounds = 30;
  const PlanarPair& pair = this->GetFine();
  CubicWalkers& arrays = walkers.Arrays;
  for (int round = 0; walkers.NumberOfRuns > 0 || walkers.NumberOfEntries > 0; ++round)
  {
    this->EnterTriangles(batch, walkers);
    IterateWalkers(walkers.Runs, walkers.NumberOfRuns, this->ResidualTolerance, arrays);
    for (int run = 0; run < walkers.NumberOfRuns; ++run)
    {
      const auto [t, first, count] = walkers.Starts[run];
      const int begin = walkers.Runs[run].Begin;
      const double* const l[3] = { arrays.L[0] + begin, arrays.L[1] + begin, arrays.L[2] + begin };
      MapByCorners(pair.GetSourceCorners(t), pair.Source[pair.Triangles[t][0]], l, count,
        batch.ImageX + first, batch.ImageY + first);
    }
    // Then the points that have entered, and those that are not found.
    for (int run = 0; run < walkers.NumberOfRuns; ++run)
    {
      const auto [t, first, count] = walkers.Starts[run];
      const CubicRun& lanes = walkers.Runs[run];
      const int entered = lanes.Begin + count;
      for (int i = lanes.AreFound ? entered : lanes.Begin; i < lanes.End; ++i)
      {
        const bool isFound = arrays.States[i] == CubicWalkers::Found;
        if (isFound && i < entered)
        {
          continue;
        }
        const int number = i < entered ? first + (i - lanes.Begin) : walkers.Numbers[i];
        const Barycentric l{ arrays.L[0][i], arrays.L[1][i], arrays.L[2][i] };
        int triangle = t;
        Vector2 point;
        bool found = true;
        if (isFound)
        {
          const std::array<Vector2, 3> corners = pair.GetSourceCorners(t);
          point = l[1] * corners[1] + l[2] * corners[2];
        }
        else
        {
          const Barycentric there = this->Leave(triangle, l, point);
          if (arrays.States[i] == CubicWalkers::Left && round < mostRounds &&
            this->IsWhole(triangle))
          {
            walkers.Entries[walkers.NumberOfEntries++] = { number, triangle, -1, there };
            continue;
          }
          found =
            this->FindByWalking({ batch.X[number], batch.Y[number] }, triangle, point, prepared);
        }
        SetPreimage(pair, batch, number, found, triangle, point);
      }
    }
    walkers.NumberOfRuns = walkers.Stop = 0;
  }
}

//------------------------------------------------------------------------------
void CubicMap::FindPreimages(CubicBatch& batch, CubicTriangle& prepared) const
{
  this->MoveToChildren(batch);
  const PlanarPair& pair = this->GetFine();
  const double* const l[3] = { batch.L[0], batch.L[1], batch.L[2] };
  std::int64_t isMiddle[CubicBatch::Size];
  Walkers walkers;
  batch.ForEachRun([&](int begin, int end, int t) {
    if (this->IsWhole(t))
    {
      if (!walkers.HasRoom(end - begin))
      {
        this->FindByNets(batch, walkers, prepared);
      }
      this->StartWalking(batch, begin, end, t, walkers);
      return;
    }
    const std::array<std::int32_t, 3>& corners = pair.Triangles[t];
    const Vector2 origin = pair.Source[corners[0]];
    if (!this->Bending)
    {
      const CubicTemplate::MiddleBounds& bounds = this->Template->GetMiddle(t);
      MapMiddle({ origin, pair.Source[corners[1]], pair.Source[corners[2]] }, bounds.Least,
        bounds.Greatest, l, begin, end, batch.ImageX, batch.ImageY, isMiddle);
    }
    const std::array<Vector2, 3> edges = pair.GetSourceCorners(t);
    for (int i = begin; i < end; ++i)
    {
      if (this->Bending || isMiddle[i] == 0)
      {
        int triangle = t;
        Vector2 point = batch.L[1][i] * edges[1] + batch.L[2][i] * edges[2];
        prepared.Set(t);
        const bool isInside = batch.L[0][i] >= 0.0 && batch.L[1][i] >= 0.0 && batch.L[2][i] >= 0.0;
        const bool found =
          (isInside && !this->Bending && prepared.FindDirectly(point, this->ResidualTolerance)) ||
          this->FindByWalking({ batch.X[i], batch.Y[i] }, triangle, point, prepared);
        SetPreimage(pair, batch, i, found, triangle, point);
      }
    }
  });
  this->FindByNets(batch, walkers, prepared);
  for (int i = 0; this->Levels > 0 && i < batch.Count; ++i)
  {
    batch.Triangles[i] = batch.Triangles[i] < 0 ? -1 : batch.Triangles[i] >> (2 * this->Levels);
  }
}

//------------------------------------------------------------------------------
bool CubicMap::FindPreimage(const Vector2& image, const Barycentric& l, int& triangle,
  Vector2& point, CubicTriangle& prepared) const
{
  CubicBatch batch;
  batch.Count = 1;
  batch.Triangles[0] = triangle;
  for (int k = 0; k < 3; ++k)
  {
    std::fill_n(batch.L[k], WidestVector, l[k]);
  }
  batch.X[0] = image.x;
  batch.Y[0] = image.y;
  this->FindPreimages(batch, prepared);
  if (batch.Triangles[0] < 0)
  {
    return false;
  }
  triangle = batch.Triangles[0];
  point = { batch.ImageX[0], batch.ImageY[0] };
  return true;
}

//------------------------------------------------------------------------------
double CubicMap::GetTolerance(int fineTriangle, const Matrix2& derivative) const
{
  const PlanarPair& pair = this->GetFine();
  return std::max(
    { this->ResidualTolerance, ResidualUlps * pair.GetRounding(fineTriangle, derivative),
      ResidualUlps * pair.GetRounding(fineTriangle, this->Template->GetAffine(fineTriangle)) });
}

//------------------------------------------------------------------------------
bool CubicMap::FindByWalking(
  const Vector2& image, int& triangle, Vector2& point, CubicTriangle& prepared) const
{
  // Newton's method, walking over the triangles. All positions are relative to corner 0 of the
  // current triangle.
  const PlanarPair& pair = this->GetFine();
  int t = triangle;
  Vector2 x = point;
  this->Walk(t, x);
  Vector2 residual;
  Matrix2 derivative;
  double size = std::numeric_limits<double>::infinity();
  // First full steps, on the prepared triangles.
  int at = t;
  Vector2 from = x;
  double lastMove = 0.0;
  int lastTriangle = -1;
  int lastElement = -1;
  for (int step = 0; step < 20; ++step)
  {
    prepared.Set(at);
    Vector2 move;
    residual = prepared.GetResidual(
      from, image - pair.Target[pair.Triangles[at][0]], at == lastTriangle, move);
    const double now = MaxNorm(residual);
    if (!(now < size))
    {
      break;
    }
    t = at;
    x = from;
    // Within one element, the error after a step is about a constant times the square of its
    // length, which predicts the error after the next step. The error after the last step can be
    // small by chance if second derivatives change sign along it, so the next step must also be
    // short compared with the element.
    const double length = MaxNorm(move);
    const bool isSame = at == lastTriangle && prepared.GetLastElement() == lastElement;
    const double next = isSame ? now * (length / lastMove) * (length / lastMove) : now;
    const bool isShort =
      MostBending * now * length <= this->ResidualTolerance * prepared.GetScale();
    size = now;
    if (now <= 0.5 * this->ResidualTolerance)
    {
      break;
    }
    lastTriangle = at;
    lastElement = prepared.GetLastElement();
    from = from + move;
    const bool isInside = FindExit(prepared.GetCorners(), from) < 0;
    if (!isInside)
    {
      this->Walk(at, from);
    }
    if (isInside && isShort && next <= 1e-3 * this->ResidualTolerance)
    {
      x = from;
      size = next;
      break;
    }
    lastMove = length;
  }
  if (!(size <= this->ResidualTolerance))
  {
    const auto evaluate = [&](int inside, const Vector2& start) {
      Vector2 value;
      this->MapFine(inside, start, value, derivative);
      prepared.Set(inside);
      return (image - pair.Target[pair.Triangles[inside][0]]) - prepared.Map(start);
    };
    residual = evaluate(t, x);
    size = MaxNorm(residual);
    bool done = false;
    for (int step = 0; step < NewtonSteps && !done && size > 0.0; ++step)
    {
      const Vector2 move = Solve(derivative, residual);
      double share = 1.0;
      bool better = false;
      for (int half = 0; half < 30 && !better; ++half, share *= 0.5)
      {
        int next = t;
        Vector2 to = x + share * move;
        this->Walk(next, to);
        const Vector2 nextResidual = evaluate(next, to);
        const double nextSize = MaxNorm(nextResidual);
        if (nextSize < size)
        {
          better = true;
          t = next;
          x = to;
          residual = nextResidual;
          size = nextSize;
        }
        else if (size <= this->ResidualTolerance)
        {
          break;
        }
      }
      done = !better;
    }
  }
  const double tolerance =
    size <= this->ResidualTolerance ? size : this->GetTolerance(t, derivative);
  if (!(size <= std::min(tolerance, UsualRounding * this->ResidualTolerance)))
  {
    // Newton's method has stalled, or the image is outside the target's domain.
    int found = t;
    Vector2 better;
    if (this->SearchPreimage(image, found, better))
    {
      better = better - pair.Source[pair.Triangles[found][0]];
      prepared.Set(found);
      const Vector2 rest = image - pair.Target[pair.Triangles[found][0]] - prepared.Map(better);
      if (!(size <= tolerance) || MaxNorm(rest) < size)
      {
        triangle = found;
        point = better;
        return true;
      }
    }
  }
  triangle = t;
  point = x;
  return size <= tolerance;
}

//------------------------------------------------------------------------------
// Searches all triangles for the preimage, breadth-first, by bisecting control nets.
bool CubicMap::SearchPreimage(const Vector2& image, int& triangle, Vector2& point) const
{
  const PlanarPair& pair = this->GetFine();
  std::deque<int> queue{ triangle };
  std::unordered_set<int> seen{ triangle };
  while (!queue.empty())
  {
    const int t = queue.front();
    queue.pop_front();
    bool found = false;
    this->VisitFine(
      t,
      [&](const CubicElement& element, const Vector2& sourceOrigin, const Vector2& targetOrigin,
        double factor) {
        if (found)
        {
          return;
        }
        const Vector2 local = (1.0 / factor) * (image - targetOrigin);
        const double tolerance = this->GetTolerance(t, this->Template->GetAffine(t)) / factor;
        const CubicOrdinates<Vector2> ordinates = GetOrdinates(element);
        for (const CubicPatch& patch : GetPatches(element))
        {
          found = found ||
            Subdivide(patch, local, tolerance, 0, [&](const Vector2& start, bool smallest) {
              // Newton's method, while the residual decreases and the point is in the element.
              Vector2 x = start;
              point = sourceOrigin + factor * x;
              double last = std::numeric_limits<double>::infinity();
              for (int step = 0; step < 12; ++step)
              {
                const Barycentric l = ToBarycentric(element.Points, x);
                if (!(std::min({ l[0], l[1], l[2] }) >= -1e-14))
                {
                  break;
                }
                Vector2 value;
                Matrix2 gradient;
                Evaluate(element, ordinates, l, value, gradient);
                const Vector2 residual = local - (element.Affine * x + value);
                const double size = MaxNorm(residual);
                if (!(size < last))
                {
                  break;
                }
                last = size;
                point = sourceOrigin + factor * x;
                x = x + Solve(element.Affine + gradient, residual);
              }
              return last <= 4.0 * this->ResidualTolerance / factor || smallest;
            });
        }
      },
      50);
    if (found)
    {
      triangle = t;
      return true;
    }
    for (int neighbor : pair.Neighbors[t])
    {
      if (neighbor >= 0 && seen.insert(neighbor).second)
      {
        queue.push_back(neighbor);
      }
    }
  }
  return false;
}

} // namespace homeomorphism
