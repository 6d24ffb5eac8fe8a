// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkIsomorphicTriangulation.h"

#include "Construction/IsomorphicTriangulation.h"
#include "Construction/LandmarkResiduals.h"
#include "Mesh/TriangulationPair.h"
#include "Pipeline/PointBlocks.h"
#include "Pipeline/Requests.h"

#include "vtkAbstractArray.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkErrorCode.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationIntegerKey.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkVariant.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <vector>

using namespace homeomorphism;

vtkStandardNewMacro(vtkIsomorphicTriangulation);

class vtkIsomorphicTriangulation::Internals
{
public:
  FigureProblems Problems;
  FigureProblems LeftOut;
  /// Cell ids of the figure's lines and loops.
  std::vector<vtkIdType> LineCells;
  std::vector<vtkIdType> LoopCells;
  std::vector<vtkIdType> Suspicious;
  /// Pedigree ids of the source's points.
  std::vector<std::string> Names;

  vtkIdType CellOf(const FigureProblem* problem) const
  {
    if (problem && problem->Line >= 0)
    {
      return this->LineCells[static_cast<std::size_t>(problem->Line)];
    }
    return problem && problem->Loop >= 0 ? this->LoopCells[static_cast<std::size_t>(problem->Loop)]
                                         : -1;
  }

  std::string MessageOf(const FigureProblem* problem) const
  {
    return problem ? problem->Message(this->Names) : "";
  }
};

namespace
{

using Point3 = std::array<double, 3>;

/// The plane of a figure. If it is parallel to two axes, their coordinates are used without
/// rounding. Coordinates in the plane are normalized as in MeshGeometry: they are multiplied by a
/// power of two that makes the largest of them close to 1.
class Plane
{
public:
  /// Returns the point farthest from the plane if the figure is not planar, else -1.
  vtkIdType Fit(vtkPolyData* figure)
  {
    const vtkIdType n = figure->GetNumberOfPoints();
    Point3 low;
    Point3 high;
    double largest = 0.0;
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
    std::vector<Point3> points(static_cast<std::size_t>(n));
    for (vtkIdType i = 0; i < n; ++i)
    {
      Point3& p = points[static_cast<std::size_t>(i)];
      figure->GetPoint(i, p.data());
      for (std::size_t k = 0; k < 3; ++k)
      {
        low[k] = std::min(low[k], p[k]);
        high[k] = std::max(high[k], p[k]);
        largest = std::isfinite(p[k]) ? std::max(largest, std::abs(p[k])) : largest;
      }
    }
    this->InverseScale = homeomorphism::PowerOfTwoNear(largest);
    this->Scale = 1.0 / this->InverseScale;
    low = Multiplied(low, this->Scale);
    high = Multiplied(high, this->Scale);
    for (Point3& p : points)
    {
      p = Multiplied(p, this->Scale);
    }
    for (const std::size_t axis : { 2, 0, 1 })
    {
      if (!(high[axis] - low[axis] > 0.0))
      {
        this->Origin = {};
        this->Origin[axis] = low[axis];
        this->X = {};
        this->Y = {};
        this->X[(axis + 1) % 3] = 1.0;
        this->Y[(axis + 2) % 3] = 1.0;
        return -1;
      }
    }
    // The axes are given by the point farthest from the first one, and the point farthest from the
    // line through both.
    this->Origin = points[0];
    const std::size_t far = this->Farthest(points, [&](const Point3& p) { return Norm(p); });
    this->X = Scaled(Subtract(points[far], this->Origin));
    const auto across = [&](const Point3& p) {
      const double along = Dot3(p, this->X);
      return Point3{ p[0] - along * this->X[0], p[1] - along * this->X[1],
        p[2] - along * this->X[2] };
    };
    const std::size_t side =
      this->Farthest(points, [&](const Point3& p) { return Norm(across(p)); });
    this->Y = Scaled(across(Subtract(points[side], this->Origin)));
    const auto beyond = [&](const Point3& p) {
      const Point3 q = across(p);
      const double along = Dot3(q, this->Y);
      return Norm(
        { q[0] - along * this->Y[0], q[1] - along * this->Y[1], q[2] - along * this->Y[2] });
    };
    const std::size_t off = this->Farthest(points, beyond);
    const double extent = Norm(Subtract(points[far], this->Origin));
    return beyond(Subtract(points[off], this->Origin)) <= 1e-6 * extent
      ? -1
      : static_cast<vtkIdType>(off);
  }

