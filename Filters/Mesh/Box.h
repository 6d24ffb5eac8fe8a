// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Box.h
/// Axis-parallel bounding boxes.

#ifndef homeomorphism_Box_h
#define homeomorphism_Box_h

#include <algorithm>
#include <array>
#include <limits>

namespace homeomorphism
{

/// An axis-parallel box in the plane or in 3-space. Empty by default.
template <int Dimension>
struct Box
{
  std::array<double, Dimension> Least;
  std::array<double, Dimension> Greatest;

  Box()
  {
    this->Least.fill(std::numeric_limits<double>::infinity());
    this->Greatest.fill(-std::numeric_limits<double>::infinity());
  }

  void Add(const std::array<double, Dimension>& point)
  {
    for (int axis = 0; axis < Dimension; ++axis)
    {
      this->Least[axis] = std::min(this->Least[axis], point[axis]);
      this->Greatest[axis] = std::max(this->Greatest[axis], point[axis]);
    }
  }

  void Add(const Box& other)
  {
    this->Add(other.Least);
    this->Add(other.Greatest);
  }

  bool Meets(const Box& other) const
  {
    for (int axis = 0; axis < Dimension; ++axis)
    {
      if (this->Least[axis] > other.Greatest[axis] || other.Least[axis] > this->Greatest[axis])
      {
        return false;
      }
    }
    return true;
  }

  /// The box of all points at most @a distance from @a point in each coordinate.
  static Box Around(const std::array<double, Dimension>& point, double distance)
  {
    Box box;
    for (int axis = 0; axis < Dimension; ++axis)
    {
      box.Least[axis] = point[axis] - distance;
      box.Greatest[axis] = point[axis] + distance;
    }
    return box;
  }
};

} // namespace homeomorphism

#endif
