// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Mesh/BendingSolve.h"

#include "Mesh/LeastBendingDerivatives.h"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <numeric>

namespace homeomorphism
{
namespace
{

constexpr int MaximumRounds = 120;
constexpr int MaximumProximalRounds = 20;
/// Proximal rounds end unless the energy falls below this share of the previous one.
constexpr double EnoughProgress = 0.998;
/// The divisors of the penalty's weights when a solution is certified: for elements that have
/// failed since the previous certified solution, and for others.
constexpr double CautiousRelaxation = 4.0;
constexpr double Relaxation = 64.0;
/// A coefficient of the determinant is treated as an active constraint if it exceeds the least
/// allowed one by less than this share of the template's coefficient.
constexpr double ActiveShare = 0.4;
/// The number of sweeps of coordinate descent that compute the multipliers of the constraints.
constexpr int MultiplierSweeps = 30;
/// If more than this share of the triangles fails in the first round, all triangles are cut at
/// once, which leads to less bending.
constexpr double CutAllShare = 0.05;
/// The number of failures after which a whole triangle, or the whole neighbors of a cut one, are
/// cut.
constexpr int FailuresBeforeCut = 3;
/// In elements of cut triangles that are thinner than this share of their triangle's size, bending
/// is not visible. It is weighted as if it were spread over this width.
constexpr double VisibleWidth = 0.05;
/// The maximum number of steps of conjugate gradients, and the relative residual that ends them.
constexpr int MaximumSteps = 1000;
constexpr double EnoughResidual = 1e-12;
/// The largest relative residual that is accepted if rounding prevents a smaller one.
constexpr double TolerableResidual = 1e-6;

Vector2 Normal(const Vector2& along)
{
  return { -along.y, along.x };
}

double Length(const Vector2& v)
{
  return std::sqrt(Dot(v, v));
}

/// A number that depends linearly on the unknowns, for both components of the map at once. The
/// components have the same coefficients and different constants.
struct LinearForm
{
  Vector2 Constant;
  std::vector<std::pair<int, double>> Terms;

  void Add(double factor, const LinearForm& other)
  {
    this->Constant = this->Constant + factor * other.Constant;
    for (const std::pair<int, double>& term : other.Terms)
    {
      this->Terms.emplace_back(term.first, factor * term.second);
    }
  }
};

/// Value and derivatives by x and y at a node.
struct NodeForms
{
  LinearForm Value;
  LinearForm ByX;
  LinearForm ByY;

  LinearForm Along(const Vector2& direction) const
  {
    LinearForm form;
    form.Add(direction.x, this->ByX);
    form.Add(direction.y, this->ByY);
    return form;
  }

  void SetGradient(
    const Vector2& tangent, const LinearForm& alongTangent, const LinearForm& alongNormal)
  {
    const Vector2 normal = Normal(tangent);
    this->ByX = {};
    this->ByX.Add(tangent.x, alongTangent);
    this->ByX.Add(normal.x, alongNormal);
    this->ByY = {};
    this->ByY.Add(tangent.y, alongTangent);
    this->ByY.Add(normal.y, alongNormal);
  }
};

LinearForm Constant(const Vector2& value)
{
  return { value, {} };
}

NodeForms Fixed(const BendingNode& node)
{
  return { Constant(node.Value), Constant(node.Gradient.ImageOfX),
    Constant(node.Gradient.ImageOfY) };
}

/// One element of the minimization.
struct Element
{
  int Triangle;
  /// The number in the cut, -1 for a whole triangle.
  int Number;
  std::array<int, 3> Nodes;
  double Omega = 0.0;
  /// The least allowed coefficient of the determinant.
  double LeastAllowed = 0.0;
  /// The least coefficient of the template.
  double OfTemplate = 0.0;
  bool Failed = false;
  /// How often it has failed since the last certified solution.
  int Failures = 0;
  /// The share of the element's bending that is minimized, and the matrix of that share.
  double Weight = 1.0;
  BendingMatrix Bending{};
  /// The force of the constraints on the element, see Solver::UpdateConstraintForce.
  std::array<Vector2, 9> ConstraintForce{};
  /// Whether doubles cannot represent even the template's element, so that its triangle cannot be
  /// certified.
  bool IsUncertifiable = false;
};

double GetDoubledArea(const std::array<Vector2, 3>& points)
{
  return Cross(points[1] - points[0], points[2] - points[0]);
}

/// The height over the longest edge.
double GetThickness(const CubicElement& element)
{
  const std::array<Vector2, 3>& points = element.Points;
  const double longest = std::max({ Length(points[1] - points[0]), Length(points[2] - points[1]),
    Length(points[0] - points[2]) });
  // The legs of a thin element are more accurate than its area.
  const RightAngle& right = element.Right;
  return (right.Corner >= 0 ? right.AlongTangent * right.AlongNormal : GetDoubledArea(points)) /
    longest;
}

/// The matrix of the penalty: of the squared distance of an element's data from the center of the
/// penalty.
BendingMatrix GetPenaltyMatrix(const std::array<Vector2, 3>& points)
{
  BendingMatrix penalty{};
  for (int i = 0; i < 3; ++i)
  {
    penalty[3 * i + 1][3 * i + 1] = 1.0;
    penalty[3 * i + 2][3 * i + 2] = 1.0;
  }
  for (int k = 0; k < 3; ++k)
  {
    const int i = 3 * NextCorner(k);
    const int j = 3 * PreviousCorner(k);
    const Vector2 edge = points[j / 3] - points[i / 3];
    const double weight = 1.0 / Dot(edge, edge);
    penalty[i][i] += weight;
    penalty[j][j] += weight;
    penalty[i][j] -= weight;
    penalty[j][i] -= weight;
  }
  return penalty;
}

class Solver
{
public:
  Solver(const CubicTemplate& cubicTemplate, const BendingOptions& options,
    const std::vector<std::uint8_t>& isFree, const ParallelFor& parallelFor)
    : Template(cubicTemplate)
    , Pair(cubicTemplate.GetPair())
    , Options(options)
    , IsFree(isFree)
    , Parallel(parallelFor)
    , Fans(this->Pair)
    , IsCut(this->Pair.Triangles.size(), 0)
    , Failures(this->Pair.Triangles.size(), 0)
  {
  }

