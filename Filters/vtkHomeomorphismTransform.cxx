// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkHomeomorphismTransform.h"

#include "Pipeline/AttributeTransformation.h"
#include "Pipeline/DiagnosticMessages.h"
#include "Pipeline/HomeomorphismCache.h"
#include "Pipeline/MappedRow.h"
#include "Pipeline/Options.h"
#include "Pipeline/PointBlocks.h"

#include "vtkDataArray.h"
#include "vtkMath.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <type_traits>

using namespace homeomorphism;

vtkStandardNewMacro(vtkHomeomorphismTransform);

class vtkHomeomorphismTransform::Internals
{
public:
  /// The surface point of a point whose coordinates were stored with a relative error.
  SurfacePoint Locate(
    Domain from, const double point[3], double precision, TriangleIndex hint) const
  {
    return this->Map ? this->Map->Locate(from, point,
                         this->Map->GetAbsoluteTolerance(from, this->Tolerance, precision), hint)
                     : SurfacePoint{};
  }

  /// Maps a point. If callers request the points of a row one by one, the row is mapped in blocks.
  template <typename Real>
  void MapPoint(Domain from, const Real in[3], Real out[3]) const
  {
    const double point[3] = { in[0], in[1], in[2] };
    thread_local const auto row = std::make_unique<MappedRow>();
    const std::uint64_t key =
      4 * this->Version + 2 * std::uint64_t(from) + std::uint64_t(std::is_same_v<Real, double>);
    const int i =
      !this->Map ? -1 : row->Find(point, key, [this, from](PointBlock& block, LocationHint& hint) {
        this->Map->LocateBlock(from, block, this->GetTolerance<Real>(from), hint);
        this->Map->MapBlock(from, block);
        // The thread's block must not keep a map after the transform has released it.
        block.PreparedCubics.reset();
        block.Cubic.reset();
      });
    if (i < 0)
    {
      this->MapPoint(from, in, out, nullptr);
      return;
    }
    double image[3];
    std::copy_n(row->GetBlock().Images[i], 3, image);
    if (row->GetBlock().Triangles[i] < 0)
    {
      std::fill_n(image, 3, this->OutsideCoordinate);
    }
    Store(image, out);
  }

  /// Maps a point, and sets the derivative of the map from @a from there, NaN outside, unless it is
  /// null.
  template <typename Real>
  void MapPoint(Domain from, const Real in[3], Real out[3], double (*derivative)[3][3]) const
  {
    const double point[3] = { in[0], in[1], in[2] };
    // Callers that map point by point, such as vtkImageReslice, usually stay in a triangle. Each
    // thread remembers its last one. A hint from another mesh or domain only costs time.
    thread_local TriangleIndex last = -1;
    const TriangleIndex hint = last < this->NumberOfTriangles ? last : -1;
    const SurfacePoint surfacePoint = this->Map
      ? this->Map->Locate(from, point, this->GetTolerance<Real>(from), hint)
      : SurfacePoint{};
    last = surfacePoint.Triangle;
    double image[3];
    Jacobian jacobian;
    const bool exists = surfacePoint.Triangle >= 0 &&
      (derivative ? this->Map->MapPoint(from, surfacePoint, image, jacobian)
                  : this->Map->MapPoint(from, surfacePoint, image));
    if (!exists)
    {
      std::fill_n(image, 3, this->OutsideCoordinate);
      jacobian.Matrix.fill(vtkMath::Nan());
    }
    if (derivative)
    {
      std::copy(jacobian.Matrix.begin(), jacobian.Matrix.end(), &(*derivative)[0][0]);
    }
    Store(image, out);
  }

  template <typename Real>
  static void Store(const double image[3], Real out[3])
  {
    const auto largest = static_cast<double>(std::numeric_limits<Real>::max());
    std::transform(image, image + 3, out,
      [largest](double x) { return static_cast<Real>(std::max(-largest, std::min(largest, x))); });
  }

  /// The derivative of the map from @a from at a point of a mapped block; NaN outside.
  void GetDerivative(Domain from, const PointBlock& block, int i, double derivative[3][3]) const
  {
    if (block.Triangles[i] < 0)
    {
      std::fill_n(&derivative[0][0], 9, vtkMath::Nan());
      return;
    }
    const Jacobian jacobian = this->Map->GetJacobian(from, block, i);
    std::copy(jacobian.Matrix.begin(), jacobian.Matrix.end(), &derivative[0][0]);
  }

  /// The image of a point and the derivative of the forward map there, also for the inverse.
  template <typename Real>
  void MapWithForwardDerivative(
    Domain from, const Real in[3], Real out[3], Real derivative[3][3]) const
  {
    double matrix[3][3];
    this->MapPoint(from, in, out, &matrix);
    if (from == Domain::Target)
    {
      vtkMath::Invert3x3(matrix, matrix);
    }
    std::transform(&matrix[0][0], &matrix[0][0] + 9, &derivative[0][0],
      [](double x) { return static_cast<Real>(x); });
  }

  template <typename Real>
  double GetTolerance(Domain from) const
  {
    return this->Tolerances[std::is_same_v<Real, double> ? 1 : 0][int(from)];
  }

