// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkDifferentiableHomeomorphism.h"

#include "Mesh/CubicHomeomorphism.h"
#include "Pipeline/AttributeTransformation.h"
#include "Pipeline/CellPoints.h"
#include "Pipeline/CompositeData.h"
#include "Pipeline/GhostArrays.h"
#include "Pipeline/Options.h"
#include "Pipeline/PointBlocks.h"
#include "Pipeline/PointsOffSurface.h"
#include "Pipeline/Requests.h"

#include "Mesh/MeshValidation.h"

#include "vtkCell.h"
#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkIdList.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkIntArray.h"
#include "vtkJacobianContinuity.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPointData.h"
#include "vtkPointSet.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkRectilinearGrid.h"
#include "vtkSMPThreadLocalObject.h"
#include "vtkStructuredGrid.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

using namespace homeomorphism;

vtkStandardNewMacro(vtkDifferentiableHomeomorphism);

class vtkDifferentiableHomeomorphism::Internals
{
public:
  std::map<std::string, TransformationRule> Transformations;

  /// Measures the map used by @a self, unless the result is up to date.
  void Measure(vtkDifferentiableHomeomorphism* self,
    const std::shared_ptr<const Homeomorphism>& map, vtkPolyData* mesh, vtkPolyData* output);

  vtkNew<vtkJacobianContinuity> Continuity;
  /// The last result and its inputs.
  vtkNew<vtkPolyData> Measured;
  std::weak_ptr<const Homeomorphism> MeasuredMap;
  bool MeasuredInverse = false;
  vtkMTimeType MeasuredTime = 0;
};

namespace
{

/// The extent of a data set whose points form a grid with implicit coordinates; null otherwise.
const int* GridExtent(vtkDataSet* data)
{
  if (auto* image = vtkImageData::SafeDownCast(data))
  {
    return image->GetExtent();
  }
  auto* grid = vtkRectilinearGrid::SafeDownCast(data);
  return grid ? grid->GetExtent() : nullptr;
}

/// Whether objects of a class become structured grids.
bool BecomesStructuredGrid(vtkDataObject* data)
{
  return vtkImageData::SafeDownCast(data) || vtkRectilinearGrid::SafeDownCast(data);
}

} // namespace

/// Maps one data set.
class vtkDifferentiableHomeomorphism::Mapping
{
public:
  Mapping(vtkDifferentiableHomeomorphism* self, const Homeomorphism& map, vtkDataSet* input,
    vtkPointSet* output)
    : Self(self)
    , Map(map)
    , From(self->Inverse ? Domain::Target : Domain::Source)
    , Input(input)
    , Output(output)
    , NumberOfPoints(input->GetNumberOfPoints())
    , Mask(vtkSmartPointer<vtkUnsignedCharArray>::New())
  {
  }

  void Run()
  {
    this->PassEverything();
    const bool transformsPoints = this->TransformsAny(this->Input->GetPointData());
    this->MapPoints(transformsPoints);
    if (transformsPoints)
    {
      this->TransformArrays(
        this->Input->GetPointData(), this->Output->GetPointData(), this->Jacobians);
    }
    if (this->TransformsAny(this->Input->GetCellData()))
    {
      this->TransformArrays(
        this->Input->GetCellData(), this->Output->GetCellData(), this->ComputeCellJacobians());
    }
    this->AddPointArrays();
    this->MarkOutside();
  }

private:
  void PassEverything()
  {
    if (const int* extent = GridExtent(this->Input))
    {
      vtkStructuredGrid::SafeDownCast(this->Output)->SetExtent(const_cast<int*>(extent));
      this->Output->GetPointData()->PassData(this->Input->GetPointData());
      this->Output->GetCellData()->PassData(this->Input->GetCellData());
      this->Output->GetFieldData()->PassData(this->Input->GetFieldData());
    }
    else
    {
      this->Output->ShallowCopy(this->Input);
    }
  }

  vtkPoints* GetInputPoints() const
  {
    auto* pointSet = vtkPointSet::SafeDownCast(this->Input);
    return pointSet ? pointSet->GetPoints() : nullptr;
  }

  double GetAbsoluteTolerance() const
  {
    return this->Map.GetAbsoluteTolerance(
      this->From, this->Self->Tolerance, PrecisionOfPoints(this->Input));
  }

  static vtkSmartPointer<vtkDoubleArray> NewDoubles(
    const char* name, int components, vtkIdType tuples)
  {
    auto array = vtkSmartPointer<vtkDoubleArray>::New();
    array->SetName(name);
    array->SetNumberOfComponents(components);
    array->SetNumberOfTuples(tuples);
    array->FillValue(vtkMath::Nan());
    return array;
  }