  Vector2 ToPlane(const Point3& p) const
  {
    const Point3 q = Subtract(Multiplied(p, this->Scale), this->Origin);
    return { Dot3(q, this->X), Dot3(q, this->Y) };
  }

  Point3 ToSpace(const Vector2& p) const
  {
    Point3 q = this->Origin;
    for (std::size_t k = 0; k < 3; ++k)
    {
      q[k] += p.x * this->X[k] + p.y * this->Y[k];
    }
    return Multiplied(q, this->InverseScale);
  }

  /// The ratio of normalized coordinates to those of the figure, and its inverse.
  double GetScale() const { return this->Scale; }
  double GetInverseScale() const { return this->InverseScale; }

private:
  static Point3 Multiplied(const Point3& a, double factor)
  {
    return { a[0] * factor, a[1] * factor, a[2] * factor };
  }
  static Point3 Subtract(const Point3& a, const Point3& b)
  {
    return { a[0] - b[0], a[1] - b[1], a[2] - b[2] };
  }
  static double Dot3(const Point3& a, const Point3& b)
  {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  static double Norm(const Point3& a) { return std::sqrt(Dot3(a, a)); }
  static Point3 Scaled(const Point3& a)
  {
    const double norm = Norm(a);
    return norm > 0.0 ? Point3{ a[0] / norm, a[1] / norm, a[2] / norm } : Point3{};
  }
  template <typename Measure>
  std::size_t Farthest(const std::vector<Point3>& points, Measure&& measure) const
  {
    std::size_t farthest = 0;
    double largest = -1.0;
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      const double distance = measure(Subtract(points[i], this->Origin));
      if (distance > largest)
      {
        largest = distance;
        farthest = i;
      }
    }
    return farthest;
  }

  Point3 Origin{};
  Point3 X{};
  Point3 Y{};
  double Scale = 1.0;
  double InverseScale = 1.0;
};

/// The points of cells; -1 for points that do not exist, because their ids are negative or at least
/// @a count.
std::vector<std::vector<int>> Cells(vtkCellArray* array, vtkIdType count)
{
  std::vector<std::vector<int>> cells;
  vtkNew<vtkIdList> ids;
  for (vtkIdType i = 0; i < array->GetNumberOfCells(); ++i)
  {
    array->GetCellAtId(i, ids);
    cells.emplace_back();
    for (vtkIdType k = 0; k < ids->GetNumberOfIds(); ++k)
    {
      const vtkIdType id = ids->GetId(k);
      cells.back().push_back(id >= 0 && id < count ? static_cast<int>(id) : -1);
    }
  }
  return cells;
}

/// Sorts the lines of a figure into loops, in which every point has two neighbors, and others.
void ReadCells(vtkPolyData* figure, FigurePair& pair, std::vector<vtkIdType>& lineCells,
  std::vector<vtkIdType>& loopCells)
{
  const vtkIdType n = figure->GetNumberOfPoints();
  const vtkIdType firstLine = figure->GetNumberOfVerts();
  const std::vector<std::vector<int>> lines = Cells(figure->GetLines(), n);
  std::map<int, std::vector<int>> neighbors;
  std::map<int, vtkIdType> cellOf;
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    for (std::size_t k = 0; k < lines[i].size(); ++k)
    {
      cellOf.emplace(lines[i][k], firstLine + static_cast<vtkIdType>(i));
      if (k > 0 && lines[i][k] != lines[i][k - 1])
      {
        neighbors[lines[i][k]].push_back(lines[i][k - 1]);
        neighbors[lines[i][k - 1]].push_back(lines[i][k]);
      }
    }
  }
  std::map<int, bool> inLoop;
  for (const auto& entry : neighbors)
  {
    if (inLoop.count(entry.first) != 0)
    {
      continue;
    }
    std::vector<int> component{ entry.first };
    inLoop[entry.first] = false;
    bool loop = true;
    for (std::size_t i = 0; i < component.size(); ++i)
    {
      const auto& next = neighbors[component[i]];
      loop = loop && next.size() == 2 && next[0] != next[1] && component[i] >= 0;
      for (const int v : next)
      {
        if (inLoop.emplace(v, false).second)
        {
          component.push_back(v);
        }
      }
    }
    if (!loop)
    {
      continue;
    }
    std::vector<int> walk;
    int previous = -1;
    for (int at = entry.first; walk.empty() || at != entry.first;)
    {
      walk.push_back(at);
      inLoop[at] = true;
      const auto& next = neighbors[at];
      const int to = next[0] != previous ? next[0] : next[1];
      previous = at;
      at = to;
    }
    pair.Loops.push_back(walk);
    loopCells.push_back(cellOf[entry.first]);
  }
  for (std::size_t i = 0; i < lines.size(); ++i)
  {
    if (lines[i].empty() || !inLoop[lines[i][0]])
    {
      pair.Lines.push_back(lines[i]);
      lineCells.push_back(firstLine + static_cast<vtkIdType>(i));
    }
  }
  vtkIdType polygon = firstLine + figure->GetNumberOfLines();
  for (const auto& corners : Cells(figure->GetPolys(), n))
  {
    pair.Loops.push_back(corners);
    loopCells.push_back(polygon++);
  }
}

