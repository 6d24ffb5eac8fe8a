// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "vtkHomeomorphismTransform.h"
#include "vtkNew.h"

#include <gtest/gtest.h>

TEST(Placeholder, TransformIsIdentity)
{
  vtkNew<vtkHomeomorphismTransform> transform;
  const double in[3] = { 1.0, 2.0, 3.0 };
  double out[3];
  transform->TransformPoint(in, out);
  for (int i = 0; i < 3; ++i)
  {
    EXPECT_EQ(out[i], in[i]);
  }
}
