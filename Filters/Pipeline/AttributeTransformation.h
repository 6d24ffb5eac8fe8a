// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file AttributeTransformation.h
/// Transformation of vectors, normals and tensors by the Jacobian of a map.

#ifndef homeomorphism_AttributeTransformation_h
#define homeomorphism_AttributeTransformation_h

#include "vtkSmartPointer.h"

#include <functional>

class vtkDataArray;
class vtkDataSetAttributes;
class vtkDoubleArray;

namespace homeomorphism
{

/// Transforms values at a point with the Jacobian J (row-major, invertible). Outside the domain, J
/// is NaN, and so are all results.
class TensorTransformation
{
public:
  explicit TensorTransformation(const double jacobian[9]);

  /// A tangent vector, such as a velocity or a displacement: J v.
  void TransformTangent(double vector[3]) const;
  /// A gradient: J^-T g, which preserves its product with tangent vectors.
  void TransformGradient(double vector[3]) const;
  /// A unit normal: J^-T n, normalized. A zero vector stays zero.
  void TransformNormal(double vector[3]) const;
  /// A contravariant tensor, such as a diffusion tensor: J T J^T.
  void TransformTangentTensor(double tensor[9]) const;
  /// A covariant tensor, such as a metric or the leading part of a Hessian: J^-T T J^-1.
  void TransformGradientTensor(double tensor[9]) const;

private:
  double J[3][3];
  double InverseTransposed[3][3];
};

/// The transformation rules of arrays.
enum class TransformationRule
{
  None,
  Tangent,
  Gradient,
  Normal
};

/// A copy of @a array, transformed tuple by tuple by the Jacobians of @a jacobians (9 components).
/// Arrays of 3 components are vectors, arrays of 9 components are tensors (row-major), and arrays
/// of 6 components are symmetric tensors in VTK's order XX, YY, ZZ, XY, YZ, XZ. Integers become
/// doubles. Null if the rule does not apply to the array, or if the numbers of tuples differ.
vtkSmartPointer<vtkDataArray> TransformArray(
  vtkDataArray* array, vtkDoubleArray* jacobians, TransformationRule rule);

/// Replaces arrays of @a output that are also in @a input by their transformed copies, which keep
/// the arrays' roles as active attributes. @a ruleOf gives the rule for an array of @a input.
void TransformAttributes(vtkDataSetAttributes* input, vtkDataSetAttributes* output,
  vtkDoubleArray* jacobians, const std::function<TransformationRule(vtkDataArray*)>& ruleOf);

} // namespace homeomorphism

#endif