bool HaveSameCells(vtkPolyData* source, vtkPolyData* target)
{
  const vtkIdType count = source->GetNumberOfPoints();
  return Cells(source->GetVerts(), count) == Cells(target->GetVerts(), count) &&
    Cells(source->GetLines(), count) == Cells(target->GetLines(), count) &&
    Cells(source->GetPolys(), count) == Cells(target->GetPolys(), count);
}

/// Whether the offsets of the cell arrays are valid.
bool IsSound(vtkPolyData* figure)
{
  return figure->GetVerts()->IsValid() && figure->GetLines()->IsValid() &&
    figure->GetPolys()->IsValid();
}

/// One of a list of problems. Null and an error if there is none with this number.
const FigureProblem* Find(vtkObject* self, const FigureProblems& problems, int number)
{
  if (number >= 0 && number < static_cast<int>(problems.size()))
  {
    return &problems[static_cast<std::size_t>(number)];
  }
  vtkErrorWithObjectMacro(
    self, << "There is no number " << number << " in a list of " << problems.size() << ".");
  return nullptr;
}

} // namespace

vtkIsomorphicTriangulation::vtkIsomorphicTriangulation()
  : Internal(new Internals)
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(4);
}

vtkIsomorphicTriangulation::~vtkIsomorphicTriangulation() = default;

void vtkIsomorphicTriangulation::SetSourceData(vtkPolyData* source)
{
  this->SetInputData(0, source);
}

void vtkIsomorphicTriangulation::SetTargetData(vtkPolyData* target)
{
  this->SetInputData(1, target);
}

int vtkIsomorphicTriangulation::FillInputPortInformation(int, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  info->Set(RequestedWhole(), 1);
  return 1;
}

int vtkIsomorphicTriangulation::RequestInformation(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  for (int port = 0; port < this->GetNumberOfOutputPorts(); ++port)
  {
    DescribeTimesInOutput(inputs, 2, outputs->GetInformationObject(port));
  }
  return 1;
}

int vtkIsomorphicTriangulation::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*)
{
  RequestWhole(inputs[0]->GetInformationObject(0));
  RequestWhole(inputs[1]->GetInformationObject(0));
  return 1;
}

