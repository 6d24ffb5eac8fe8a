// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file AttributeTransformation.h
/// How vectors, normals and tensors are carried along by a map's Jacobian.

#ifndef homeomorphism_AttributeTransformation_h
#define homeomorphism_AttributeTransformation_h

#include "vtkSmartPointer.h"

#include <functional>

class vtkDataArray;
class vtkDataSetAttributes;
class vtkDoubleArray;

namespace homeomorphism
{

/// Carries values at one point, where the map's Jacobian is J (row-major, invertible). Where J is
/// NaN, outside the domain, so are all results.
class TensorTransformation
{
public:
  explicit TensorTransformation(const double jacobian[9]);

  /// A tangent vector, such as a velocity or a displacement: J v.
  void TransformTangent(double vector[3]) const;
  /// A gradient: J^-T g, so that its product with a tangent vector stays what it is.
  void TransformGradient(double vector[3]) const;
  /// A unit normal: J^-T n, made a unit vector again. A zero vector stays zero.
  void TransformNormal(double vector[3]) const;
  /// A tensor that is linear in two tangent vectors, such as a diffusion tensor: J T J^T.
  void TransformTangentTensor(double tensor[9]) const;
  /// A tensor made of two gradients, such as a metric or a Hessian's leading part: J^-T T J^-1.
  void TransformGradientTensor(double tensor[9]) const;

private:
  double J[3][3];
  double InverseTransposed[3][3];
};

/// What an array holds, and so how it is carried.
enum class TransformationRule
{
  None,
  Tangent,
  Gradient,
  Normal
};

/// A copy of @a array carried tuple by tuple by the Jacobians of @a jacobians (9 components).
/// Arrays of 3 components are vectors, of 9 tensors (row-major), of 6 symmetric tensors in VTK's
/// order XX, YY, ZZ, XY, YZ, XZ. Integers become doubles. Null if the rule does not apply to the
/// array, or if it has another number of tuples.
vtkSmartPointer<vtkDataArray> TransformArray(
  vtkDataArray* array, vtkDoubleArray* jacobians, TransformationRule rule);

/// Replaces arrays of @a output that are also in @a input by their transformed copies, which keep
/// the arrays' roles as active attributes. @a ruleOf gives the rule for an array of @a input.
void TransformAttributes(vtkDataSetAttributes* input, vtkDataSetAttributes* output,
  vtkDoubleArray* jacobians, const std::function<TransformationRule(vtkDataArray*)>& ruleOf);

} // namespace homeomorphism

#endif
