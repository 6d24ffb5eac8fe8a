// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "AttributeTransformation.h"

#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkMath.h"
#include "vtkSMPTools.h"

#include <algorithm>
#include <vector>

namespace homeomorphism
{
namespace
{

/// A T A^T.
void Conjugate(const double a[3][3], double tensor[9])
{
  double t[3][3];
  double transposed[3][3];
  std::copy(tensor, tensor + 9, &t[0][0]);
  vtkMath::Transpose3x3(a, transposed);
  vtkMath::Multiply3x3(a, t, t);
  vtkMath::Multiply3x3(t, transposed, t);
  std::copy(&t[0][0], &t[0][0] + 9, tensor);
}

/// The positions of the entries of a symmetric tensor in VTK's order.
constexpr int SymmetricEntry[9] = { 0, 3, 5, 3, 1, 4, 5, 4, 2 };

} // namespace

TensorTransformation::TensorTransformation(const double jacobian[9])
{
  std::copy(jacobian, jacobian + 9, &this->J[0][0]);
  vtkMath::Invert3x3(this->J, this->InverseTransposed);
  vtkMath::Transpose3x3(this->InverseTransposed, this->InverseTransposed);
}

void TensorTransformation::TransformTangent(double vector[3]) const
{
  vtkMath::Multiply3x3(this->J, vector, vector);
}

void TensorTransformation::TransformGradient(double vector[3]) const
{
  vtkMath::Multiply3x3(this->InverseTransposed, vector, vector);
}

void TensorTransformation::TransformNormal(double vector[3]) const
{
  this->TransformGradient(vector);
  vtkMath::Normalize(vector);
}

void TensorTransformation::TransformTangentTensor(double tensor[9]) const
{
  Conjugate(this->J, tensor);
}

void TensorTransformation::TransformGradientTensor(double tensor[9]) const
{
  Conjugate(this->InverseTransposed, tensor);
}

vtkSmartPointer<vtkDataArray> TransformArray(
  vtkDataArray* array, vtkDoubleArray* jacobians, TransformationRule rule)
{
  const int components = array->GetNumberOfComponents();
  const bool isVector = components == 3;
  const bool isTensor = components == 6 || components == 9;
  if (rule == TransformationRule::None || !(isVector || isTensor) ||
    (rule == TransformationRule::Normal && !isVector) ||
    array->GetNumberOfTuples() != jacobians->GetNumberOfTuples())
  {
    return nullptr;
  }
  const vtkIdType count = array->GetNumberOfTuples();
  // A transformed integer vector is not integral.
  const int type = array->GetDataType() == VTK_FLOAT ? VTK_FLOAT : VTK_DOUBLE;
  const auto result = vtkSmartPointer<vtkDataArray>::Take(vtkDataArray::CreateDataArray(type));
  result->SetName(array->GetName());
  result->SetNumberOfComponents(components);
  result->SetNumberOfTuples(count);
  for (int component = 0; component < components && array->HasAComponentName(); ++component)
  {
    result->SetComponentName(component, array->GetComponentName(component));
  }

  vtkSMPTools::For(0, count, [&](vtkIdType begin, vtkIdType end) {
    for (vtkIdType i = begin; i < end; ++i)
    {
      const TensorTransformation transformation(jacobians->GetPointer(9 * i));
      double tuple[9];
      array->GetTuple(i, tuple);
      if (isVector)
      {
        switch (rule)
        {
          case TransformationRule::Normal:
            transformation.TransformNormal(tuple);
            break;
          case TransformationRule::Gradient:
            transformation.TransformGradient(tuple);
            break;
          default:
            transformation.TransformTangent(tuple);
        }
      }
      else
      {
        double full[9];
        for (int entry = 0; entry < 9; ++entry)
        {
          full[entry] = tuple[components == 6 ? SymmetricEntry[entry] : entry];
        }
        if (rule == TransformationRule::Gradient)
        {
          transformation.TransformGradientTensor(full);
        }
        else
        {
          transformation.TransformTangentTensor(full);
        }
        for (int entry = 0; entry < 9; ++entry)
        {
          tuple[components == 6 ? SymmetricEntry[entry] : entry] = full[entry];
        }
      }
      result->SetTuple(i, tuple);
    }
  });
  return result;
}

void TransformAttributes(vtkDataSetAttributes* input, vtkDataSetAttributes* output,
  vtkDoubleArray* jacobians, const std::function<TransformationRule(vtkDataArray*)>& ruleOf)
{
  for (int i = 0; i < input->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* array = input->GetArray(i);
    const vtkSmartPointer<vtkDataArray> transformed =
      array ? TransformArray(array, jacobians, ruleOf(array)) : nullptr;
    if (!transformed)
    {
      continue;
    }
    // Replaces the passed array and keeps its roles.
    std::vector<int> roles;
    for (int role = 0; role < vtkDataSetAttributes::NUM_ATTRIBUTES; ++role)
    {
      if (input->GetAbstractAttribute(role) == array)
      {
        roles.push_back(role);
      }
    }
    for (int passed = output->GetNumberOfArrays() - 1; passed >= 0; --passed)
    {
      if (output->GetAbstractArray(passed) == array)
      {
        output->RemoveArray(passed);
      }
    }
    const int index = output->AddArray(transformed);
    for (const int role : roles)
    {
      output->SetActiveAttribute(index, role);
    }
  }
}

} // namespace homeomorphism