int vtkIsomorphicTriangulation::RequestData(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  const std::array<vtkPolyData*, 2> figures{ { vtkPolyData::GetData(inputs[0]),
    vtkPolyData::GetData(inputs[1]) } };
  this->SetErrorCode(vtkErrorCode::NoError);
  *this->Internal = Internals();
  this->NumberOfAddedPoints = 0;
  Internals& internal = *this->Internal;
  vtkAbstractArray* names = figures[0]->GetPointData()->GetPedigreeIds();
  for (vtkIdType i = 0; names && i < names->GetNumberOfTuples(); ++i)
  {
    internal.Names.push_back(names->GetVariantValue(i).ToString());
  }
  const auto refuse = [&]() {
    std::string text;
    for (const FigureProblem& problem : internal.Problems)
    {
      text += (text.empty() ? "" : "\n") + problem.Message(internal.Names);
    }
    if (internal.Problems[0].What != FigureProblem::Kind::Aborted)
    {
      this->SetErrorCode(vtkErrorCode::UserError);
      vtkErrorMacro(<< text);
    }
    return internal.Problems[0].What == FigureProblem::Kind::Aborted ? 1 : 0;
  };
  const auto note = [&](FigureProblem::Kind kind, int domain, std::vector<int> points) {
    FigureProblem problem;
    problem.What = kind;
    problem.Domain = domain;
    problem.Points = std::move(points);
    internal.Problems.push_back(problem);
  };
  if (figures[0]->GetNumberOfPoints() > (1 << 28))
  {
    vtkErrorMacro(<< "There are more than 2^28 points.");
    return 0;
  }
  if (figures[0]->GetNumberOfPoints() != figures[1]->GetNumberOfPoints())
  {
    note(FigureProblem::Kind::PointCountsDiffer, -1, {});
    return refuse();
  }
  for (int d = 0; d < 2; ++d)
  {
    if (!IsSound(figures[static_cast<std::size_t>(d)]))
    {
      note(FigureProblem::Kind::BadCell, d, {});
      return refuse();
    }
  }
  if (!HaveSameCells(figures[0], figures[1]))
  {
    note(FigureProblem::Kind::CellsDiffer, -1, {});
    return refuse();
  }

  FigurePair figure;
  ReadCells(figures[0], figure, internal.LineCells, internal.LoopCells);
  std::array<Plane, 2> planes;
  const vtkIdType given = figures[0]->GetNumberOfPoints();
  for (std::size_t d = 0; d < 2; ++d)
  {
    const vtkIdType off = given > 0 ? planes[d].Fit(figures[d]) : -1;
    if (off >= 0)
    {
      note(FigureProblem::Kind::NotPlanar, static_cast<int>(d), { static_cast<int>(off) });
    }
    for (vtkIdType i = 0; i < given; ++i)
    {
      Point3 p;
      figures[d]->GetPoint(i, p.data());
      figure.Points[d].push_back(planes[d].ToPlane(p));
    }
  }
  if (!internal.Problems.empty())
  {
    return refuse();
  }
  if (!homeomorphism::IsFirstPiece(request, outputs))
  {
    return 1;
  }

  IsomorphicTriangulationOptions options;
  options.Domain = static_cast<FigureDomain>(this->Domain);
  options.Quality = static_cast<PairQuality>(this->Quality);
  options.MaximumNumberOfAddedPoints = this->MaximumNumberOfAddedPoints;
  options.TargetQuality = this->TargetMinimumAngle;
  options.MaximumTriangleSize = this->MaximumTriangleSize;
  options.OptimizeAddedPoints = this->OptimizeAddedPoints;
  options.LeaveOutConflictingSegments = this->LeaveOutConflictingSegments;
  options.Progress = [this](double progress) {
    this->UpdateProgress(progress);
    return !homeomorphism::ShouldAbort(this);
  };
  const double* s = this->SourceFrame;
  const double* t = this->TargetFrame;
  const bool hasSource = s[1] >= s[0] || s[3] >= s[2];
  const bool hasTarget = t[1] >= t[0] || t[3] >= t[2];
  if (hasSource || hasTarget)
  {
    for (int d = 0; d < 2; ++d)
    {
      const double* f = d == 0 ? s : t;
      if (!(f[1] > f[0] && f[3] > f[2]))
      {
        note(FigureProblem::Kind::BadFrame, d, {});
        return refuse();
      }
    }
    const auto corners = [&planes](std::size_t d, const double* f) {
      const double scale = planes[d].GetScale();
      return std::array<Vector2, 2>{ { scale * Vector2{ f[0], f[2] },
        scale * Vector2{ f[1], f[3] } } };
    };
    options.Frames = MatchRectangles(figure, corners(0, s), corners(1, t));
  }

  const IsomorphicTriangulationResult result = MakeIsomorphicTriangulation(figure, options);
  internal.LeftOut = result.LeftOut;
  internal.Problems = result.Problems;
  if (!result.IsComplete())
  {
    return refuse();
  }

  const auto numberOfPoints = static_cast<vtkIdType>(result.OriginalIds.size());
  vtkNew<vtkCellArray> triangles;
  for (const auto& corners : result.Triangles)
  {
    const vtkIdType ids[3] = { corners[0], corners[1], corners[2] };
    triangles->InsertNextCell(3, ids);
  }
  vtkNew<vtkCellArray> segments;
  for (const auto& ends : result.Segments)
  {
    const vtkIdType ids[2] = { ends[0], ends[1] };
    segments->InsertNextCell(2, ids);
  }
  vtkNew<vtkIdTypeArray> originals;
  originals->SetName("OriginalPointId");
  vtkNew<vtkDoubleArray> residuals;
  residuals->SetName("LandmarkResidual");
  const std::vector<double> measured = LandmarkResiduals(figure.Points);
  for (std::size_t i = 0; i < result.OriginalIds.size(); ++i)
  {
    originals->InsertNextValue(result.OriginalIds[i]);
    residuals->InsertNextValue(i < measured.size() ? measured[i] * planes[1].GetInverseScale()
                                                   : std::numeric_limits<double>::quiet_NaN());
  }
  internal.Suspicious.resize(measured.size());
  std::iota(internal.Suspicious.begin(), internal.Suspicious.end(), 0);
  const std::size_t listed = std::min<std::size_t>(measured.size(), 10);
  std::partial_sort(internal.Suspicious.begin(),
    internal.Suspicious.begin() + static_cast<std::ptrdiff_t>(listed), internal.Suspicious.end(),
    [&](vtkIdType a, vtkIdType b) {
      const double left = measured[static_cast<std::size_t>(a)];
      const double right = measured[static_cast<std::size_t>(b)];
      return left != right ? left > right : a < b;
    });
  internal.Suspicious.resize(listed);

  const PairQualities statistics = MeasureQualities(result.Points, result.Triangles);
  vtkNew<vtkDoubleArray> angles;
  angles->SetName("MinimumAngle");
  vtkNew<vtkDoubleArray> distortions;
  distortions->SetName("Distortion");
  for (std::size_t i = 0; i < result.Triangles.size(); ++i)
  {
    angles->InsertNextValue(statistics.MinimumAngles[i]);
    distortions->InsertNextValue(statistics.Distortions[i]);
  }

  std::array<vtkNew<vtkPolyData>, 2> meshes;
  for (std::size_t d = 0; d < 2; ++d)
  {
    vtkNew<vtkPoints> points;
    points->SetDataTypeToDouble();
    points->SetNumberOfPoints(numberOfPoints);
    for (vtkIdType i = 0; i < numberOfPoints; ++i)
    {
      Point3 p = planes[d].ToSpace(result.Points[d][static_cast<std::size_t>(i)]);
      if (i < given)
      {
        figures[d]->GetPoint(i, p.data());
      }
      points->SetPoint(i, p.data());
    }
    meshes[d]->SetPoints(points);
    meshes[d]->SetPolys(triangles);
    meshes[d]->GetPointData()->AddArray(originals);
    meshes[d]->GetPointData()->AddArray(residuals);
    meshes[d]->GetCellData()->AddArray(angles);
    meshes[d]->GetCellData()->AddArray(distortions);
  }
  MeshDiagnostics problems;
  if (!TriangulationPair::Read(meshes[0], meshes[1], false, problems))
  {
    // This is possible only by rounding, in the rotation of a figure into its plane.
    note(FigureProblem::Kind::Precision, -1, {});
    return refuse();
  }
  for (int d = 0; d < 2; ++d)
  {
    vtkPolyData* lines = vtkPolyData::GetData(outputs, d + 2);
    lines->SetPoints(meshes[static_cast<std::size_t>(d)]->GetPoints());
    lines->SetLines(segments);
    lines->GetPointData()->AddArray(originals);
    vtkPolyData::GetData(outputs, d)->ShallowCopy(meshes[static_cast<std::size_t>(d)]);
    this->SmallestAngles[d] = statistics.MinimumAngle[static_cast<std::size_t>(d)];
  }
  for (std::size_t k = 0; k < 3; ++k)
  {
    this->SharesOfSmallAngles[k] =
      std::max(statistics.SharesBelow[0][k], statistics.SharesBelow[1][k]);
  }
  this->NumberOfAddedPoints = result.NumberOfAddedPoints;
  this->ObtuseShare = statistics.ObtuseShare;
  this->DiscordantShare = statistics.DiscordantShare;
  this->LargestDistortion = statistics.LargestDistortion;
  this->LargestDistortionCell = statistics.LargestDistortionTriangle;
  this->Mirrored = result.Mirrored;
  this->UpdateProgress(1.0);
  return 1;
}

