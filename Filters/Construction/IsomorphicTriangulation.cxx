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

/// Larger faces are not dissected by an optimal set of common diagonals.
constexpr std::size_t LargestDissection = 2500;
/// Faces are dissected only if there are more than this many points per component. Otherwise the
/// edges that connect components leave too little choice.
constexpr std::size_t ConnectedShare = 10;
/// With more conflicting segments or more points, the first choice of the segments to leave out is
/// kept.
constexpr std::size_t ExchangedSegments = 20;
constexpr std::size_t ExchangedPoints = 3000;
/// In larger faces, not all pairs of corners are tried as diagonals.
constexpr std::size_t AllPairs = 700;
/// Larger faces are not filled by FillByDiagonals, which takes cubic time.
constexpr std::size_t ExactFill = 400;
/// Larger faces are divided before they are filled by an overlay.
constexpr std::size_t LargestOverlay = 300;
/// With more points, edges are tried in one order only.
constexpr std::size_t SeveralOrders = 20000;
/// The number of orders that are tried. If more than FewPoints have to be added, four are tried.
constexpr int Orders = 12;
constexpr int FewPoints = 4;
/// With more added points, another order would take long and change little.
constexpr int ManyPoints = 200;
/// The positions in the two domains are considered unrelated if common edges leave more than
/// Unrelated components, or more than UnrelatedFew that are also more than a fifth of the points.
constexpr int Unrelated = 70;
constexpr int UnrelatedFew = 20;
/// An angle that is not too thin for any quality, in degrees.
constexpr double Thin = 5.0;
/// If the smallest angle is below this, in degrees, it is enlarged before other qualities are
/// improved.
constexpr double VeryThin = 1.0;

/// Constructs the mesh from the checked figure. The points are sorted by their positions along a
/// Hilbert curve in the domain whose sorted coordinates come first. So the result depends neither
/// on the order of the landmarks nor on which domain is the source.
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

  /// Constructs the pair with the fewest added points of several attempts. Returns false if the
  /// figure is refused.
  bool Prepare()
  {
    if (!this->Result.Problems.empty())
    {
      return false;
    }
    this->ChooseOrder();
    this->ChooseSegments();
    // The order in which edges are tried can decide whether points have to be added.
    for (int order = 0; order < Orders; ++order)
    {
      std::unique_ptr<PairMesh> mesh = this->Construct(order);
      // If the numbers of added points are equal, the quality decides.
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

  /// Improves the pair according to the options and stores it in the result.
  void Finish()
  {
    PairMesh& mesh = *this->Best;
    JointOptimization optimization(mesh, this->KeepGoing(0.7));
    optimization.Flip();
    const int limit = this->Options.MaximumNumberOfAddedPoints;
    const int added = mesh.CountAdded();
    if (limit >= 0 && added > limit)
    {
      this->Refuse(Kind::PointLimit, -1, this->PointsNearAdded(mesh));
      this->Result.Problems.back().Count = added;
      return;
    }
    const int maximum = limit >= 0 ? limit : added + 100;
    if (this->Options.Quality == PairQuality::Concordance ||
      this->Options.Quality == PairQuality::NonObtuse)
    {
      // First use half of the points to enlarge the angles, if obtuse angles are to be avoided or
      // if triangles are too thin for the quality measure.
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

  /// Whether another order or frame could need fewer added points and should be tried.
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

  /// The point of the figure at a vertex of the map; -1 for an added vertex.
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

  /// Chooses which of the conflicting segments are left out: as few as possible, and such that few
  /// components remain separate, because joining them takes many points. The method is a greedy
  /// search: each segment that was left out is drawn first on trial, and the best choice is kept.
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
      std::size_t separate = 0;
      for (const CommonMap::Face& face : faces)
      {
        separate += face.Walks.size() - 1;
      }
      return { conflicting.size(), separate };
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

  /// Constructs a pair with only the necessary added points; returns null if that is impossible.
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
    // Until Finish, the smallest angle stands for Concordance and NonObtuse.
    auto mesh = std::make_unique<PairMesh>(points, triangles, fixed, firstAdded,
      this->Options.Quality == PairQuality::Distortion ? PairQuality::Distortion
                                                       : PairQuality::MinimumAngle);
    JointOptimization(*mesh, this->KeepGoing(0.6)).RemovePoints(this->Options.OptimizeAddedPoints);
    return mesh;
  }

  /// Returns a function that reports progress and returns whether to continue. Once the caller has
  /// stopped the work, it returns false without asking again.
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
    // Short segments first: of conflicting segments, short ones are more likely to be correct.
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

  /// Adds those candidates that connect different components.
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

  /// Results are stored, because large faces are usually the same in all orders.
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

  /// Triangulates points whose positions in the two frames are unrelated. Returns false if the
  /// figure has other parts than points and a frame with four corners, or if there is no grid.
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

  /// Points of the figure near the first added point.
  std::vector<int> PointsNearAdded(const PairMesh& mesh) const
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
  /// The dissections of faces, by the coordinates of their corners.
  std::map<std::vector<double>, std::vector<std::array<int, 2>>> Dissections;
  std::vector<int> LoopOf;

  /// The domain that comes first.
  int First = 0;
  /// The points in the order of the construction, and the vertex of each point.
  std::vector<int> Order;
  std::vector<int> Vertex;
  /// The coordinates in the order of the construction, the first domain first.
  std::array<std::vector<Vector2>, 2> Ordered;
  std::unique_ptr<CommonMap> Map;
  bool Stopped = false;
  std::vector<std::array<int, 2>> LoopEdges;
  std::vector<std::array<int, 2>> Segments;
  // Segments that could not be drawn because of others, and segments that are drawn first.
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
