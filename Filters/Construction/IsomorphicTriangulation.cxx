// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "IsomorphicTriangulation.h"

#include "CommonMap.h"
#include "FaceDissection.h"
#include "FaceFilling.h"
#include "GridFilling.h"
#include "JointOptimization.h"
#include "Kernel/ExactSign.h"
#include "PairMesh.h"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <map>
#include <memory>
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

/// The construction from the checked figure to the mesh. Works on points in an order of its own,
/// which depends on positions alone, and on the domain whose coordinates come first in the order of
/// numbers: so neither the order of landmarks nor which domain is the source changes the result.
class Builder
{
public:
  Builder(const FigurePair& figure, const IsomorphicTriangulationOptions& options,
    const BoundaryOptions& boundary)
    : Options(options)
    , Given(figure.Points[0].size())
    , Figure(FindBoundary(figure, boundary))
    , Lines(figure.Lines)
  {
    this->Result.Problems = this->Figure.Problems;
    this->Result.Mirrored = this->Figure.Mirrored;
    this->Result.NumberOfFramePoints = this->Figure.NumberOfFramePoints;
  }

  /// Makes the best pair that needs few added points. False if the figure was refused.
  bool Prepare()
  {
    if (!this->Result.Problems.empty())
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

  bool HasAutomaticFrame() const { return this->Figure.HasAutomaticFrame; }
  /// Whether the points on an automatic frame's edges prevented a result, or perhaps a better one.
  bool MayNeedPlainFrame() const
  {
    return this->NeedsPlainFrame ||
      (this->Figure.FrameIsDivided && this->Best && this->CountAdded() > ManyPoints);
  }
  IsomorphicTriangulationResult& GetResult() { return this->Result; }

private:
  void Refuse(Kind kind, int domain, std::vector<int> points)
  {
    this->Result.Problems.push_back(MakeProblem(kind, domain, std::move(points)));
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
    this->First = sorted(this->Figure.Points[1]) < sorted(this->Figure.Points[0]) ? 1 : 0;
    this->Order = HilbertOrder(this->Figure.Points[this->First]);
    this->Vertex.resize(this->Order.size());
    for (std::size_t i = 0; i < this->Order.size(); ++i)
    {
      this->Vertex[this->Order[i]] = static_cast<int>(i) + ConstrainedTriangulation::BoxCorners;
      for (int d = 0; d < 2; ++d)
      {
        Vector2 p = this->Figure.Points[d == 0 ? this->First : 1 - this->First][this->Order[i]];
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
        for (const int p : problem.Points)
        {
          if (!this->LoopOf.empty() && this->LoopOf[p] >= 0)
          {
            problem.What = Kind::OutlineAgainstHole;
            problem.Loop = this->LoopOf[p];
          }
        }
        problem = MakeProblem(problem.What, problem.Domain, problem.Points, -1, problem.Loop);
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
    if (this->Figure.FrameIsDivided && this->AreUnrelated())
    {
      // A grid needs a frame of four corners.
      this->NeedsPlainFrame = true;
      return nullptr;
    }
    std::array<std::vector<Vector2>, 2> points;
    std::vector<std::array<int, 3>> triangles;
    if (!this->Proceed(0.3) ||
      (!(this->AreUnrelated() && this->FillGrid(points, triangles)) &&
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
    this->LoopOf.assign(this->Figure.Points[0].size(), -1);
    for (std::size_t i = 0; i < this->Figure.Loops.size(); ++i)
    {
      for (const int p : this->Figure.Loops[i])
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
    for (std::size_t i = 0; i < this->Figure.Loops.size(); ++i)
    {
      const auto& loop = this->Figure.Loops[i];
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
    for (int p = 0; p < static_cast<int>(this->Given); ++p)
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
    for (std::size_t i = 0; i < this->Lines.size(); ++i)
    {
      collect(this->Lines[i], static_cast<int>(i), false);
    }
    for (const auto& line : this->Figure.ClosedLines)
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
        for (const auto& chord : this->DissectFace(face))
        {
          this->Map->Add(walk[chord[0]], walk[chord[1]]);
        }
      }
    }
    return this->Proceed(0.45);
  }

  /// Large faces are usually the same in all orders.
  const std::vector<std::array<int, 2>>& DissectFace(const CommonMap::Face& face)
  {
    const PolygonPair polygons = this->Polygons(face);
    std::vector<double> key;
    for (const auto& polygon : polygons)
    {
      for (const Vector2& p : polygon)
      {
        key.insert(key.end(), { p.x, p.y });
      }
    }
    const auto [known, isNew] = this->Dissections.try_emplace(std::move(key));
    if (isNew)
    {
      known->second = Dissect(polygons, face.Triangles, this->Options.Quality);
    }
    return known->second;
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

  /// For points in frames whose positions have little to do with each other; false if the figure
  /// has other parts.
  bool FillGrid(
    std::array<std::vector<Vector2>, 2>& points, std::vector<std::array<int, 3>>& triangles) const
  {
    if (this->Figure.Loops.size() != 1 || this->Figure.Loops[0].size() != 4 ||
      !this->Segments.empty() || this->Result.NumberOfFramePoints != 4)
    {
      return false;
    }
    std::array<int, 4> corners;
    for (int k = 0; k < 4; ++k)
    {
      corners[k] = this->Vertex[this->Figure.Loops[0][k]];
    }
    constexpr int box = ConstrainedTriangulation::BoxCorners;
    points = { { this->Map->GetPoints(0), this->Map->GetPoints(1) } };
    for (auto& p : points)
    {
      p.resize(this->Order.size() + box);
    }
    std::vector<int> landmarks;
    for (int v = box; v < static_cast<int>(points[0].size()); ++v)
    {
      if (std::find(corners.begin(), corners.end(), v) == corners.end())
      {
        landmarks.push_back(v);
      }
    }
    return FillByGrid(corners, landmarks, points, triangles);
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
    const int given = static_cast<int>(this->Given);
    const int known = static_cast<int>(this->Figure.Points[0].size());
    auto& result = this->Result;
    result.Points = this->Figure.Points;
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

  const IsomorphicTriangulationOptions& Options;
  /// The number of points that are not the frame's.
  std::size_t Given;
  BoundedFigure Figure;
  const std::vector<std::vector<int>>& Lines;
  IsomorphicTriangulationResult Result;
  std::unique_ptr<PairMesh> Best;
  bool NeedsPlainFrame = false;
  bool Refused = false;
  /// Of faces by their corners' coordinates.
  std::map<std::vector<double>, std::vector<std::array<int, 2>>> Dissections;
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
  BoundaryOptions boundary{ options.Domain, options.Frames };
  for (const double margin : { 0.5, 1.5, 4.0 })
  {
    boundary.FrameMargin = margin;
    boundary.DividesFrame = true;
    auto builder = std::make_unique<Builder>(figure, options, boundary);
    bool made = builder->Prepare();
    if (builder->MayNeedPlainFrame())
    {
      boundary.DividesFrame = false;
      auto plain = std::make_unique<Builder>(figure, options, boundary);
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

} // namespace homeomorphism
