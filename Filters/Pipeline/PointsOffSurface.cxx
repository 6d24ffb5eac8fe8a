// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "PointsOffSurface.h"

#include "Mesh/MeshValidation.h"

#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkMath.h"
#include "vtkObject.h"
#include "vtkPointData.h"
#include "vtkUnsignedCharArray.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <vector>

namespace homeomorphism
{

void WarnOfPointsOffSurface(vtkObject* self, const Homeomorphism& map, Domain domain,
  vtkDataSet* data, vtkUnsignedCharArray* mask)
{
  const MeshGeometry& geometry = map.GetPair().GetGeometry(domain);
  if (geometry.IsPlanar())
  {
    return;
  }
  std::vector<vtkIdType> outside;
  // Exclude hidden points, which count as outside regardless of their positions.
  vtkUnsignedCharArray* ghosts = GhostsOf(data->GetPointData(), mask->GetNumberOfTuples());
  for (vtkIdType i = 0; i < mask->GetNumberOfTuples(); ++i)
  {
    if (!mask->GetValue(i) &&
      !(ghosts && (ghosts->GetValue(i) & vtkDataSetAttributes::HIDDENPOINT)))
    {
      outside.push_back(i);
    }
  }
  constexpr double nearby = 1e-3;
  constexpr std::size_t most = 1000;
  const std::size_t step = std::max<std::size_t>(1, outside.size() / most);
  double largest = 0.0;
  bool isAny = false;
  TriangleIndex hint = -1;
  for (std::size_t i = 0; i < outside.size(); i += step)
  {
    double point[3];
    data->GetPoint(outside[i], point);
    const SurfacePoint nearest = map.Locate(domain, point, nearby * geometry.GetDiagonal(), hint);
    if (nearest.Triangle < 0)
    {
      continue;
    }
    hint = nearest.Triangle;
    double foot[3];
    geometry.FromNormalized(
      geometry.FromFrame(nearest.Triangle, { nearest.Point.InPlane, 0.0 }), foot);
    largest = std::max(largest, std::sqrt(vtkMath::Distance2BetweenPoints(point, foot)));
    isAny = true;
  }
  if (!isAny)
  {
    return;
  }
  // Two digits, rounded up.
  const double relative = largest * geometry.GetScale() / geometry.GetDiagonal();
  const double unit = std::pow(10.0, std::floor(std::log10(relative)) - 1.0);
  std::ostringstream tolerance;
  tolerance << std::setprecision(2) << std::ceil(1.01 * relative / unit) * unit;
  vtkWarningWithObjectMacro(self, << outside.size()
                                  << " points are outside; some of them are only slightly off the "
                                     "surface, by up to "
                                  << largest << ". A Tolerance of " << tolerance.str()
                                  << " includes them.");
}

} // namespace homeomorphism
