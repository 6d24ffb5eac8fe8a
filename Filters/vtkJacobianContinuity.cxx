// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkJacobianContinuity.h"

#include "Continuity/MeasuredFeatures.h"
#include "Pipeline/DiagnosticMessages.h"
#include "Pipeline/HomeomorphismCache.h"
#include "Pipeline/Options.h"
#include "Pipeline/PointBlocks.h"
#include "Pipeline/ProcessStatistics.h"
#include "Pipeline/Requests.h"

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
#include <iterator>
#include <vector>

using namespace homeomorphism;

vtkStandardNewMacro(vtkJacobianContinuity);

class vtkJacobianContinuity::Internals
{
public:
  /// The cache for the map of a transform, which has its own options.
  HomeomorphismCache Cache;
  /// Edges on the boundary, then features by type and verdict; the largest jump.
  ProcessStatistics Own{ std::vector<double>(1 + (VERTEX + 1) * (UNDECIDED + 1)), { 0.0 } };
};

namespace
{

using Sample = MeasuredFeatures::Sample;

static_assert(int(FeatureKind::Vertex) == vtkJacobianContinuity::VERTEX, "kinds of features");

/// Cell arrays, one value per feature.
class FeatureArrays
{
public:
  FeatureArrays(const MeasuredFeatures& features, bool secondDerivatives)
    : Features(features)
  {
    for (const char* name : { "JacobianJump", "JacobianJumpError", "JacobianJumpExact",
           "NormalJump", "TangentialJump", "AngleJump", "StretchJump", "ConvergenceOrder" })
    {
      this->AddDoubles(name);
    }
    this->Verdict = this->NewIntegers("Verdict");
    this->Type = this->NewIntegers("FeatureType");
    if (secondDerivatives)
    {
      this->AddDoubles("SecondDerivativeJump");
      this->AddDoubles("SecondDerivativeJumpError");
      this->SecondVerdict = this->NewIntegers("SecondDerivativeVerdict");
    }
    this->Triangles->SetName("EdgeTriangles");
    this->Triangles->SetNumberOfComponents(2);
    this->Triangles->SetNumberOfTuples(features.GetNumberOfFeatures());
  }

  /// @a samples are the measurements at the feature; empty if there is nothing to compare.
  void Set(vtkIdType index, const std::vector<Sample>& samples)
  {
    const MeasuredFeature& feature = this->Features.GetFeature(index);
    this->Type->SetValue(index, static_cast<int>(feature.Kind));
    const std::array<vtkIdType, 2> cells = this->Features.GetCells(feature);
    this->Triangles->SetTypedTuple(index, cells.data());
    this->Verdict->SetValue(index, vtkJacobianContinuity::NOTHING_TO_COMPARE);
    if (this->SecondVerdict)
    {
      this->SecondVerdict->SetValue(index, vtkJacobianContinuity::NOTHING_TO_COMPARE);
    }
    for (const auto& array : this->Doubles)
    {
      array->SetValue(index, JacobianJump::None);
    }
    if (!samples.empty())
    {
      this->SetMeasured(index, samples);
    }
  }

  double GetJump(vtkIdType feature) const { return this->Doubles[0]->GetValue(feature); }
  int GetVerdict(vtkIdType feature) const { return this->Verdict->GetValue(feature); }

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
    cellData->AddArray(this->Type);
    cellData->SetActiveScalars("JacobianJump");
  }

private:
  void SetMeasured(vtkIdType index, const std::vector<Sample>& samples)
  {
    const auto largest = [&samples](JacobianJump Sample::*which) {
      // NaN, which means that the map could not be evaluated, counts as the largest value.
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
      error =
        sample.First.Error > error || std::isnan(sample.First.Error) ? sample.First.Error : error;
      exact = std::max(exact, sample.Exact);
    }
    const double values[8] = { worst.First.Jump, error, exact, worst.First.Normal,
      worst.First.Tangential, vtkMath::DegreesFromRadians(worst.First.Angle), worst.First.Stretch,
      worst.First.Order };
    for (std::size_t i = 0; i < 8; ++i)
    {
      this->Doubles[i]->SetValue(index, values[i]);
    }
    this->Verdict->SetValue(index, Conclude(samples, &Sample::First));
    if (this->SecondVerdict && !MeasuredFeatures::IsPoint(this->Features.GetFeature(index).Kind))
    {
      const Sample worstSecond = largest(&Sample::Second);
      this->Doubles[8]->SetValue(index, worstSecond.Second.Jump);
      this->Doubles[9]->SetValue(index, worstSecond.Second.Error);
      this->SecondVerdict->SetValue(index, Conclude(samples, &Sample::Second));
    }
  }