  void MapPoints(bool needsJacobians)
  {
    vtkPoints* inPoints = this->GetInputPoints();
    const vtkNew<vtkPoints> outPoints;
    switch (this->Self->OutputPointsPrecision)
    {
      case vtkAlgorithm::SINGLE_PRECISION:
        outPoints->SetDataTypeToFloat();
        break;
      case vtkAlgorithm::DOUBLE_PRECISION:
        outPoints->SetDataTypeToDouble();
        break;
      default:
        outPoints->SetDataType(
          inPoints && inPoints->GetDataType() == VTK_FLOAT ? VTK_FLOAT : VTK_DOUBLE);
    }
    outPoints->SetNumberOfPoints(this->NumberOfPoints);
    this->Mask->SetName("vtkValidPointMask");
    this->Mask->SetNumberOfTuples(this->NumberOfPoints);
    this->Mask->FillValue(0);
    if (this->Self->ComputeTriangleId)
    {
      this->Triangles = vtkSmartPointer<vtkIdTypeArray>::New();
      this->Triangles->SetName("TriangleId");
      this->Triangles->SetNumberOfTuples(this->NumberOfPoints);
      this->Triangles->FillValue(-1);
    }
    if (this->Self->NumberOfDiscordantTriangles > 0)
    {
      this->Systems = vtkSmartPointer<vtkIntArray>::New();
      this->Systems->SetName("UsedCoordinateSystem");
      this->Systems->SetNumberOfTuples(this->NumberOfPoints);
      this->Systems->FillValue(-1);
    }
    if (needsJacobians || this->Self->ComputeJacobian)
    {
      this->Jacobians = NewDoubles("Jacobian", 9, this->NumberOfPoints);
    }
    if (this->Self->ComputeJacobianDeterminant)
    {
      this->Determinants = NewDoubles("JacobianDeterminant", 1, this->NumberOfPoints);
    }

    vtkUnsignedCharArray* ghosts = GhostsOf(this->Input->GetPointData(), this->NumberOfPoints);
    const auto isHidden = [ghosts](vtkIdType i) {
      return ghosts && (ghosts->GetValue(i) & vtkDataSetAttributes::HIDDENPOINT) != 0;
    };
    const vtkIdType done = MapInBlocks(this->Self, this->Map, this->From, this->Input,
      this->GetAbsoluteTolerance(), 0.1, 0.9, isHidden, outPoints->GetData(),
      this->Jacobians || this->Determinants, [&](vtkIdType first, const PointBlock& block) {
        WritePoints(block.Images, block.Count, first, outPoints->GetData());
        for (int i = 0; i < block.Count; ++i)
        {
          if (block.Triangles[i] >= 0)
          {
            this->Mask->SetValue(first + i, 1);
            this->SetDerived(first + i, block, i);
          }
        }
      });
    // After an abort, points that were not processed keep their coordinates and are marked as
    // outside.
    for (vtkIdType i = done; i < this->NumberOfPoints; ++i)
    {
      outPoints->SetPoint(i, this->Input->GetPoint(i));
    }
    this->Output->SetPoints(outPoints);
  }

  void SetDerived(vtkIdType i, const PointBlock& block, int numberInBlock)
  {
    const TriangleIndex triangle = block.Triangles[numberInBlock];
    if (this->Triangles)
    {
      this->Triangles->SetValue(i, this->Map.GetPair().GetTriangulation().GetCellId(triangle));
    }
    if (this->Systems)
    {
      this->Systems->SetValue(
        i, static_cast<int>(this->Map.GetCharts(this->From).GetSystemOf(triangle)));
    }
    if (this->Jacobians || this->Determinants)
    {
      const Jacobian jacobian = this->Map.GetJacobian(this->From, block, numberInBlock);
      if (this->Jacobians)
      {
        std::copy(
          jacobian.Matrix.begin(), jacobian.Matrix.end(), this->Jacobians->GetPointer(9 * i));
      }
      if (this->Determinants)
      {
        this->Determinants->SetValue(i, jacobian.Determinant);
      }
    }
  }