int vtkIsomorphicTriangulation::GetNumberOfProblems()
{
  return static_cast<int>(this->Internal->Problems.size());
}

int vtkIsomorphicTriangulation::GetProblemKind(int problem)
{
  const FigureProblem* found = Find(this, this->Internal->Problems, problem);
  return found ? static_cast<int>(found->What) : -1;
}

int vtkIsomorphicTriangulation::GetProblemDomain(int problem)
{
  const FigureProblem* found = Find(this, this->Internal->Problems, problem);
  return found ? found->Domain : -1;
}

void vtkIsomorphicTriangulation::GetProblemPoints(int problem, vtkIdList* points)
{
  points->Reset();
  const FigureProblem* found = Find(this, this->Internal->Problems, problem);
  for (std::size_t i = 0; found && i < found->Points.size(); ++i)
  {
    points->InsertNextId(found->Points[i]);
  }
}

vtkIdType vtkIsomorphicTriangulation::GetProblemCell(int problem)
{
  return this->Internal->CellOf(Find(this, this->Internal->Problems, problem));
}

int vtkIsomorphicTriangulation::GetProblemCount(int problem)
{
  const FigureProblem* found = Find(this, this->Internal->Problems, problem);
  return found ? found->Count : 0;
}

std::string vtkIsomorphicTriangulation::GetProblemMessage(int problem)
{
  return this->Internal->MessageOf(Find(this, this->Internal->Problems, problem));
}