  /// The feature is a crease if it is one at any sample, and differentiable if it is at all
  /// samples.
  static int Conclude(const std::vector<Sample>& samples, JacobianJump Sample::*which)
  {
    const auto count = [&samples, which](JumpVerdict verdict) {
      return std::count_if(samples.begin(), samples.end(),
        [&](const Sample& sample) { return (sample.*which).Verdict == verdict; });
    };
    if (count(JumpVerdict::Crease) > 0)
    {
      return vtkJacobianContinuity::CREASE;
    }
    return count(JumpVerdict::Undecided) > 0 ? vtkJacobianContinuity::UNDECIDED
                                             : vtkJacobianContinuity::DIFFERENTIABLE;
  }

  void AddDoubles(const char* name)
  {
    this->Doubles.push_back(vtkSmartPointer<vtkDoubleArray>::New());
    this->Doubles.back()->SetName(name);
    this->Doubles.back()->SetNumberOfTuples(this->Features.GetNumberOfFeatures());
  }

  vtkSmartPointer<vtkIntArray> NewIntegers(const char* name) const
  {
    auto array = vtkSmartPointer<vtkIntArray>::New();
    array->SetName(name);
    array->SetNumberOfTuples(this->Features.GetNumberOfFeatures());
    return array;
  }

  const MeasuredFeatures& Features;
  std::vector<vtkSmartPointer<vtkDoubleArray>> Doubles;
  vtkSmartPointer<vtkIntArray> Verdict;
  vtkSmartPointer<vtkIntArray> Type;
  vtkSmartPointer<vtkIntArray> SecondVerdict;
  vtkNew<vtkIdTypeArray> Triangles;
};

vtkSmartPointer<vtkDoubleArray> NewJumpArray(const char* name, vtkIdType tuples)
{
  auto array = vtkSmartPointer<vtkDoubleArray>::New();
  array->SetName(name);
  array->SetNumberOfTuples(tuples);
  array->FillValue(JacobianJump::None);
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
  this->vtkJacobianContinuity::SetTransform(nullptr);
}

void vtkJacobianContinuity::SetTransform(vtkAbstractTransform* transform)
{
  vtkSetObjectBodyMacro(Transform, vtkAbstractTransform, transform);
}

vtkMTimeType vtkJacobianContinuity::GetMTime()
{
  const vtkMTimeType own = this->Superclass::GetMTime();
  return this->Transform ? std::max(own, this->Transform->GetMTime()) : own;
}

vtkPolyData* vtkJacobianContinuity::GetOutput(int port)
{
  return vtkPolyData::SafeDownCast(this->GetOutputDataObject(port));
}

int vtkJacobianContinuity::FillInputPortInformation(int port, vtkInformation* info)
{
  if (port == 1)
  {
    info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  }
  return this->Superclass::FillInputPortInformation(port, info);
}

void vtkJacobianContinuity::ReduceStatistics(vtkMultiProcessController* controller)
{
  this->Superclass::ReduceStatistics(controller);
  const ProcessStatistics total = Total(this, this->Internal->Own, controller);
  this->NumberOfBoundaryEdges = static_cast<vtkIdType>(total.Sums[0]);
  std::transform(total.Sums.begin() + 1, total.Sums.end(), std::begin(this->Counts[0]),
    [](double count) { return static_cast<vtkIdType>(count); });
  this->LargestJump = total.Largest[0];
}

int vtkJacobianContinuity::Execute(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPolyData* source = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* target = vtkPolyData::GetData(inputs[1]);
  this->ResetStatistics();
  if (!this->Transform && !target)
  {
    vtkErrorMacro(<< "There is no map to measure: set a transform (SetTransform) or a target mesh "
                     "(input port 1).");
    return this->Fail(MESHES_REFUSED);
  }
  std::shared_ptr<const Homeomorphism> map;
  if (!this->Transform)
  {
    map = this->GetMap(source, target);
    if (!map)
    {
      return 0;
    }
  }
  else
  {
    this->Transform->Update();
    // If the transform is a homeomorphism of this very triangulation, the jumps have a closed form.
    // For other transforms, only the edges of the triangulation are needed.
    auto* ours = vtkHomeomorphismTransform::SafeDownCast(this->Transform);
    const bool known = ours && !ours->GetInverseFlag() && ours->GetTarget() && ours->GetSource() &&
      ours->GetSource()->GetPoints() == source->GetPoints() &&
      ours->GetSource()->GetPolys() == source->GetPolys();
    HomeomorphismOptions options = known ? GetOptions(ours) : HomeomorphismOptions{};
    if (!known)
    {
      options.System = homeomorphism::CoordinateSystem::Linear;
      options.MaskInvalidTriangles = this->MaskInvalidTriangles;
    }
    HomeomorphismCache& cache = this->Internal->Cache;
    map = cache.Get(source, known ? ours->GetTarget() : nullptr, options);
    ReportProblems(this, cache.GetProblems());
    if (!map)
    {
      return this->Fail(MESHES_REFUSED);
    }
    if (!map->GetPair().GetGeometry(Domain::Source).IsPlanar())
    {
      vtkErrorMacro(
        << "A transform is measured only on planar meshes. For a surface, set the target mesh "
           "(input port 1).");
      return this->Fail(MESHES_REFUSED);
    }
  }
  if (IsFirstPiece(request, outputs))
  {
    this->Measure(this, map, this->Transform, source, vtkPolyData::GetData(outputs, 0),
      vtkPolyData::GetData(outputs, 1));
  }
  return 1;
}