  /// The Jacobian at the mean of the points of each cell.
  vtkSmartPointer<vtkDoubleArray> ComputeCellJacobians()
  {
    const vtkIdType cells = this->Input->GetNumberOfCells();
    const auto jacobians = NewDoubles("Jacobian", 9, cells);
    const CellPoints cellPoints(this->Input);
    vtkSMPThreadLocalObject<vtkIdList> lists;
    const double pointTolerance = this->GetAbsoluteTolerance();
    const MeshGeometry& geometry = this->Map.GetPair().GetGeometry(this->From);
    RunInBlocks(this->Self, cells, 0.9, 1.0, [&](vtkIdType begin, vtkIdType end) {
      vtkIdList* ids = lists.Local();
      TriangleIndex hint = -1;
      for (vtkIdType i = begin; i < end; ++i)
      {
        cellPoints.Get(i, ids);
        const vtkIdType count =
          std::all_of(ids->begin(), ids->end(), [this](vtkIdType id) { return this->IsPoint(id); })
          ? ids->GetNumberOfIds()
          : 0;
        double mean[3] = { 0.0, 0.0, 0.0 };
        for (vtkIdType k = 0; k < count; ++k)
        {
          double point[3];
          this->Input->GetPoint(ids->GetId(k), point);
          for (int axis = 0; axis < 3; ++axis)
          {
            mean[axis] += point[axis] / static_cast<double>(count);
          }
        }
        double tolerance = pointTolerance;
        for (vtkIdType k = 0; k < count && !geometry.IsColumnar(); ++k)
        {
          // The mean of points of a surface may lie off the surface, by at most its distance from
          // the points.
          double point[3];
          this->Input->GetPoint(ids->GetId(k), point);
          tolerance = std::max(tolerance,
            geometry.GetScale() * std::sqrt(vtkMath::Distance2BetweenPoints(mean, point)));
        }
        const SurfacePoint surfacePoint =
          count > 0 ? this->Map.Locate(this->From, mean, tolerance, hint) : SurfacePoint{};
        hint = surfacePoint.Triangle;
        if (surfacePoint.Triangle >= 0)
        {
          const Jacobian jacobian = this->Map.GetJacobian(this->From, surfacePoint);
          std::copy(jacobian.Matrix.begin(), jacobian.Matrix.end(), jacobians->GetPointer(9 * i));
        }
      }
    });
    return jacobians;
  }

  /// Whether a point id, which may come from a corrupt cell, is valid.
  bool IsPoint(vtkIdType point) const { return point >= 0 && point < this->NumberOfPoints; }

  TransformationRule GetRule(vtkDataSetAttributes* attributes, vtkDataArray* array) const
  {
    const auto& named = this->Self->Internal->Transformations;
    const auto found = array->GetName() ? named.find(array->GetName()) : named.end();
    if (found != named.end())
    {
      return found->second;
    }
    if (!this->Self->TransformActiveAttributes)
    {
      return TransformationRule::None;
    }
    if (array == attributes->GetNormals())
    {
      return TransformationRule::Normal;
    }
    if (array == attributes->GetVectors() || array == attributes->GetTensors())
    {
      return TransformationRule::Tangent;
    }
    const bool real = array->GetDataType() == VTK_FLOAT || array->GetDataType() == VTK_DOUBLE;
    // The derivative of a previous map is not a tensor of the domain of this map.
    const bool derivative = array->GetName() && std::string(array->GetName()) == "Jacobian";
    return this->Self->TransformAllInputVectors && real && !derivative &&
        array != attributes->GetTCoords() && array != attributes->GetScalars()
      ? TransformationRule::Tangent
      : TransformationRule::None;
  }

  void TransformArrays(
    vtkDataSetAttributes* input, vtkDataSetAttributes* output, vtkDoubleArray* jacobians)
  {
    TransformAttributes(input, output, jacobians,
      [this, input](vtkDataArray* array) { return this->GetRule(input, array); });
  }

  bool TransformsAny(vtkDataSetAttributes* attributes) const
  {
    for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
    {
      vtkDataArray* array = attributes->GetArray(i);
      if (array && this->GetRule(attributes, array) != TransformationRule::None)
      {
        return true;
      }
    }
    return false;
  }

  void AddPointArrays()
  {
    vtkPointData* pointData = this->Output->GetPointData();
    pointData->AddArray(this->Mask);
    if (this->Triangles)
    {
      pointData->AddArray(this->Triangles);
    }
    if (this->Systems)
    {
      pointData->AddArray(this->Systems);
    }
    if (this->Self->ComputeJacobian)
    {
      pointData->AddArray(this->Jacobians);
    }
    if (this->Determinants)
    {
      pointData->AddArray(this->Determinants);
    }
  }

  void MarkOutside()
  {
    this->Self->NumberOfOutsidePoints += CountOutside(this->Input, this->Mask);
    WarnOfPointsOffSurface(this->Self, this->Map, this->From, this->Input, this->Mask);
    if (this->Self->BlankOutside)
    {
      HidePoints(this->Input, this->Mask, this->Output);
    }
  }

