// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file MeasuredMaps.h
/// Maps that are not homeomorphisms of triangulations: one with known creases, and one without
/// creases.

#ifndef fixtures_MeasuredMaps_h
#define fixtures_MeasuredMaps_h

#include "Meshes.h"

#include "vtkObjectFactory.h"
#include "vtkThinPlateSplineTransform.h"
#include "vtkWarpTransform.h"

#include <functional>

namespace fixtures
{

/// A map of the plane that is smooth except at the line x = 7, beyond which Amount times the
/// distance to the power Exponent is added. With EveryLine, it consists of pieces between all
/// lines of integer x: straight lines up and down (Exponent 1), or parabolas with common tangents
/// (2).
class PiecewiseMap : public vtkWarpTransform
{
public:
  static PiecewiseMap* New();
  vtkTypeMacro(PiecewiseMap, vtkWarpTransform);

  double Amount = 0.0;
  int Exponent = 1;
  bool EveryLine = false;
  /// Changes the values.
  std::function<double(double)> Alter = [](double x) { return x; };

  vtkAbstractTransform* MakeTransform() override { return PiecewiseMap::New(); }

protected:
  double Turn(double x) const { return x > 7.0 ? std::pow(x - 7.0, this->Exponent) : 0.0; }
  double Wave(double x) const
  {
    const double u = x - std::floor(x);
    const bool up = std::fmod(std::floor(x), 2.0) == 0.0;
    if (this->Exponent == 1)
    {
      return up ? u : 1.0 - u;
    }
    return (up ? u : -u) * (1.0 - u);
  }
  template <typename Real>
  void Map(const Real in[3], Real out[3]) const
  {
    const double x = in[0];
    const double y = in[1];
    const double bend = this->Amount * (this->EveryLine ? this->Wave(x) : this->Turn(x));
    out[0] = static_cast<Real>(this->Alter(x + bend + 0.05 * std::sin(y)));
    out[1] = static_cast<Real>(this->Alter(y + bend + 0.1 * std::cos(x)));
    out[2] = in[2];
  }
  void ForwardTransformPoint(const float in[3], float out[3]) override { this->Map(in, out); }
  void ForwardTransformPoint(const double in[3], double out[3]) override { this->Map(in, out); }
  // Not used: the filter evaluates values only.
  void ForwardTransformDerivative(const float in[3], float out[3], float d[3][3]) override
  {
    this->Map(in, out);
    std::fill_n(&d[0][0], 9, std::numeric_limits<float>::quiet_NaN());
  }
  void ForwardTransformDerivative(const double in[3], double out[3], double d[3][3]) override
  {
    this->Map(in, out);
    std::fill_n(&d[0][0], 9, std::numeric_limits<double>::quiet_NaN());
  }
};
inline vtkStandardNewMacro(PiecewiseMap);

/// A thin plate spline from the source to the target of a pair through every @a stride-th point,
/// slightly moved in both meshes, so that landmarks lie off the vertices.
inline vtkSmartPointer<vtkThinPlateSplineTransform> MakeThinPlateSpline(
  const MeshPair& pair, vtkIdType stride)
{
  constexpr Point aside{ 0.31, 0.0, 0.0 };
  vtkNew<vtkPoints> from;
  vtkNew<vtkPoints> to;
  for (vtkIdType i = 0; i < pair.Source->GetNumberOfPoints(); i += stride)
  {
    from->InsertNextPoint((PointOf(pair.Source, i) + aside).data());
    to->InsertNextPoint((PointOf(pair.Target, i) + aside).data());
  }
  auto spline = vtkSmartPointer<vtkThinPlateSplineTransform>::New();
  spline->SetSourceLandmarks(from);
  spline->SetTargetLandmarks(to);
  spline->SetBasisToR2LogR();
  return spline;
}

} // namespace fixtures

#endif
