// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file CompositeData.h
/// Conversion of the data sets of a tree.

#ifndef homeomorphism_CompositeData_h
#define homeomorphism_CompositeData_h

#include "vtkAlgorithm.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataSet.h"
#include "vtkInformation.h"
#include "vtkInformationStringKey.h"
#include "vtkSmartPointer.h"

#include <string>

namespace homeomorphism
{

/// Fills @a output, a tree of the same structure, with convert(leaf) for each data set of @a input.
/// The progress of each conversion is a part of the total progress.
template <typename Convert>
void ConvertLeaves(
  vtkAlgorithm* self, vtkCompositeDataSet* input, vtkCompositeDataSet* output, Convert&& convert)
{
  output->CopyStructure(input);
  const auto iterator = vtkSmartPointer<vtkCompositeDataIterator>::Take(input->NewIterator());
  int leaves = 0;
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    ++leaves;
  }
  const double shift = self->GetProgressShift();
  const double scale = self->GetProgressScale();
  int done = 0;
  for (iterator->InitTraversal(); !iterator->IsDoneWithTraversal(); iterator->GoToNextItem())
  {
    self->SetProgressShiftScale(shift + scale * done++ / leaves, scale / leaves);
    if (auto* leaf = vtkDataSet::SafeDownCast(iterator->GetCurrentDataObject()))
    {
      const vtkSmartPointer<vtkDataSet> converted = convert(leaf);
      output->SetDataSet(iterator, converted);
    }
    else
    {
      const char* name = iterator->HasCurrentMetaData() &&
          iterator->GetCurrentMetaData()->Has(vtkCompositeDataSet::NAME())
        ? iterator->GetCurrentMetaData()->Get(vtkCompositeDataSet::NAME())
        : nullptr;
      vtkWarningWithObjectMacro(self, << "Block " << iterator->GetCurrentFlatIndex()
                                      << (name ? std::string(" (") + name + ")" : "") << " is a "
                                      << iterator->GetCurrentDataObject()->GetClassName()
                                      << ", not a data set; it is left out.");
    }
  }
  self->SetProgressShiftScale(shift, scale);
}

} // namespace homeomorphism

#endif