  vtkDifferentiableHomeomorphism* Self;
  const Homeomorphism& Map;
  Domain From;
  vtkDataSet* Input;
  vtkPointSet* Output;
  vtkIdType NumberOfPoints;
  vtkSmartPointer<vtkUnsignedCharArray> Mask;
  vtkSmartPointer<vtkIdTypeArray> Triangles;
  vtkSmartPointer<vtkIntArray> Systems;
  vtkSmartPointer<vtkDoubleArray> Jacobians;
  vtkSmartPointer<vtkDoubleArray> Determinants;
};

vtkDifferentiableHomeomorphism::vtkDifferentiableHomeomorphism()
  : Internal(new Internals)
{
  this->SetNumberOfInputPorts(3);
  this->SetNumberOfOutputPorts(2);
}

vtkDifferentiableHomeomorphism::~vtkDifferentiableHomeomorphism() = default;

void vtkDifferentiableHomeomorphism::SetAttributeTransformation(
  const char* name, int transformation)
{
  if (!name || transformation < NO_TRANSFORMATION || transformation > NORMAL_TRANSFORMATION)
  {
    vtkErrorMacro(
      << "SetAttributeTransformation expects the name of an array and a transformation from "
      << NO_TRANSFORMATION << " to " << NORMAL_TRANSFORMATION << ", not "
      << (name ? name : "(none)") << " and " << transformation << ".");
    return;
  }
  this->Internal->Transformations[name] = static_cast<TransformationRule>(transformation);
  this->Modified();
}

int vtkDifferentiableHomeomorphism::GetAttributeTransformation(const char* name)
{
  const auto found =
    name ? this->Internal->Transformations.find(name) : this->Internal->Transformations.end();
  return found == this->Internal->Transformations.end() ? -1 : static_cast<int>(found->second);
}

void vtkDifferentiableHomeomorphism::ClearAttributeTransformations()
{
  if (!this->Internal->Transformations.empty())
  {
    this->Internal->Transformations.clear();
    this->Modified();
  }
}

void vtkDifferentiableHomeomorphism::ReduceStatistics(vtkMultiProcessController* controller)
{
  this->Superclass::ReduceStatistics(controller);
  this->Internal->Continuity->ReduceStatistics(controller);
}

int vtkDifferentiableHomeomorphism::RequestDataObject(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  if (!BecomesStructuredGrid(vtkDataObject::GetData(inputs[2])))
  {
    return this->Superclass::RequestDataObject(request, inputs, outputs);
  }
  this->CheckInputTypes(inputs);
  MakeOutput<vtkStructuredGrid>(outputs->GetInformationObject(0));
  MakeOutput<vtkPolyData>(outputs->GetInformationObject(1));
  return 1;
}

void vtkDifferentiableHomeomorphism::Internals::Measure(vtkDifferentiableHomeomorphism* self,
  const std::shared_ptr<const Homeomorphism>& map, vtkPolyData* mesh, vtkPolyData* output)
{
  const vtkMTimeType time = this->Continuity->GetMTime();
  if (this->MeasuredMap.lock() != map || this->MeasuredInverse != self->Inverse ||
    this->MeasuredTime != time)
  {
    this->Measured->Initialize();
    const vtkNew<vtkPolyData> colored;
    const bool complete = this->Continuity->Measure(
      self, self->Inverse ? map->Inverted() : map, nullptr, mesh, this->Measured, colored);
    // Do not store the result of an aborted run as a complete one.
    this->MeasuredMap = complete ? map : nullptr;
    this->MeasuredInverse = self->Inverse;
    this->MeasuredTime = time;
  }
  output->ShallowCopy(this->Measured);
}

vtkJacobianContinuity* vtkDifferentiableHomeomorphism::GetJacobianContinuity()
{
  return this->Internal->Continuity;
}

vtkMTimeType vtkDifferentiableHomeomorphism::GetMTime()
{
  return std::max(this->Superclass::GetMTime(), this->Internal->Continuity->GetMTime());
}

