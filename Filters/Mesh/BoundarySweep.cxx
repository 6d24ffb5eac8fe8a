// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "BoundarySweep.h"

#include "Kernel/ExactSign.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>
#include <tuple>
#include <utility>

namespace homeomorphism
{
namespace
{

bool IsBefore(const Vector2& a, const Vector2& b)
{
  return std::tie(a.x, a.y) < std::tie(b.x, b.y);
}

bool IsEqual(const Vector2& a, const Vector2& b)
{
  return a.x == b.x && a.y == b.y;
}

/// 1 if the point is above the segment's line (to the left, seen from its start), -1 if below.
int SideOf(const BoundarySegment& segment, const Vector2& point)
{
  return Orientation(segment.Start, segment.End, point);
}

/// A segment that the sweep line meets, and the number of triangles just above it.
struct Crossed
{
  const BoundarySegment* Segment;
  int CoverAbove;
};

/// The order from bottom to top along the sweep line, for segments that do not cross. Segments on
/// one line are equivalent.
struct BottomToTop
{
  using is_transparent = void;

  bool operator()(const Crossed& a, const Crossed& b) const
  {
    return Compare(*a.Segment, *b.Segment) < 0;
  }
  bool operator()(const Crossed& a, const Vector2& point) const
  {
    return SideOf(*a.Segment, point) > 0;
  }
  bool operator()(const Vector2& point, const Crossed& a) const
  {
    return SideOf(*a.Segment, point) < 0;
  }

  /// Negative if @a a is below @a b.
  static int Compare(const BoundarySegment& a, const BoundarySegment& b)
  {
    if (IsBefore(b.Start, a.Start))
    {
      return -Compare(b, a);
    }
    const int start = SideOf(a, b.Start);
    return start != 0 ? -start : -SideOf(a, b.End);
  }
};

class Sweep
{
public:
  /// @a starting are the segments that start at the point. Returns false if the sweep must end.
  bool Advance(const Vector2& point, std::vector<const BoundarySegment*> starting)
  {
    // Remove all segments through the point. Those that continue beyond it are inserted again.
    const auto through = this->Status.equal_range(point);
    const BoundarySegment* passing = nullptr;
    for (auto i = through.first; i != through.second; ++i)
    {
      const BoundarySegment* segment = i->Segment;
      if (IsEqual(segment->End, point))
      {
        continue;
      }
      if (passing && SideOf(*passing, segment->End) != 0)
      {
        return false;
      }
      passing = segment;
      starting.push_back(segment);
    }
    const auto above = this->Status.erase(through.first, through.second);
    const bool hasBelow = above != this->Status.begin();
    const bool hasAbove = above != this->Status.end();
    const auto below = hasBelow ? std::prev(above) : above;

    std::sort(starting.begin(), starting.end(),
      [&point](const BoundarySegment* a, const BoundarySegment* b) {
        return Orientation(point, a->End, b->End) > 0;
      });
    int cover = hasBelow ? below->CoverAbove : 0;
    for (std::size_t i = 0; i < starting.size(); ++i)
    {
      cover += starting[i]->Change;
      this->Status.insert(above, Crossed{ starting[i], cover });
      // There is no area between overlapping collinear segments.
      const bool last =
        i + 1 == starting.size() || Orientation(point, starting[i]->End, starting[i + 1]->End) != 0;
      if (last && cover != 0 && cover != 1)
      {
        return false;
      }
    }
    if (cover != (hasAbove ? above->CoverAbove - above->Segment->Change : 0))
    {
      return false;
    }
    if (starting.empty())
    {
      return !(hasBelow && hasAbove) || !Cross(*below->Segment, *above->Segment);
    }
    return !(hasBelow && Cross(*below->Segment, *starting.front())) &&
      !(hasAbove && Cross(*starting.back(), *above->Segment));
  }

private:
  using Segments = std::multiset<Crossed, BottomToTop>;

  /// Whether two segments cross, the first of which is not above the other where both begin.
  static bool Cross(const BoundarySegment& below, const BoundarySegment& above)
  {
    return IsBefore(above.End, below.End) ? SideOf(below, above.End) < 0
                                          : SideOf(above, below.End) > 0;
  }

  Segments Status;
};

} // namespace

bool CoversAtMostOnce(std::vector<BoundarySegment> segments)
{
  std::sort(segments.begin(), segments.end(),
    [](const BoundarySegment& a, const BoundarySegment& b) { return IsBefore(a.Start, b.Start); });
  std::vector<Vector2> points;
  points.reserve(2 * segments.size());
  for (const BoundarySegment& segment : segments)
  {
    points.push_back(segment.Start);
    points.push_back(segment.End);
  }
  std::sort(points.begin(), points.end(), IsBefore);
  points.erase(std::unique(points.begin(), points.end(), IsEqual), points.end());

  Sweep sweep;
  std::size_t next = 0;
  for (const Vector2& point : points)
  {
    std::vector<const BoundarySegment*> starting;
    for (; next < segments.size() && IsEqual(segments[next].Start, point); ++next)
    {
      starting.push_back(&segments[next]);
    }
    if (!sweep.Advance(point, std::move(starting)))
    {
      return false;
    }
  }
  return true;
}

} // namespace homeomorphism