  BendingSolution Run();
  bool SolveWhole(BendingSolution& solution);

private:
  enum NodeKind : std::int8_t
  {
    PointNode,
    EdgeNode,
    InnerNode
  };
  struct Node
  {
    NodeKind Kind;
    /// A point, or the triangle that made the node.
    int Owner;
    /// The node's number in the triangle's cut.
    int Number;
    /// Whether the node is on an edge of a whole triangle, so that the ends of the edge determine
    /// its data.
    bool IsHanging = false;
    /// The center of the penalty, from which it measures distances, and the last solution.
    BendingNode Center;
    BendingNode Current;
    /// The largest weight of the penalty in an element of the node.
    double Omega = 0.0;
  };

  bool IsSpecial(int point) const
  {
    return this->Template.GetKind(point) != VertexKind::Differentiable;
  }
  bool IsFreePoint(int point) const { return !this->IsFree.empty() && this->IsFree[point] != 0; }

  void FindBoundary();
  void Build();
  void MakeForms();
  NodeForms MakeEdgeForms(int number);
  void Assemble();
  bool SolveSystem();
  int Check(bool rigorous);
  void MoveCenter();
  void UpdateConstraintForce(Element& element) const;
  double GetEnergy(bool isWeighted) const;
  void CutTriangle(int triangle) { this->IsCut[triangle] = 1; }
  BendingNode GetTemplateNode(int triangle, const TriangleCut& cut, int node) const;
  CubicElement GetElement(const Element& element, bool atCenter) const;
  void GetVector(const Element& element, bool atCenter, std::array<Vector2, 9>& v) const;
  std::array<Vector2, 9> GetPenaltyCenter(const Element& element) const;
  LinearForm Unknown() { return { {}, { { this->NumberOfUnknowns++, 1.0 } } }; }
  BendingSolution Extract() const;