  HomeomorphismCache Cache;
  std::shared_ptr<const Homeomorphism> Map;
  double Tolerance = 0.0;
  double OutsideCoordinate = 1e30;
  TriangleIndex NumberOfTriangles = 0;
  /// Different for each update of any transform.
  std::uint64_t Version = 0;
  /// The absolute tolerances of float and double points, in each domain.
  std::array<std::array<double, 2>, 2> Tolerances{};
};

vtkHomeomorphismTransform::vtkHomeomorphismTransform()
  : Internal(new Internals)
{
}

vtkHomeomorphismTransform::~vtkHomeomorphismTransform()
{
  this->vtkHomeomorphismTransform::SetSource(nullptr);
  this->vtkHomeomorphismTransform::SetTarget(nullptr);
}

void vtkHomeomorphismTransform::SetSource(vtkPolyData* source)
{
  vtkSetObjectBodyMacro(Source, vtkPolyData, source);
}

void vtkHomeomorphismTransform::SetTarget(vtkPolyData* target)
{
  vtkSetObjectBodyMacro(Target, vtkPolyData, target);
}

vtkAbstractTransform* vtkHomeomorphismTransform::MakeTransform()
{
  return vtkHomeomorphismTransform::New();
}

vtkMTimeType vtkHomeomorphismTransform::GetMTime()
{
  vtkMTimeType time = this->Superclass::GetMTime();
  for (vtkPolyData* mesh : { this->Source, this->Target })
  {
    time = mesh ? std::max(time, mesh->GetMTime()) : time;
  }
  return time;
}

void vtkHomeomorphismTransform::InternalUpdate()
{
  static std::atomic<std::uint64_t> versions{ 0 };
  this->Internal->Version = ++versions;
  this->Internal->Map.reset();
  this->Internal->Tolerance = this->Tolerance;
  this->Internal->OutsideCoordinate = 1e30;
  if (!this->Source || !this->Target)
  {
    vtkErrorMacro(<< "The " << (this->Source ? "target" : "source")
                  << " mesh is not set (SetSource, SetTarget): all points are treated as outside.");
    return;
  }
  const auto map = this->Internal->Cache.Get(this->Source, this->Target, GetOptions(this));
  ReportProblems(this, this->Internal->Cache.GetProblems());
  if (!map)
  {
    return;
  }
  for (const Domain domain : { Domain::Source, Domain::Target })
  {
    const MeshGeometry& geometry = map->GetPair().GetGeometry(domain);
    if (!geometry.IsPlanar())
    {
      vtkErrorMacro(<< "The points of the " << (domain == Domain::Source ? "source" : "target")
                    << " mesh do not lie in a plane, but a transform needs planar meshes: all "
                       "points are treated as outside. Use vtkDifferentiableHomeomorphism for "
                       "surfaces.");
      return;
    }
    this->Internal->OutsideCoordinate = std::max(this->Internal->OutsideCoordinate,
      std::min(VTK_DOUBLE_MAX, 1e3 * geometry.GetLargestCoordinate() / geometry.GetScale()));
  }
  for (const Domain domain : { Domain::Source, Domain::Target })
  {
    for (const int type : { VTK_FLOAT, VTK_DOUBLE })
    {
      this->Internal->Tolerances[type == VTK_DOUBLE ? 1 : 0][int(domain)] =
        map->GetAbsoluteTolerance(domain, this->Tolerance, PrecisionOfType(type));
    }
  }
  this->Internal->NumberOfTriangles = map->GetPair().GetTriangulation().GetNumberOfTriangles();
  this->Internal->Map = map;
}

void vtkHomeomorphismTransform::InternalDeepCopy(vtkAbstractTransform* transform)
{
  auto* other = static_cast<vtkHomeomorphismTransform*>(transform);
  this->SetInverseTolerance(other->InverseTolerance);
  this->SetInverseIterations(other->InverseIterations);
  this->SetSource(other->Source);
  this->SetTarget(other->Target);
  CopyOptions(other, this);
  this->Internal->Cache = other->Internal->Cache;
  if (this->InverseFlag != other->InverseFlag)
  {
    this->InverseFlag = other->InverseFlag;
    this->Modified();
  }
}

bool vtkHomeomorphismTransform::IsInside(const double point[3])
{
  this->Update();
  return this->Internal
           ->Locate(this->InverseFlag ? Domain::Target : Domain::Source, point,
             PrecisionOfType(VTK_DOUBLE), -1)
           .Triangle >= 0;
}

double vtkHomeomorphismTransform::GetOutsideCoordinate()
{
  this->Update();
  return this->Internal->OutsideCoordinate;
}

void vtkHomeomorphismTransform::TransformPoints(vtkPoints* inPts, vtkPoints* outPts)
{
  this->TransformPointsNormalsVectors(
    inPts, outPts, nullptr, nullptr, nullptr, nullptr, 0, nullptr, nullptr);
}