void vtkJacobianContinuity::ResetStatistics()
{
  this->NumberOfBoundaryEdges = 0;
  std::fill_n(&this->Counts[0][0], sizeof(this->Counts) / sizeof(this->Counts[0][0]), 0);
  this->LargestJump = 0.0;
  this->KeepStatistics();
}

/// Keeps the statistics of this process; ReduceStatistics replaces them by totals.
void vtkJacobianContinuity::KeepStatistics()
{
  ProcessStatistics& own = this->Internal->Own;
  own.Sums[0] = static_cast<double>(this->NumberOfBoundaryEdges);
  std::transform(std::cbegin(this->Counts[0]), std::cend(this->Counts[VERTEX]),
    own.Sums.begin() + 1, [](vtkIdType count) { return static_cast<double>(count); });
  own.Largest[0] = this->LargestJump;
}

bool vtkJacobianContinuity::Measure(vtkAlgorithm* algorithm,
  const std::shared_ptr<const Homeomorphism>& map, vtkAbstractTransform* transform,
  vtkPolyData* mesh, vtkPolyData* lines, vtkPolyData* colored)
{
  this->ResetStatistics();
  // A transform that is this map is evaluated relative to a local origin.
  const bool unknown = transform && !map->GetPair().HasTarget();
  const bool planar = map->GetPair().HasTarget()
    ? map->GetPair().GetGeometry(Domain::Source).IsColumnar()
    : map->GetPair().GetGeometry(Domain::Source).IsPlanar();
  const homeomorphism::CenterPoint center = map->GetCharts(Domain::Source).GetCenter();
  const MeasuredFeatures features(*map, center,
    { true, this->BoundaryEdges, this->Spokes, this->WingSegments, this->CenterSegments,
      this->StripBorders, this->Centroids, this->Vertices },
    planar, this->SamplesPerEdge);
  this->NumberOfBoundaryEdges =
    static_cast<vtkIdType>(features.GetEdges().GetBoundaryEdges().size());

  // The points of each feature follow those of the feature before it.
  const vtkIdType count = features.GetNumberOfFeatures();
  std::vector<vtkIdType> firstPoint(count + 1, 0);
  for (vtkIdType i = 0; i < count; ++i)
  {
    firstPoint[i + 1] = firstPoint[i] + features.GetNumberOfPoints(features.GetFeature(i).Kind);
  }
  const vtkIdType numberOfPoints = firstPoint[count];
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(numberOfPoints);
  const auto pointJump = NewJumpArray("JacobianJump", numberOfPoints);
  const auto pointError = NewJumpArray("JacobianJumpError", numberOfPoints);
  const auto pointExact = NewJumpArray("JacobianJumpExact", numberOfPoints);
  FeatureArrays featureArrays(features, this->SecondDerivatives);

  const vtkIdType done = RunInBlocks(
    algorithm, count, 0.05, 0.95,
    [&](vtkIdType begin, vtkIdType end) {
      std::vector<Sample> values;
      for (vtkIdType index = begin; index < end; ++index)
      {
        const MapUnderTest evaluate =
          unknown ? MakeMapUnderTest(transform, *map) : MakeMapUnderTest(*map);
        const MeasuredFeature& feature = features.GetFeature(index);
        const int samples = features.GetNumberOfSamples(feature.Kind);
        // A line's first point is its end, not a sample.
        const vtkIdType firstSample =
          firstPoint[index] + (MeasuredFeatures::IsPoint(feature.Kind) ? 0 : 1);
        values.clear();
        for (int i = 0; i < samples; ++i)
        {
          values.push_back(
            features.Measure(feature, i, evaluate, this->Resolution, this->SecondDerivatives));
          pointJump->SetValue(firstSample + i, values[i].First.Jump);
          pointError->SetValue(firstSample + i, values[i].First.Error);
          pointExact->SetValue(firstSample + i, values[i].Exact);
        }
        featureArrays.Set(index, values);
        for (vtkIdType i = firstPoint[index]; i < firstPoint[index + 1]; ++i)
        {
          points->SetPoint(
            i, features.GetPosition(feature, static_cast<int>(i - firstPoint[index])).data());
        }
      }
    },
    1 << 11);
  if (done < count)
  {
    // After an abort, do not output a part as if it were the whole result.
    return false;
  }

  vtkNew<vtkCellArray> vertexCells;
  vtkNew<vtkCellArray> lineCells;
  const auto triangleJump = NewJumpArray("JacobianJump", mesh->GetNumberOfCells());
  const auto vertexJump = NewJumpArray("JacobianJump", mesh->GetNumberOfPoints());
  for (vtkIdType index = 0; index < count; ++index)
  {
    const MeasuredFeature& feature = features.GetFeature(index);
    vtkCellArray* cells = MeasuredFeatures::IsPoint(feature.Kind) ? vertexCells : lineCells;
    cells->InsertNextCell(features.GetNumberOfPoints(feature.Kind));
    for (vtkIdType i = firstPoint[index]; i < firstPoint[index + 1]; ++i)
    {
      cells->InsertCellPoint(i);
    }
    const int verdict = featureArrays.GetVerdict(index);
    if (verdict >= 0)
    {
      ++this->Counts[int(feature.Kind)][verdict];
    }
    if (feature.Kind != FeatureKind::Edge)
    {
      continue;
    }
    const double jump = featureArrays.GetJump(index);
    // NaN values are ignored. The arrays are initialized with NaN.
    const auto raise = [jump](vtkDoubleArray* array, vtkIdType id) {
      array->SetValue(id, std::fmax(array->GetValue(id), jump));
    };
    for (const vtkIdType cell : features.GetCells(feature))
    {
      raise(triangleJump, cell);
    }
    for (const std::int32_t point : features.GetEdges().GetInteriorEdges()[feature.Item].Points)
    {
      raise(vertexJump, point);
    }
    this->LargestJump = std::fmax(this->LargestJump, jump);
  }
  lines->SetPoints(points);
  lines->SetVerts(vertexCells);
  lines->SetLines(lineCells);
  featureArrays.AddTo(lines->GetCellData());
  lines->GetPointData()->AddArray(pointJump);
  lines->GetPointData()->AddArray(pointError);
  lines->GetPointData()->AddArray(pointExact);

  colored->ShallowCopy(mesh);
  colored->GetCellData()->AddArray(triangleJump);
  colored->GetCellData()->SetActiveScalars("JacobianJump");
  colored->GetPointData()->AddArray(vertexJump);
  this->KeepStatistics();
  return true;
}

