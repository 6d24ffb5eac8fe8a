// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkJacobianContinuity.h"

#include "EdgeCrossings.h"
#include "FilterSupport.h"
#include "Mesh/JacobianJump.h"

#include "vtkAbstractTransform.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkHomeomorphismTransform.h"
#include "vtkIdTypeArray.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <vector>

using namespace homeomorphism;

vtkStandardNewMacro(vtkJacobianContinuity);
vtkCxxSetObjectMacro(vtkJacobianContinuity, Transform, vtkAbstractTransform);

class vtkJacobianContinuity::Internals
{
public:
  HomeomorphismCache Cache;
};

namespace
{

/// What is known of one sample of an edge.
struct Sample
{
  JacobianJump First;
  JacobianJump Second;
  double Exact = JacobianJump::None;
};

/// Arrays of the lines' cells, one value an edge.
class EdgeArrays
{
public:
  explicit EdgeArrays(vtkIdType edges, bool secondDerivatives)
    : Edges(edges)
  {
    for (const char* name : { "JacobianJump", "JacobianJumpError", "JacobianJumpExact",
           "NormalJump", "TangentialJump", "AngleJump", "StretchJump", "ConvergenceOrder" })
    {
      this->AddDoubles(name);
    }
    this->Verdict = this->NewVerdict("Verdict");
    if (secondDerivatives)
    {
      this->AddDoubles("SecondDerivativeJump");
      this->AddDoubles("SecondDerivativeJumpError");
      this->SecondVerdict = this->NewVerdict("SecondDerivativeVerdict");
    }
    this->Triangles->SetName("EdgeTriangles");
    this->Triangles->SetNumberOfComponents(2);
    this->Triangles->SetNumberOfTuples(edges);
  }

  void Set(vtkIdType edge, const std::vector<Sample>& samples)
  {
    const auto largest = [&samples](JacobianJump Sample::*which) {
      // NaN, where the map could not be evaluated, counts as more than anything.
      return *std::max_element(
        samples.begin(), samples.end(), [which](const Sample& a, const Sample& b) {
          return (a.*which).Jump < (b.*which).Jump ||
            (std::isnan((b.*which).Jump) && !std::isnan((a.*which).Jump));
        });
    };
    const Sample worst = largest(&Sample::First);
    double error = 0.0;
    double exact = samples.front().Exact;
    for (const Sample& sample : samples)
    {
      error = sample.First.Error > error || std::isnan(sample.First.Error) ? sample.First.Error
                                                                          : error;
      exact = std::max(exact, sample.Exact);
    }
    const double values[8] = { worst.First.Jump, error, exact, worst.First.Normal,
      worst.First.Tangential, vtkMath::DegreesFromRadians(worst.First.Angle),
      worst.First.Stretch, worst.First.Order };
    for (std::size_t i = 0; i < 8; ++i)
    {
      this->Doubles[i]->SetValue(edge, values[i]);
    }
    this->Verdict->SetValue(edge, Conclude(samples, &Sample::First));
    if (this->SecondVerdict)
    {
      const Sample worstSecond = largest(&Sample::Second);
      this->Doubles[8]->SetValue(edge, worstSecond.Second.Jump);
      this->Doubles[9]->SetValue(edge, worstSecond.Second.Error);
      this->SecondVerdict->SetValue(edge, Conclude(samples, &Sample::Second));
    }
  }

  void SetTriangles(vtkIdType edge, vtkIdType first, vtkIdType second)
  {
    this->Triangles->SetTypedComponent(edge, 0, first);
    this->Triangles->SetTypedComponent(edge, 1, second);
  }

  double GetJump(vtkIdType edge) const { return this->Doubles[0]->GetValue(edge); }
  int GetVerdict(vtkIdType edge) const { return this->Verdict->GetValue(edge); }

  void AddTo(vtkCellData* cellData) const
  {
    for (const auto& array : this->Doubles)
    {
      cellData->AddArray(array);
    }
    cellData->AddArray(this->Verdict);
    if (this->SecondVerdict)
    {
      cellData->AddArray(this->SecondVerdict);
    }
    cellData->AddArray(this->Triangles);
    cellData->SetActiveScalars("JacobianJump");
  }

private:
  /// One kink makes the edge a kink; it is differentiable only if it is at all samples.
  static int Conclude(const std::vector<Sample>& samples, JacobianJump Sample::*which)
  {
    const auto count = [&samples, which](JumpVerdict verdict) {
      return std::count_if(samples.begin(), samples.end(),
        [&](const Sample& sample) { return (sample.*which).Verdict == verdict; });
    };
    if (count(JumpVerdict::Kink) > 0)
    {
      return vtkJacobianContinuity::KINK;
    }
    return count(JumpVerdict::Undecided) > 0 ? vtkJacobianContinuity::UNDECIDED
                                             : vtkJacobianContinuity::DIFFERENTIABLE;
  }

  void AddDoubles(const char* name)
  {
    this->Doubles.push_back(vtkSmartPointer<vtkDoubleArray>::New());
    this->Doubles.back()->SetName(name);
    this->Doubles.back()->SetNumberOfTuples(this->Edges);
  }