void vtkHomeomorphismTransform::TransformPointsNormalsVectors(vtkPoints* inPts, vtkPoints* outPts,
  vtkDataArray* inNms, vtkDataArray* outNms, vtkDataArray* inVrs, vtkDataArray* outVrs,
  int nOptionalVectors, vtkDataArray** inVrsArr, vtkDataArray** outVrsArr)
{
  this->Update();
  // VTK appends the results to the contents of the outputs.
  const vtkIdType count = inPts->GetNumberOfPoints();
  const vtkIdType firstPoint = outPts->GetNumberOfPoints();
  outPts->Resize(firstPoint + count);
  outPts->SetNumberOfPoints(firstPoint + count);

  struct TransformedArray
  {
    vtkDataArray* In;
    vtkDataArray* Out;
    bool Normals;
    vtkIdType First;
  };
  std::vector<TransformedArray> arrays;
  const auto add = [&arrays, count](vtkDataArray* in, vtkDataArray* out, bool normals) {
    if (in && out)
    {
      arrays.push_back({ in, out, normals, out->GetNumberOfTuples() });
      out->SetNumberOfComponents(3);
      out->Resize(arrays.back().First + count);
      out->SetNumberOfTuples(arrays.back().First + count);
    }
  };
  add(inNms, outNms, true);
  add(inVrs, outVrs, false);
  for (int i = 0; i < nOptionalVectors; ++i)
  {
    add(inVrsArr[i], outVrsArr[i], false);
  }

  const Internals& internals = *this->Internal;
  const Domain from = this->InverseFlag ? Domain::Target : Domain::Source;
  // Coordinates stored as float count as inside within their own rounding.
  const double tolerance = internals.Map
    ? internals.Map->GetAbsoluteTolerance(
        from, internals.Tolerance, PrecisionOfType(inPts->GetDataType()))
    : 0.0;
  vtkSMPTools::For(0, count, [&](vtkIdType begin, vtkIdType end) {
    LocationHint hint;
    PointBlock block;
    block.KeepsReferences = !arrays.empty();
    for (vtkIdType first = begin; first < end; first += PointBlock::Capacity)
    {
      block.Count = static_cast<int>(std::min<vtkIdType>(PointBlock::Capacity, end - first));
      SetImages(outPts->GetData(), firstPoint + first, firstPoint + end, block);
      int outside = block.Count;
      std::fill_n(block.Triangles, block.Count, -1);
      if (internals.Map)
      {
        ReadPoints(inPts->GetData(), first, block);
        outside = internals.Map->LocateBlock(from, block, tolerance, hint);
        outside += internals.Map->MapBlock(from, block);
      }
      for (int i = 0; i < block.Count && outside > 0; ++i)
      {
        if (block.Triangles[i] < 0)
        {
          std::fill_n(block.Images[i], 3, internals.OutsideCoordinate);
        }
      }
      WritePoints(block.Images, block.Count, firstPoint + first, outPts->GetData());
      for (int i = 0; i < block.Count && !arrays.empty(); ++i)
      {
        double derivative[3][3];
        internals.GetDerivative(from, block, i, derivative);
        const TensorTransformation transformation(&derivative[0][0]);
        for (const TransformedArray& array : arrays)
        {
          double vector[3];
          array.In->GetTuple(first + i, vector);
          if (array.Normals)
          {
            transformation.TransformNormal(vector);
          }
          else
          {
            transformation.TransformTangent(vector);
          }
          array.Out->SetTuple(array.First + first + i, vector);
        }
      }
    }
  });
}

void vtkHomeomorphismTransform::ForwardTransformPoint(const float in[3], float out[3])
{
  this->Internal->MapPoint(Domain::Source, in, out);
}

void vtkHomeomorphismTransform::ForwardTransformPoint(const double in[3], double out[3])
{
  this->Internal->MapPoint(Domain::Source, in, out);
}

void vtkHomeomorphismTransform::ForwardTransformDerivative(
  const float in[3], float out[3], float derivative[3][3])
{
  this->Internal->MapWithForwardDerivative(Domain::Source, in, out, derivative);
}

void vtkHomeomorphismTransform::ForwardTransformDerivative(
  const double in[3], double out[3], double derivative[3][3])
{
  this->Internal->MapWithForwardDerivative(Domain::Source, in, out, derivative);
}

void vtkHomeomorphismTransform::InverseTransformPoint(const float in[3], float out[3])
{
  this->Internal->MapPoint(Domain::Target, in, out);
}

void vtkHomeomorphismTransform::InverseTransformPoint(const double in[3], double out[3])
{
  this->Internal->MapPoint(Domain::Target, in, out);
}

void vtkHomeomorphismTransform::InverseTransformDerivative(
  const float in[3], float out[3], float derivative[3][3])
{
  this->Internal->MapWithForwardDerivative(Domain::Target, in, out, derivative);
}

void vtkHomeomorphismTransform::InverseTransformDerivative(
  const double in[3], double out[3], double derivative[3][3])
{
  this->Internal->MapWithForwardDerivative(Domain::Target, in, out, derivative);
}

void vtkHomeomorphismTransform::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Source: " << this->Source << "\n";
  os << indent << "Target: " << this->Target << "\n";
  PrintOptions(this, os, indent);
}