int vtkIsomorphicTriangulation::GetNumberOfLeftOutSegments()
{
  return static_cast<int>(this->Internal->LeftOut.size());
}

vtkIdType vtkIsomorphicTriangulation::GetLeftOutCell(int segment)
{
  return this->Internal->CellOf(Find(this, this->Internal->LeftOut, segment));
}

std::string vtkIsomorphicTriangulation::GetLeftOutMessage(int segment)
{
  return this->Internal->MessageOf(Find(this, this->Internal->LeftOut, segment));
}

void vtkIsomorphicTriangulation::GetSuspiciousLandmarks(vtkIdList* points)
{
  points->Reset();
  for (const vtkIdType point : this->Internal->Suspicious)
  {
    points->InsertNextId(point);
  }
}

void vtkIsomorphicTriangulation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Domain: " << this->Domain << "\n";
  os << indent << "SourceFrame: " << this->SourceFrame[0] << ", " << this->SourceFrame[1] << ", "
     << this->SourceFrame[2] << ", " << this->SourceFrame[3] << "\n";
  os << indent << "TargetFrame: " << this->TargetFrame[0] << ", " << this->TargetFrame[1] << ", "
     << this->TargetFrame[2] << ", " << this->TargetFrame[3] << "\n";
  os << indent << "Quality: " << this->Quality << "\n";
  os << indent << "MaximumNumberOfAddedPoints: " << this->MaximumNumberOfAddedPoints << "\n";
  os << indent << "TargetMinimumAngle: " << this->TargetMinimumAngle << "\n";
  os << indent << "MaximumTriangleSize: " << this->MaximumTriangleSize << "\n";
  os << indent << "OptimizeAddedPoints: " << this->OptimizeAddedPoints << "\n";
  os << indent << "LeaveOutConflictingSegments: " << this->LeaveOutConflictingSegments << "\n";
  os << indent << "NumberOfAddedPoints: " << this->NumberOfAddedPoints << "\n";
  os << indent << "SmallestAngles: " << this->SmallestAngles[0] << ", " << this->SmallestAngles[1]
     << "\n";
  os << indent << "SharesOfSmallAngles: " << this->SharesOfSmallAngles[0] << ", "
     << this->SharesOfSmallAngles[1] << ", " << this->SharesOfSmallAngles[2] << "\n";
  os << indent << "ObtuseShare: " << this->ObtuseShare << "\n";
  os << indent << "DiscordantShare: " << this->DiscordantShare << "\n";
  os << indent << "LargestDistortion: " << this->LargestDistortion << "\n";
  os << indent << "LargestDistortionCell: " << this->LargestDistortionCell << "\n";
  os << indent << "Mirrored: " << this->Mirrored << "\n";
}