  vtkSmartPointer<vtkIntArray> NewVerdict(const char* name) const
  {
    auto array = vtkSmartPointer<vtkIntArray>::New();
    array->SetName(name);
    array->SetNumberOfTuples(this->Edges);
    return array;
  }

  vtkIdType Edges;
  std::vector<vtkSmartPointer<vtkDoubleArray>> Doubles;
  vtkSmartPointer<vtkIntArray> Verdict;
  vtkSmartPointer<vtkIntArray> SecondVerdict;
  vtkNew<vtkIdTypeArray> Triangles;
};

vtkSmartPointer<vtkDoubleArray> NewJumpArray(const char* name, vtkIdType tuples, double fill)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfTuples(tuples);
  array->FillValue(fill);
  return array;
}

} // namespace

vtkJacobianContinuity::vtkJacobianContinuity()
  : Internal(new Internals)
{
  this->SetNumberOfInputPorts(2);
  this->SetNumberOfOutputPorts(2);
}

vtkJacobianContinuity::~vtkJacobianContinuity()
{
  this->SetTransform(nullptr);
}

void vtkJacobianContinuity::SetSourceData(vtkPolyData* source)
{
  this->SetInputData(0, source);
}

void vtkJacobianContinuity::SetTargetData(vtkPolyData* target)
{
  this->SetInputData(1, target);
}

vtkMTimeType vtkJacobianContinuity::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->Transform ? std::max(own, this->Transform->GetMTime()) : own;
}