namespace
{

/// Adds arrays to a mesh: where the map is certified, and where it has no derivative.
void AddCubicArrays(const Homeomorphism& map, vtkPointSet* mesh)
{
  const Triangulation& triangulation = map.GetPair().GetTriangulation();
  vtkNew<vtkDoubleArray> certificates;
  certificates->SetName("Certificate");
  certificates->SetNumberOfValues(mesh->GetNumberOfCells());
  certificates->Fill(0.0);
  for (TriangleIndex t = 0; t < triangulation.GetNumberOfTriangles(); ++t)
  {
    certificates->SetValue(triangulation.GetCellId(t), map.GetCubic()->GetCertificate(t));
  }
  mesh->GetCellData()->AddArray(certificates);
  vtkNew<vtkUnsignedCharArray> exceptional;
  exceptional->SetName("ExceptionalVertex");
  exceptional->SetNumberOfValues(mesh->GetNumberOfPoints());
  exceptional->Fill(0);
  for (const bool interior : { true, false })
  {
    for (const std::int32_t point : map.GetCubic()->GetExceptionalPoints(interior))
    {
      exceptional->SetValue(point, 1);
    }
  }
  mesh->GetPointData()->AddArray(exceptional);
}

} // namespace

int vtkDifferentiableHomeomorphism::Execute(
  vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs)
{
  vtkPolyData* source = vtkPolyData::GetData(inputs[0]);
  vtkPolyData* target = vtkPolyData::GetData(inputs[1]);
  vtkDataObject* data = vtkDataObject::GetData(inputs[2]);
  vtkDataObject* output = vtkDataObject::GetData(outputs, 0);
  const std::shared_ptr<const Homeomorphism> map = this->GetMap(source, target);
  if (!map)
  {
    return 0;
  }

  const ChartedTriangulation& charts = map->GetCharts(Domain::Source);
  for (TriangleIndex t = 0; t < map->GetPair().GetTriangulation().GetNumberOfTriangles(); ++t)
  {
    this->NumberOfDiscordantTriangles += charts.GetSystemOf(t) != charts.GetSystem();
  }

  const bool isFirstPiece = IsFirstPiece(request, outputs);
  if (this->MeasureContinuity && isFirstPiece)
  {
    constexpr double share = 0.8;
    this->SetProgressShiftScale(0.0, share);
    this->Internal->Measure(
      this, map, this->Inverse ? target : source, vtkPolyData::GetData(outputs, 1));
    this->SetProgressShiftScale(share, 1.0 - share);
  }
  if (!isFirstPiece && (!data || this->DependsOnPortsBefore(2)))
  {
    return 1;
  }
  const bool mapsMesh = !data;
  if (mapsMesh)
  {
    data = this->Inverse ? target : source;
  }
  if (auto* tree = vtkCompositeDataSet::SafeDownCast(data))
  {
    ConvertLeaves(this, tree, vtkCompositeDataSet::SafeDownCast(output), [&](vtkDataSet* leaf) {
      vtkSmartPointer<vtkPointSet> result;
      if (BecomesStructuredGrid(leaf))
      {
        result = vtkSmartPointer<vtkStructuredGrid>::New();
      }
      else
      {
        result.TakeReference(vtkPointSet::SafeDownCast(leaf->NewInstance()));
      }
      if (!result)
      {
        vtkWarningMacro(<< "A block of type " << leaf->GetClassName()
                        << " has no points that can be moved; it is left out.");
        return vtkSmartPointer<vtkDataSet>();
      }
      Mapping(this, *map, leaf, result).Run();
      return vtkSmartPointer<vtkDataSet>(result);
    });
  }
  else if (auto* result = vtkPointSet::SafeDownCast(output))
  {
    Mapping(this, *map, vtkDataSet::SafeDownCast(data), result).Run();
    if (mapsMesh && map->GetCubic())
    {
      AddCubicArrays(*map, result);
    }
  }
  else
  {
    vtkErrorMacro(<< "Data of type " << data->GetClassName()
                  << " has no points that can be moved: use a point set, an image, a rectilinear "
                     "grid, or a tree of these.");
    return this->Fail(DATA_REFUSED);
  }
  return 1;
}

void vtkDifferentiableHomeomorphism::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  PrintMappingOptions(this, os, indent);
  os << indent << "ComputeTriangleId: " << this->ComputeTriangleId << "\n";
  os << indent << "ComputeJacobian: " << this->ComputeJacobian << "\n";
  os << indent << "ComputeJacobianDeterminant: " << this->ComputeJacobianDeterminant << "\n";
  os << indent << "TransformAllInputVectors: " << this->TransformAllInputVectors << "\n";
  for (const auto& transformation : this->Internal->Transformations)
  {
    os << indent << "AttributeTransformation of " << transformation.first << ": "
       << static_cast<int>(transformation.second) << "\n";
  }
  os << indent << "MeasureContinuity: " << this->MeasureContinuity << "\n";
  os << indent << "OutputPointsPrecision: " << this->OutputPointsPrecision << "\n";
}