  const CubicTemplate& Template;
  const PlanarPair& Pair;
  const BendingOptions& Options;
  const std::vector<std::uint8_t>& IsFree;
  const ParallelFor& Parallel;
  const PointFans Fans;
  LargeVector<std::uint8_t> IsCut;
  LargeVector<int> Failures;
  std::map<int, BoundaryPoint> Boundary;
  std::vector<Node> Nodes;
  std::vector<NodeForms> Forms;
  std::vector<Element> Elements;
  /// The nodes of each cut triangle.
  std::map<int, std::array<int, TriangleCut::NumberOfNodes>> CutNodes;
  int NumberOfUnknowns = 0;
  /// Whether the sparsity pattern of the matrix is known for the present nodes, and the position of
  /// each contribution among the matrix entries.
  bool PatternIsKnown = false;
  std::vector<std::int32_t> EntryPositions;
  Eigen::SparseMatrix<double> Matrix;
  Eigen::Matrix<double, Eigen::Dynamic, 2> Right;
  Eigen::Matrix<double, Eigen::Dynamic, 2> Solution;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> Cholesky;
  BendingStatistics Statistics;
  bool Proximal = false;
};

//------------------------------------------------------------------------------
void Solver::FindBoundary()
{
  for (int t = 0; t < this->Pair.GetNumberOfTriangles(); ++t)
  {
    for (int k = 0; k < 3; ++k)
    {
      if (this->Pair.Neighbors[t][k] >= 0)
      {
        continue;
      }
      // The boundary runs counterclockwise: this edge leaves its start and arrives at its end.
      const int ends[2] = { this->Pair.Triangles[t][NextCorner(k)],
        this->Pair.Triangles[t][PreviousCorner(k)] };
      for (const int end : ends)
      {
        if (!this->IsSpecial(end))
        {
          this->Boundary[end];
        }
      }
    }
  }
  for (auto& entry : this->Boundary)
  {
    const int point = entry.first;
    BoundaryPoint& boundary = entry.second;
    const PointFan fan = this->Fans.Get(this->Pair, point);
    const int first = fan.Triangles.front();
    const int last = fan.Triangles.back();
    const int next = this->Pair.Triangles[first][NextCorner(this->Pair.GetCorner(first, point))];
    const int before =
      this->Pair.Triangles[last][PreviousCorner(this->Pair.GetCorner(last, point))];
    const Vector2 out = this->Pair.Source[next] - this->Pair.Source[point];
    const Vector2 in = this->Pair.Source[before] - this->Pair.Source[point];
    const Vector2 imageOfOut = this->Pair.Target[next] - this->Pair.Target[point];
    const Vector2 imageOfIn = this->Pair.Target[before] - this->Pair.Target[point];
    const double outLength = Length(out);
    const double inLength = Length(in);
    boundary.Straight = this->Template.IsStraight(point);
    boundary.Tangent = (1.0 / outLength) * out;
    if (boundary.Straight)
    {
      // The weighted harmonic mean of the two edges' slopes keeps cubics along them monotone
      // (Fritsch, Butland 1984).
      const double first_ = Length(imageOfOut) / outLength;
      const double second = Length(imageOfIn) / inLength;
      const double w = 2.0 * inLength + outLength;
      const double v = inLength + 2.0 * outLength;
      const double slope = (w + v) / (w / first_ + v / second);
      boundary.Slope = (slope / Length(imageOfOut)) * imageOfOut;
    }
    else
    {
      boundary.Derivative = FitBoundary(this->Template.GetFan(point, fan));
    }
  }
}

//------------------------------------------------------------------------------
BendingNode Solver::GetTemplateNode(int triangle, const TriangleCut& cut, int node) const
{
  return { {},
    this->Template.GetAffine(triangle) +
      this->Template.GetGradient(cut, this->Template.GetAffine(triangle), triangle, node) };
}

//------------------------------------------------------------------------------
void Solver::Build()
{
  // Nodes and elements that remain keep their data.
  std::map<std::pair<int, int>, Node> oldNodes;
  std::map<std::pair<int, int>, Element> oldElements;
  const std::size_t points = this->Pair.Source.size();
  std::vector<Node> oldPoints;
  if (!this->Nodes.empty())
  {
    oldPoints.assign(
      this->Nodes.begin(), this->Nodes.begin() + static_cast<std::ptrdiff_t>(points));
    for (std::size_t n = points; n < this->Nodes.size(); ++n)
    {
      oldNodes[{ this->Nodes[n].Owner, this->Nodes[n].Number }] = this->Nodes[n];
    }
    for (const Element& element : this->Elements)
    {
      oldElements[{ element.Triangle, element.Number }] = element;
    }
  }
  this->Nodes.clear();
  this->Elements.clear();
  this->CutNodes.clear();
  this->PatternIsKnown = false;
  for (int point = 0; point < static_cast<int>(points); ++point)
  {
    Node node{ PointNode, point, 0, false, {}, {}, 0.0 };
    if (oldPoints.empty())
    {
      node.Center.Gradient = this->Template.GetDerivative(point);
      node.Current = node.Center;
    }
    else
    {
      node = oldPoints[point];
    }
    this->Nodes.push_back(node);
  }
  for (int t = 0; t < this->Pair.GetNumberOfTriangles(); ++t)
  {
    const std::array<std::int32_t, 3>& corners = this->Pair.Triangles[t];
    if (!this->IsCut[t])
    {
      Element element{ t, -1, { corners[0], corners[1], corners[2] } };
      const auto old = oldElements.find({ t, -1 });
      if (old != oldElements.end())
      {
        element = old->second;
      }
      else
      {
        element.OfTemplate = this->Template.GetAffine(t).Determinant();
        element.LeastAllowed = this->Options.CertificateMargin * element.OfTemplate;
      }
      this->Elements.push_back(element);
      continue;
    }
    const TriangleCut cut = this->Template.GetCut(t);
    std::array<int, TriangleCut::NumberOfNodes> nodes;
    std::copy(corners.begin(), corners.end(), nodes.begin());
    for (int n = 3; n < TriangleCut::NumberOfNodes; ++n)
    {
      const int k = (n < 9 ? n - 3 : n - 9) / 2;
      const int neighbor = this->Pair.Neighbors[t][k];
      if (n < 9 && neighbor >= 0 && neighbor < t && this->IsCut[neighbor])
      {
        // The neighbor traverses the edge in the other direction.
        const int edge = this->Pair.GetSharedEdge(neighbor, t);
        nodes[n] = this->CutNodes[neighbor][3 + 2 * edge + (n % 2 == 1 ? 1 : 0)];
        continue;
      }
      Node node{ n < 9 ? EdgeNode : InnerNode, t, n, false, {}, {}, 0.0 };
      const auto old = oldNodes.find({ t, n });
      if (old != oldNodes.end())
      {
        node = old->second;
      }
      else
      {
        node.Center = this->GetTemplateNode(t, cut, n);
        node.Current = node.Center;
      }
      node.IsHanging = n < 9 && neighbor >= 0 && !this->IsCut[neighbor];
      nodes[n] = static_cast<int>(this->Nodes.size());
      this->Nodes.push_back(node);
    }
    this->CutNodes[t] = nodes;
    for (int e = 0; e < TriangleCut::NumberOfElements; ++e)
    {
      if (e < TriangleCut::FirstStrip && this->IsSpecial(corners[e / 3]))
      {
        continue;
      }
      const std::array<std::uint8_t, 3>& numbers = TriangleCut::Elements[e];
      Element element{ t, e, { nodes[numbers[0]], nodes[numbers[1]], nodes[numbers[2]] } };
      const auto old = oldElements.find({ t, e });
      if (old != oldElements.end())
      {
        const std::array<int, 3> renumbered = element.Nodes;
        element = old->second;
        element.Nodes = renumbered;
      }
      else
      {
        const CubicElement own = this->Template.GetElement(cut, this->Template.GetAffine(t), t, e);
        const DeterminantCoefficients c = GetDeterminantCoefficients(own);
        element.OfTemplate = *std::min_element(c.begin(), c.end());
        element.LeastAllowed = this->Options.CertificateMargin * element.OfTemplate;
        element.IsUncertifiable = !(LeastDeterminant(own) > 0.0);
      }
      this->Elements.push_back(element);
    }
  }
  this->Parallel(
    static_cast<std::int64_t>(this->Elements.size()), [this](std::int64_t begin, std::int64_t end) {
      for (std::int64_t e = begin; e < end; ++e)
      {
        Element& element = this->Elements[e];
        const CubicElement cubic = this->GetElement(element, false);
        element.Bending = GetBendingMatrix(cubic.Points);
        element.Weight = 1.0;
        if (element.Number >= 0)
        {
          const double width =
            VisibleWidth * std::sqrt(GetDoubledArea(this->Pair.GetSourceCorners(element.Triangle)));
          const double share = GetThickness(cubic) / width;
          element.Weight = share > 0.0 ? std::min(1.0, share) : 1.0;
          for (std::array<double, 9>& row : element.Bending)
          {
            for (double& entry : row)
            {
              entry *= element.Weight;
            }
          }
        }
      }
    });
}

//------------------------------------------------------------------------------
CubicElement Solver::GetElement(const Element& element, bool atCenter) const
{
  const int t = element.Triangle;
  CubicElement result;
  result.Affine = this->Template.GetAffine(t);
  if (element.Number < 0)
  {
    result.Points = this->Pair.GetSourceCorners(t);
  }
  else
  {
    const TriangleCut cut = this->Template.GetCut(t);
    for (int i = 0; i < 3; ++i)
    {
      result.Points[i] = cut.GetNode(
        TriangleCut::Elements[element.Number][i], TriangleCut::GetOrigin(element.Number));
    }
  }
  for (int i = 0; i < 3; ++i)
  {
    const Node& node = this->Nodes[element.Nodes[i]];
    const BendingNode& data = atCenter ? node.Center : node.Current;
    result.Values[i] = data.Value;
    result.Gradients[i] = data.Gradient - this->Template.GetAffine(t);
  }
  if (element.Number >= 0)
  {
    this->Template.GetCut(t).SetRightAngle(element.Number, result);
  }
  return result;
}

//------------------------------------------------------------------------------
// The forms of a node on an edge, from those of the edge's ends.
NodeForms Solver::MakeEdgeForms(int number)
{
  const Node& node = this->Nodes[number];
  const int t = node.Owner;
  const int k = (node.Number - 3) / 2;
  const int a = this->Pair.Triangles[t][NextCorner(k)];
  const int b = this->Pair.Triangles[t][PreviousCorner(k)];
  const bool atEnd = (node.Number - 3) % 2 == 1;
  const bool boundary = this->Pair.Neighbors[t][k] < 0;
  if (this->IsSpecial(atEnd ? b : a))
  {
    return Fixed(node.Center);
  }
  if (!node.IsHanging && !boundary)
  {
    return { this->Unknown(), this->Unknown(), this->Unknown() };
  }
  const TriangleCut cut = this->Template.GetCut(t);
  const double length = cut.Lengths[k];
  const Vector2 along = cut.Along[k];
  const Vector2 slope = this->Template.GetAffine(t) * along;
  // The part of the edge on which the map is one cubic. At an end that keeps the template, it
  // begins at the edge point.
  double start = 0.0;
  double end = length;
  NodeForms first = this->Forms[a];
  NodeForms last = this->Forms[b];
  if (this->IsSpecial(a))
  {
    start = this->Template.GetRadius(a);
    first = Fixed(this->Nodes[this->CutNodes[t][3 + 2 * k]].Center);
  }
  if (this->IsSpecial(b))
  {
    end = length - this->Template.GetRadius(b);
    last = Fixed(this->Nodes[this->CutNodes[t][4 + 2 * k]].Center);
  }
  const double span = end - start;
  const double at = atEnd ? length - this->Template.GetRadius(b) : this->Template.GetRadius(a);
  const double s = (at - start) / span;
  LinearForm firstSlope = first.Along(along);
  LinearForm lastSlope = last.Along(along);
  firstSlope.Add(-1.0, Constant(slope));
  lastSlope.Add(-1.0, Constant(slope));
  NodeForms forms;
  forms.Value.Add((1.0 + 2.0 * s) * (1.0 - s) * (1.0 - s), first.Value);
  forms.Value.Add(s * (1.0 - s) * (1.0 - s) * span, firstSlope);
  forms.Value.Add(s * s * (3.0 - 2.0 * s), last.Value);
  forms.Value.Add(-s * s * (1.0 - s) * span, lastSlope);
  LinearForm tangential = Constant(slope);
  tangential.Add(-6.0 * s * (1.0 - s) / span, first.Value);
  tangential.Add(6.0 * s * (1.0 - s) / span, last.Value);
  tangential.Add((1.0 - s) * (1.0 - 3.0 * s), firstSlope);
  tangential.Add(s * (3.0 * s - 2.0), lastSlope);
  if (node.IsHanging)
  {
    LinearForm normal;
    normal.Add(1.0 - s, first.Along(Normal(along)));
    normal.Add(s, last.Along(Normal(along)));
    forms.SetGradient(along, tangential, normal);
    return forms;
  }
  // On the boundary the cubic is prescribed: the larger the weight, the closer to the node's
  // center.
  const double share = 1.0 / (1.0 + node.Omega);
  forms.Value = Constant(node.Center.Value + share * (forms.Value.Constant - node.Center.Value));
  const Vector2 center = node.Center.Gradient * along;
  forms.SetGradient(
    along, Constant(center + share * (tangential.Constant - center)), this->Unknown());
  return forms;
}

//------------------------------------------------------------------------------
void Solver::MakeForms()
{
  for (Node& node : this->Nodes)
  {
    node.Omega = 0.0;
  }
  for (const Element& element : this->Elements)
  {
    // At first, the center of a whole triangle is its affine map, which does not apply to the
    // boundary.
    if (element.Number >= 0 || this->Proximal)
    {
      for (int node : element.Nodes)
      {
        this->Nodes[node].Omega = std::max(this->Nodes[node].Omega, element.Omega);
      }
    }
  }
  this->NumberOfUnknowns = 0;
  this->Forms.assign(this->Nodes.size(), {});
  const int points = this->Pair.GetNumberOfPoints();
  for (int point = 0; point < points; ++point)
  {
    NodeForms& forms = this->Forms[point];
    const Node& node = this->Nodes[point];
    const auto boundary = this->Boundary.find(point);
    if (this->IsSpecial(point))
    {
      continue;
    }
    if (boundary == this->Boundary.end())
    {
      if (this->IsFreePoint(point))
      {
        forms.Value = this->Unknown();
      }
      forms.ByX = this->Unknown();
      forms.ByY = this->Unknown();
      continue;
    }
    const double share = 1.0 / (1.0 + node.Omega);
    if (boundary->second.Straight)
    {
      const Vector2 center = node.Center.Gradient * boundary->second.Tangent;
      forms.SetGradient(boundary->second.Tangent,
        Constant(center + share * (boundary->second.Slope - center)), this->Unknown());
    }
    else
    {
      const Matrix2 gradient =
        node.Center.Gradient + share * (boundary->second.Derivative - node.Center.Gradient);
      forms.ByX = Constant(gradient.ImageOfX);
      forms.ByY = Constant(gradient.ImageOfY);
    }
  }
  for (std::size_t n = static_cast<std::size_t>(points); n < this->Nodes.size(); ++n)
  {
    const Node& node = this->Nodes[n];
    if (node.Kind == EdgeNode)
    {
      this->Forms[n] = this->MakeEdgeForms(static_cast<int>(n));
      continue;
    }
    const int k = (node.Number - 9) / 2;
    const int corner = (node.Number - 9) % 2 == 1 ? PreviousCorner(k) : NextCorner(k);
    if (this->IsSpecial(this->Pair.Triangles[node.Owner][corner]))
    {
      this->Forms[n] = Fixed(node.Center);
    }
    else
    {
      this->Forms[n] = { this->Unknown(), this->Unknown(), this->Unknown() };
    }
  }
}

//------------------------------------------------------------------------------
void Solver::GetVector(const Element& element, bool atCenter, std::array<Vector2, 9>& v) const
{
  const Matrix2& affine = this->Template.GetAffine(element.Triangle);
  for (int i = 0; i < 3; ++i)
  {
    const Node& node = this->Nodes[element.Nodes[i]];
    const BendingNode& data = atCenter ? node.Center : node.Current;
    v[3 * i] = data.Value;
    v[3 * i + 1] = data.Gradient.ImageOfX - affine.ImageOfX;
    v[3 * i + 2] = data.Gradient.ImageOfY - affine.ImageOfY;
  }
}

//------------------------------------------------------------------------------
// The data from which the penalty measures the distance of an element: at first, those of the
// affine map in a whole triangle.
std::array<Vector2, 9> Solver::GetPenaltyCenter(const Element& element) const
{
  std::array<Vector2, 9> center{};
  if (element.Number >= 0 || this->Proximal)
  {
    this->GetVector(element, true, center);
  }
  return center;
}

//------------------------------------------------------------------------------
void Solver::Assemble()
{
  // The order of the contributions is fixed, so later assemblies add them at the positions that the
  // first one has found.
  std::vector<Eigen::Triplet<double>> triplets;
  std::size_t entry = 0;
  const bool isKnown = this->PatternIsKnown;
  if (isKnown)
  {
    std::fill_n(this->Matrix.valuePtr(), this->Matrix.nonZeros(), 0.0);
  }
  this->Right.setZero(this->NumberOfUnknowns, 2);
  for (const Element& element : this->Elements)
  {
    BendingMatrix matrix = element.Bending;
    std::array<Vector2, 9> constants;
    const LinearForm* forms[9];
    const Matrix2& affine = this->Template.GetAffine(element.Triangle);
    for (int i = 0; i < 3; ++i)
    {
      const NodeForms& node = this->Forms[element.Nodes[i]];
      forms[3 * i] = &node.Value;
      forms[3 * i + 1] = &node.ByX;
      forms[3 * i + 2] = &node.ByY;
      constants[3 * i] = node.Value.Constant;
      constants[3 * i + 1] = node.ByX.Constant - affine.ImageOfX;
      constants[3 * i + 2] = node.ByY.Constant - affine.ImageOfY;
    }
    // Half the gradient of the objective if all unknowns are 0: bending times the constants, plus
    // the penalty times their distance from the center, minus the force of the constraints.
    std::array<Vector2, 9> force{};
    for (int m = 0; m < 9; ++m)
    {
      for (int n = 0; n < 9; ++n)
      {
        force[m] = force[m] + matrix[m][n] * constants[n];
      }
    }
    if (element.Omega > 0.0)
    {
      const std::array<Vector2, 9> center = this->GetPenaltyCenter(element);
      const BendingMatrix penalty = GetPenaltyMatrix(this->GetElement(element, true).Points);
      for (int m = 0; m < 9; ++m)
      {
        force[m] = force[m] - element.ConstraintForce[m];
        for (int n = 0; n < 9; ++n)
        {
          const double weight = element.Omega * penalty[m][n];
          matrix[m][n] += weight;
          force[m] = force[m] + weight * (constants[n] - center[n]);
        }
      }
    }
    for (int m = 0; m < 9; ++m)
    {
      for (const std::pair<int, double>& row : forms[m]->Terms)
      {
        this->Right(row.first, 0) -= row.second * force[m].x;
        this->Right(row.first, 1) -= row.second * force[m].y;
        for (int n = 0; n < 9; ++n)
        {
          for (const std::pair<int, double>& column : forms[n]->Terms)
          {
            if (row.first < column.first)
            {
              continue;
            }
            const double value = row.second * column.second * matrix[m][n];
            if (isKnown)
            {
              this->Matrix.valuePtr()[this->EntryPositions[entry++]] += value;
            }
            else
            {
              triplets.emplace_back(row.first, column.first, value);
            }
          }
        }
      }
    }
  }
  if (isKnown)
  {
    return;
  }
  this->Matrix.resize(this->NumberOfUnknowns, this->NumberOfUnknowns);
  this->Matrix.setFromTriplets(triplets.begin(), triplets.end());
  this->EntryPositions.resize(triplets.size());
  for (std::size_t n = 0; n < triplets.size(); ++n)
  {
    const int* rows = this->Matrix.innerIndexPtr();
    const int* columns = this->Matrix.outerIndexPtr();
    const int column = triplets[n].col();
    this->EntryPositions[n] = static_cast<std::int32_t>(
      std::lower_bound(rows + columns[column], rows + columns[column + 1], triplets[n].row()) -
      rows);
  }
}

//------------------------------------------------------------------------------
// Returns false if the system cannot be solved in double precision.
bool Solver::SolveSystem()
{
  this->MakeForms();
  if (this->NumberOfUnknowns > 0)
  {
    const bool isNew = !this->PatternIsKnown;
    this->Assemble();
    this->PatternIsKnown = true;
    if (this->NumberOfUnknowns <= this->Options.DirectUnknowns)
    {
      if (isNew)
      {
        this->Cholesky.analyzePattern(this->Matrix);
      }
      this->Cholesky.factorize(this->Matrix);
      if (this->Cholesky.info() != Eigen::Success)
      {
        return false;
      }
      this->Solution = this->Cholesky.solve(this->Right);
    }
    else
    {
      Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower,
        Eigen::IncompleteCholesky<double, Eigen::Lower, Eigen::NaturalOrdering<int>>>
        gradients;
      gradients.setTolerance(EnoughResidual);
      gradients.setMaxIterations(MaximumSteps);
      gradients.compute(this->Matrix);
      if (this->Solution.rows() != this->NumberOfUnknowns)
      {
        this->Solution.setZero(this->NumberOfUnknowns, 2);
      }
      for (int component = 0; component < 2; ++component)
      {
        const Eigen::VectorXd guess = this->Solution.col(component);
        this->Solution.col(component) = gradients.solveWithGuess(this->Right.col(component), guess);
        if (!(gradients.error() <= TolerableResidual))
        {
          return false;
        }
      }
    }
  }
  if (!this->Solution.allFinite())
  {
    // The system overflows if triangles are extremely thin.
    return false;
  }
  ++this->Statistics.Rounds;
  const auto evaluate = [this](const LinearForm& form) {
    Vector2 value = form.Constant;
    for (const std::pair<int, double>& term : form.Terms)
    {
      value.x += term.second * this->Solution(term.first, 0);
      value.y += term.second * this->Solution(term.first, 1);
    }
    return value;
  };
  for (std::size_t n = 0; n < this->Nodes.size(); ++n)
  {
    if (this->Nodes[n].Kind == PointNode && this->IsSpecial(this->Nodes[n].Owner))
    {
      continue;
    }
    this->Nodes[n].Current = { evaluate(this->Forms[n].Value),
      { evaluate(this->Forms[n].ByX), evaluate(this->Forms[n].ByY) } };
  }
  return true;
}

//------------------------------------------------------------------------------
// Marks the elements that fail and returns the number of triangles with such elements. Unless the
// check is @a rigorous, rounding is considered only if coefficients are close to the limit.
int Solver::Check(bool rigorous)
{
  this->Parallel(static_cast<std::int64_t>(this->Elements.size()),
    [this, rigorous](std::int64_t begin, std::int64_t end) {
      for (std::int64_t e = begin; e < end; ++e)
      {
        Element& element = this->Elements[e];
        const CubicElement cubic = this->GetElement(element, false);
        bool isCertain = false;
        if (!rigorous)
        {
          const DeterminantCoefficients c = GetDeterminantCoefficients(cubic);
          isCertain = *std::min_element(c.begin(), c.end()) > 1.001 * element.LeastAllowed;
        }
        element.Failed = !element.IsUncertifiable &&
          (!(isCertain ||
             LeastDeterminant(cubic, element.LeastAllowed, 4) >= element.LeastAllowed) ||
            (this->Options.MaximumDeviation < std::numeric_limits<double>::max() &&
              !(GreatestDisplacement(cubic) <= this->Options.MaximumDeviation)));
      }
    });
  int failed = 0;
  int last = -1;
  for (const Element& element : this->Elements)
  {
    if (element.Failed && element.Triangle != last)
    {
      last = element.Triangle;
      ++failed;
    }
  }
  return failed;
}

//------------------------------------------------------------------------------
// Updates the multipliers of the augmented Lagrangian (Hestenes 1969, Powell 1969). The penalty
// exerts a force on an element. The part of it that keeps small coefficients of the determinant
// from decreasing remains as a constant force when the weight is reduced. So the element can move
// along the boundary of the certified maps without being pressed against it. This part is the
// nonnegative combination of the coefficients' gradients that is nearest to the force.
void Solver::UpdateConstraintForce(Element& element) const
{
  if (!(element.Omega > 0.0) || element.IsUncertifiable)
  {
    return;
  }
  const CubicElement cubic = this->GetElement(element, false);
  const BendingMatrix penalty = GetPenaltyMatrix(cubic.Points);
  const std::array<Vector2, 9> center = this->GetPenaltyCenter(element);
  std::array<Vector2, 9> now;
  this->GetVector(element, false, now);
  // The components of the force, in units in which the diagonal of the penalty is 1.
  std::array<double, 18> residual;
  std::array<double, 18> unit;
  for (int m = 0; m < 9; ++m)
  {
    Vector2 force = element.ConstraintForce[m];
    for (int n = 0; n < 9; ++n)
    {
      force = force - (element.Omega * penalty[m][n]) * (now[n] - center[n]);
    }
    const double scale = 1.0 / std::sqrt(penalty[m][m]);
    unit[2 * m] = scale;
    unit[2 * m + 1] = scale;
    residual[2 * m] = scale * force.x;
    residual[2 * m + 1] = scale * force.y;
  }
  element.ConstraintForce = {};
  const DeterminantCoefficients coefficients = GetDeterminantCoefficients(cubic);
  std::array<int, 45> active;
  int count = 0;
  for (int c = 0; c < 45; ++c)
  {
    if (coefficients[c] < element.LeastAllowed + ActiveShare * element.OfTemplate)
    {
      active[count++] = c;
    }
  }
  if (count == 0)
  {
    return;
  }
  const bool isCut = element.Number >= 0;
  const TriangleCut cut = isCut ? this->Template.GetCut(element.Triangle) : TriangleCut{};
  // The coefficients are quadratic functions, so their central differences are exact derivatives.
  std::array<std::array<double, 18>, 45> gradients;
  const double size = std::sqrt(cubic.Affine.Determinant());
  for (int d = 0; d < 18; ++d)
  {
    DeterminantCoefficients beside[2];
    for (int side = 0; side < 2; ++side)
    {
      CubicElement moved = cubic;
      const int corner = d / 6;
      Vector2& v = d / 2 % 3 == 0
        ? moved.Values[corner]
        : (d / 2 % 3 == 1 ? moved.Gradients[corner].ImageOfX : moved.Gradients[corner].ImageOfY);
      (d % 2 == 0 ? v.x : v.y) += (side == 0 ? -size : size) * unit[d];
      if (isCut)
      {
        cut.SetRightAngle(element.Number, moved);
      }
      beside[side] = GetDeterminantCoefficients(moved);
    }
    for (int n = 0; n < count; ++n)
    {
      gradients[n][d] = (beside[1][active[n]] - beside[0][active[n]]) / (2.0 * size);
    }
  }
  const auto product = [](const std::array<double, 18>& a, const std::array<double, 18>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  };
  std::array<double, 45> multipliers{};
  std::array<double, 45> norms;
  for (int n = 0; n < count; ++n)
  {
    norms[n] = product(gradients[n], gradients[n]);
  }
  for (int sweep = 0; sweep < MultiplierSweeps; ++sweep)
  {
    for (int n = 0; n < count; ++n)
    {
      if (!(norms[n] > 0.0))
      {
        continue;
      }
      const double next =
        std::max(0.0, multipliers[n] + product(gradients[n], residual) / norms[n]);
      const double step = next - multipliers[n];
      multipliers[n] = next;
      for (int d = 0; d < 18; ++d)
      {
        residual[d] -= step * gradients[n][d];
      }
    }
  }
  for (int n = 0; n < count; ++n)
  {
    if (multipliers[n] > 0.0)
    {
      for (int d = 0; d < 18; ++d)
      {
        Vector2& force = element.ConstraintForce[d / 2];
        (d % 2 == 0 ? force.x : force.y) += multipliers[n] * gradients[n][d] / unit[d];
      }
    }
  }
}

//------------------------------------------------------------------------------
void Solver::MoveCenter()
{
  for (Node& node : this->Nodes)
  {
    node.Center = node.Current;
  }
  this->Proximal = true;
}

//------------------------------------------------------------------------------
double Solver::GetEnergy(bool isWeighted) const
{
  double energy = 0.0;
  for (const Element& element : this->Elements)
  {
    std::array<Vector2, 9> v;
    const double share = isWeighted ? 1.0 : 1.0 / element.Weight;
    this->GetVector(element, false, v);
    for (int m = 0; m < 9; ++m)
    {
      for (int n = 0; n < 9; ++n)
      {
        energy += share * element.Bending[m][n] * Dot(v[m], v[n]);
      }
    }
  }
  return energy;
}

//------------------------------------------------------------------------------
BendingSolution Solver::Extract() const
{
  BendingSolution solution;
  solution.Cuts.assign(this->Pair.Triangles.size(), -1);
  for (int point = 0; point < this->Pair.GetNumberOfPoints(); ++point)
  {
    solution.Points.push_back(this->Nodes[point].Current);
  }
  for (const auto& entry : this->CutNodes)
  {
    solution.Cuts[entry.first] = static_cast<std::int32_t>(solution.CutNodes.size());
    solution.CutNodes.emplace_back();
    const TriangleCut cut = this->Template.GetCut(entry.first);
    bool same = true;
    for (int n = 0; n < TriangleCut::NumberOfNodes; ++n)
    {
      const BendingNode& node = this->Nodes[entry.second[n]].Current;
      if (n >= 3)
      {
        solution.CutNodes.back()[n - 3] = node;
      }
      const Matrix2 own = this->GetTemplateNode(entry.first, cut, n).Gradient;
      same = same && SquaredNorm(node.Gradient - own) <= 1e-6 * SquaredNorm(own);
    }
    ++solution.Statistics.CutTriangles;
    solution.Statistics.TemplateTriangles += same ? 1 : 0;
  }
  solution.Statistics.Energy = this->GetEnergy(false);
  return solution;
}

//------------------------------------------------------------------------------
bool Solver::SolveWhole(BendingSolution& solution)
{
  const int triangles = this->Pair.GetNumberOfTriangles();
  const std::size_t count = this->Pair.Source.size();
  for (int point = 0; point < static_cast<int>(count); ++point)
  {
    // A point without triangles has no fan.
    if (this->Fans.Touching[point] != 0 || (this->Fans.First[point] >= 0 && this->IsSpecial(point)))
    {
      return false;
    }
  }
  this->FindBoundary();
  solution.Nets = LargeArray<CubicNet>(static_cast<std::size_t>(triangles));
  double energy;
  {
    const LeastBendingDerivatives derivatives = FindLeastBendingDerivatives(this->Template,
      this->Fans, this->Boundary,
      LargeScratch(solution.Nets.begin(), solution.Nets.size() * sizeof(CubicNet)), this->Parallel);
    energy = derivatives.Energy;
    solution.Points.resize(count);
    for (std::size_t point = 0; point < count; ++point)
    {
      solution.Points[point] = { {}, derivatives.AtPoints[point] };
    }
  }
  solution.Cuts.assign(static_cast<std::size_t>(triangles), -1);
  solution.Certificates.resize(static_cast<std::size_t>(triangles));
  std::atomic<bool> isCertified{ true };
  this->Parallel(triangles, [&](std::int64_t begin, std::int64_t end) {
    for (int t = static_cast<int>(begin); t < end; ++t)
    {
      const Matrix2& affine = this->Template.GetAffine(t);
      const CubicElement element = solution.GetWhole(this->Pair, affine, t);
      const double determinant = affine.Determinant();
      const double margin = this->Options.CertificateMargin * determinant;
      const double least = LeastDeterminant(element, margin, 4);
      if (!(least >= margin) ||
        (this->Options.MaximumDeviation < std::numeric_limits<double>::max() &&
          !(GreatestDisplacement(element) <= this->Options.MaximumDeviation)))
      {
        isCertified = false;
        return;
      }
      solution.Nets[t] = CubicNet(element);
      solution.Certificates[t] = least / determinant;
    }
  });
  if (!isCertified)
  {
    solution = {};
    return false;
  }
  solution.Statistics.Rounds = 1;
  solution.Statistics.Energy = energy;
  return true;
}

//------------------------------------------------------------------------------
BendingSolution Solver::Run()
{
  this->FindBoundary();
  for (int t = 0; t < this->Pair.GetNumberOfTriangles(); ++t)
  {
    for (int point : this->Pair.Triangles[t])
    {
      if (this->IsSpecial(point))
      {
        this->CutTriangle(t);
      }
    }
  }
  BendingSolution best;
  this->Build();
  double bestEnergy = std::numeric_limits<double>::infinity();
  for (int round = 0; round < MaximumRounds; ++round)
  {
    if (!this->SolveSystem())
    {
      break;
    }
    int failed = this->Check(false);
    failed = failed == 0 ? this->Check(true) : failed;
    if (failed == 0)
    {
      const double energy = this->GetEnergy(true);
      const bool isConverged = !(energy < EnoughProgress * bestEnergy);
      if (energy < bestEnergy)
      {
        bestEnergy = energy;
        best = this->Extract();
        this->Statistics.MinimizedEnergies.push_back(energy);
      }
      const bool hasPenalty = std::any_of(this->Elements.begin(), this->Elements.end(),
        [](const Element& element) { return element.Omega > 0.0; });
      if (isConverged || !hasPenalty || this->Statistics.ProximalRounds == MaximumProximalRounds)
      {
        break;
      }
      ++this->Statistics.ProximalRounds;
      this->Parallel(static_cast<std::int64_t>(this->Elements.size()),
        [this](std::int64_t begin, std::int64_t end) {
          for (std::int64_t e = begin; e < end; ++e)
          {
            Element& element = this->Elements[e];
            this->UpdateConstraintForce(element);
            element.Omega /= element.Failures > 0 ? CautiousRelaxation : Relaxation;
            element.Failures = 0;
          }
        });
      this->MoveCenter();
      continue;
    }
    bool rebuild = false;
    if (round == 0 && failed > CutAllShare * this->Pair.GetNumberOfTriangles())
    {
      for (int t = 0; t < this->Pair.GetNumberOfTriangles(); ++t)
      {
        this->CutTriangle(t);
      }
      rebuild = true;
    }
    else
    {
      int counted = -1;
      for (Element& element : this->Elements)
      {
        if (!element.Failed)
        {
          continue;
        }
        const int t = element.Triangle;
        const bool whole = element.Number < 0;
        // In proximal rounds, the factor doubles with each failure.
        const double factor = 4.0 * (this->Proximal ? std::exp2(element.Failures) : 1.0);
        ++element.Failures;
        element.Omega = std::max(factor * element.Omega, whole && !this->Proximal ? 0.5 : 0.1);
        if (counted == t || this->Proximal)
        {
          continue;
        }
        counted = t;
        if (++this->Failures[t] < FailuresBeforeCut)
        {
          continue;
        }
        this->Failures[t] = 0;
        if (whole)
        {
          this->CutTriangle(t);
          rebuild = true;
          continue;
        }
        for (int neighbor : this->Pair.Neighbors[t])
        {
          if (neighbor >= 0 && !this->IsCut[neighbor])
          {
            this->CutTriangle(neighbor);
            rebuild = true;
          }
        }
      }
    }
    if (rebuild)
    {
      this->Build();
    }
  }
  if (!std::isfinite(bestEnergy))
  {
    // With growing weights, the solutions approach the template. Use it if the rounds are used up
    // or a system could not be solved.
    std::fill(this->IsCut.begin(), this->IsCut.end(), std::uint8_t(1));
    this->Nodes.clear();
    this->Elements.clear();
    this->Build();
    best = this->Extract();
    best.Statistics.TookTemplate = true;
  }
  best.Statistics.Rounds = this->Statistics.Rounds;
  best.Statistics.ProximalRounds = this->Statistics.ProximalRounds;
  best.Statistics.MinimizedEnergies = this->Statistics.MinimizedEnergies;
  return best;
}

} // anonymous namespace

//------------------------------------------------------------------------------
CubicElement BendingSolution::GetWhole(
  const PlanarPair& pair, const Matrix2& affine, int triangle) const
{
  CubicElement element;
  element.Points = pair.GetSourceCorners(triangle);
  element.Affine = affine;
  for (int i = 0; i < 3; ++i)
  {
    const BendingNode& node = this->Points[pair.Triangles[triangle][i]];
    element.Values[i] = node.Value;
    element.Gradients[i] = node.Gradient - affine;
  }
  return element;
}

//------------------------------------------------------------------------------
CubicElement BendingSolution::GetElement(const PlanarPair& pair, const TriangleCut& cut,
  const Matrix2& affine, int triangle, int element) const
{
  CubicElement result;
  result.Affine = affine;
  for (int i = 0; i < 3; ++i)
  {
    const int number = TriangleCut::Elements[element][i];
    const BendingNode node = this->GetNode(pair, triangle, number);
    result.Points[i] = cut.GetNode(number, TriangleCut::GetOrigin(element));
    result.Values[i] = node.Value;
    result.Gradients[i] = node.Gradient - affine;
  }
  cut.SetRightAngle(element, result);
  return result;
}

//------------------------------------------------------------------------------
bool SolveWithWholeTriangles(const CubicTemplate& cubicTemplate, const BendingOptions& options,
  BendingSolution& solution, const ParallelFor& parallelFor)
{
  return Solver(cubicTemplate, options, {}, parallelFor).SolveWhole(solution);
}

//------------------------------------------------------------------------------
BendingSolution SolveForLeastBending(const CubicTemplate& cubicTemplate,
  const BendingOptions& options, const std::vector<std::uint8_t>& isFree,
  const ParallelFor& parallelFor)
{
  return Solver(cubicTemplate, options, isFree, parallelFor).Run();
}

} // namespace homeomorphism