int vtkJacobianContinuity::FillInputPortInformation(int port, vtkInformation* info)
{
  info->Set(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkPolyData");
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return 1;
}

int vtkJacobianContinuity::RequestUpdateExtent(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector*)
{
  RequestWholeMesh(inputs[0]->GetInformationObject(0));
  RequestWholeMesh(inputs[1]->GetInformationObject(0));
  return 1;
}

int vtkJacobianContinuity::RequestData(
  vtkInformation*, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPolyData* source = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* target = vtkPolyData::GetData(inputs[1]);
  vtkPolyData* lines = vtkPolyData::GetData(outputs, 0);
  vtkPolyData* colored = vtkPolyData::GetData(outputs, 1);
  this->NumberOfBoundaryEdges = 0;
  this->NumberOfDifferentiableEdges = 0;
  this->NumberOfKinks = 0;
  this->NumberOfUndecidedEdges = 0;
  this->LargestJump = 0.0;

  if (!this->Transform && !target)
  {
    vtkErrorMacro(<< "There is no map to measure: set a transform (SetTransform) or a target mesh "
                     "(input port 1).");
    return 0;
  }
  HomeomorphismOptions options = GetOptions(this);
  auto* ours = vtkHomeomorphismTransform::SafeDownCast(this->Transform);
  if (this->Transform)
  {
    this->Transform->Update();
    // A homeomorphism of the very triangulation has a closed form; of another map's domain, only the
    // edges are wanted here.
    const bool known = ours && !ours->GetInverseFlag() && ours->GetTarget() && ours->GetSource() &&
      ours->GetSource()->GetPoints() == source->GetPoints();
    options = known ? GetOptions(ours) : HomeomorphismOptions{};
    target = known ? ours->GetTarget() : nullptr;
    if (!known)
    {
      options.System = homeomorphism::CoordinateSystem::Linear;
      options.MaskInvalidTriangles = this->MaskInvalidTriangles;
    }
  }
  const std::shared_ptr<const Homeomorphism> map =
    this->Internal->Cache.Get(source, target, options);
  ReportProblems(this, this->Internal->Cache.GetProblems());
  if (!map)
  {
    return 0;
  }
  if (this->Transform && !map->GetPair().GetEmbedding(Side::Source).IsPlanar())
  {
    vtkErrorMacro(<< "A transform is measured on a planar triangulation only. For a surface, give the "
                     "target mesh (input port 1).");
    return 0;
  }

  MapUnderTest evaluate;
  if (this->Transform)
  {
    vtkAbstractTransform* transform = this->Transform;
    evaluate = [transform](const Vector3& point, Vector3& image) {
      transform->InternalTransformPoint(point.data(), image.data());
      return true;
    };
  }
  else
  {
    const double reach = map->GetReach(Side::Source, 0.0, PrecisionOfType(VTK_DOUBLE));
    evaluate = [map, reach](const Vector3& point, Vector3& image) {
      const Location place = map->Locate(Side::Source, point.data(), reach, -1);
      if (place.Triangle < 0)
      {
        return false;
      }
      map->MapPoint(Side::Source, place, image.data());
      return true;
    };
  }

  const EdgeCrossings crossings(*map);
  this->NumberOfBoundaryEdges = crossings.GetNumberOfBoundaryEdges();
  const vtkIdType edges = crossings.GetNumberOfEdges();
  const int samples = this->SamplesPerEdge;
  const vtkIdType pointsPerEdge = samples + 2;
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(edges * pointsPerEdge);
  const auto pointJump =
    NewJumpArray("JacobianJump", edges * pointsPerEdge, JacobianJump::None);
  const auto pointError =
    NewJumpArray("JacobianJumpError", edges * pointsPerEdge, JacobianJump::None);
  const auto pointExact =
    NewJumpArray("JacobianJumpExact", edges * pointsPerEdge, JacobianJump::None);
  EdgeArrays edgeArrays(edges, this->SecondDerivatives);

  const vtkIdType done = RunInBlocks(
    this, edges, 0.05, 0.95,
    [&](vtkIdType begin, vtkIdType end) {
      std::vector<Sample> values(samples);
      for (vtkIdType edge = begin; edge < end; ++edge)
      {
        const InteriorEdge& interior = crossings.GetEdge(edge);
        for (int i = 0; i < samples; ++i)
        {
          const double t = (i + 1.0) / (samples + 1.0);
          const LineCrossing crossing = crossings.GetCrossing(edge, t, evaluate);
          Sample& sample = values[i];
          sample.First = EstimateJump(evaluate, crossing, 1, this->Resolution);
          sample.Exact = map->GetPair().HasTarget()
            ? crossings.GetExactJump(edge, crossing).Jump
            : JacobianJump::None;
          if (this->SecondDerivatives)
          {
            sample.Second = EstimateJump(evaluate, crossing, 2, 1e3 * this->Resolution);
          }
          const vtkIdType point = edge * pointsPerEdge + 1 + i;
          points->SetPoint(point, crossing.Point.data());
          pointJump->SetValue(point, sample.First.Jump);
          pointError->SetValue(point, sample.First.Error);
          pointExact->SetValue(point, sample.Exact);
        }
        points->SetPoint(edge * pointsPerEdge, interior.Start.data());
        points->SetPoint(edge * pointsPerEdge + samples + 1, interior.End.data());
        edgeArrays.Set(edge, values);
        edgeArrays.SetTriangles(edge, interior.Cells[0], interior.Cells[1]);
      }
    },
    1 << 12);
  if (done < edges)
  {
    // Aborted: nothing is better than a part that looks like the whole.
    return 1;
  }

  vtkNew<vtkCellArray> cells;
  const auto triangleJump = NewJumpArray("JacobianJump", source->GetNumberOfCells(), 0.0);
  const auto vertexJump = NewJumpArray("JacobianJump", source->GetNumberOfPoints(), 0.0);
  for (vtkIdType edge = 0; edge < edges; ++edge)
  {
    cells->InsertNextCell(static_cast<int>(pointsPerEdge));
    for (vtkIdType i = 0; i < pointsPerEdge; ++i)
    {
      cells->InsertCellPoint(edge * pointsPerEdge + i);
    }
    const InteriorEdge& interior = crossings.GetEdge(edge);
    const double jump = edgeArrays.GetJump(edge);
    const auto raise = [jump](vtkDoubleArray* array, vtkIdType id) {
      array->SetValue(id, std::max(array->GetValue(id), jump));
    };
    raise(triangleJump, interior.Cells[0]);
    raise(triangleJump, interior.Cells[1]);
    raise(vertexJump, interior.Points[0]);
    raise(vertexJump, interior.Points[1]);
    this->LargestJump = std::max(this->LargestJump, jump);
    const int verdict = edgeArrays.GetVerdict(edge);
    this->NumberOfDifferentiableEdges += verdict == DIFFERENTIABLE;
    this->NumberOfKinks += verdict == KINK;
    this->NumberOfUndecidedEdges += verdict == UNDECIDED;
  }
  lines->SetPoints(points);
  lines->SetLines(cells);
  edgeArrays.AddTo(lines->GetCellData());
  lines->GetPointData()->AddArray(pointJump);
  lines->GetPointData()->AddArray(pointError);
  lines->GetPointData()->AddArray(pointExact);

  colored->ShallowCopy(source);
  colored->GetCellData()->AddArray(triangleJump);
  colored->GetCellData()->SetActiveScalars("JacobianJump");
  colored->GetPointData()->AddArray(vertexJump);
  this->UpdateProgress(1.0);
  return 1;
}

void vtkJacobianContinuity::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Transform: " << this->Transform << "\n";
  os << indent << "CoordinateSystem: " << this->CoordinateSystem << "\n";
  os << indent << "CenterPoint: " << this->CenterPoint << "\n";
  os << indent << "DiscordantTriangles: " << this->DiscordantTriangles << "\n";
  os << indent << "MaskInvalidTriangles: " << this->MaskInvalidTriangles << "\n";
  os << indent << "SamplesPerEdge: " << this->SamplesPerEdge << "\n";
  os << indent << "Resolution: " << this->Resolution << "\n";
  os << indent << "SecondDerivatives: " << this->SecondDerivatives << "\n";
  os << indent << "NumberOfBoundaryEdges: " << this->NumberOfBoundaryEdges << "\n";
  os << indent << "NumberOfDifferentiableEdges: " << this->NumberOfDifferentiableEdges << "\n";
  os << indent << "NumberOfKinks: " << this->NumberOfKinks << "\n";
  os << indent << "NumberOfUndecidedEdges: " << this->NumberOfUndecidedEdges << "\n";
  os << indent << "LargestJump: " << this->LargestJump << "\n";
}