vtkIdType vtkJacobianContinuity::GetNumberOfFeatures(int featureType, int verdict)
{
  return featureType >= EDGE && featureType <= VERTEX && verdict >= DIFFERENTIABLE &&
      verdict <= UNDECIDED
    ? this->Counts[featureType][verdict]
    : 0;
}

void vtkJacobianContinuity::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Transform: " << this->Transform << "\n";
  os << indent << "SamplesPerEdge: " << this->SamplesPerEdge << "\n";
  os << indent << "Resolution: " << this->Resolution << "\n";
  os << indent << "SecondDerivatives: " << this->SecondDerivatives << "\n";
  os << indent << "BoundaryEdges: " << this->BoundaryEdges << "\n";
  os << indent << "Spokes: " << this->Spokes << "\n";
  os << indent << "WingSegments: " << this->WingSegments << "\n";
  os << indent << "CenterSegments: " << this->CenterSegments << "\n";
  os << indent << "StripBorders: " << this->StripBorders << "\n";
  os << indent << "Centroids: " << this->Centroids << "\n";
  os << indent << "Vertices: " << this->Vertices << "\n";
  os << indent << "NumberOfBoundaryEdges: " << this->NumberOfBoundaryEdges << "\n";
  os << indent << "NumberOfDifferentiableEdges: " << this->GetNumberOfDifferentiableEdges() << "\n";
  os << indent << "NumberOfCreases: " << this->GetNumberOfCreases() << "\n";
  os << indent << "NumberOfUndecidedEdges: " << this->GetNumberOfUndecidedEdges() << "\n";
  os << indent << "LargestJump: " << this->LargestJump << "\n";
}
