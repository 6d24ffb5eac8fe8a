// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Fixtures/Triangles.h"

#include "Mesh/BoxTree.h"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

using namespace homeomorphism;
using homeomorphism_test::Random;

namespace
{

template <int Dimension>
Box<Dimension> RandomBox(Random& random, double size)
{
  std::array<double, Dimension> center;
  std::generate(center.begin(), center.end(), [&random]() { return random.Uniform(-1.0, 1.0); });
  return Box<Dimension>::Around(center, size * random.Uniform());
}

template <int Dimension>
void ExpectAllFound(int count)
{
  Random random(21 + count);
  std::vector<Box<Dimension>> boxes(static_cast<std::size_t>(count));
  std::generate(boxes.begin(), boxes.end(), [&]() { return RandomBox<Dimension>(random, 0.02); });
  std::vector<TriangleIndex> triangles(boxes.size());
  std::iota(triangles.begin(), triangles.end(), 0);
  BoxTree<Dimension> tree;
  tree.Build(triangles, [&boxes](TriangleIndex t) { return boxes[t]; });
  int offered = 0;
  for (int query = 0; query < 200; ++query)
  {
    const Box<Dimension> box = RandomBox<Dimension>(random, 0.1);
    std::multiset<TriangleIndex> found;
    tree.Search(box, [&found](TriangleIndex t) {
      found.insert(t);
      return true;
    });
    offered += static_cast<int>(found.size());
    for (TriangleIndex t = 0; t < count; ++t)
    {
      // Exactly the triangles whose boxes meet the query are found, each once.
      EXPECT_GE(found.count(t), boxes[t].Meets(box) ? 1u : 0u);
      EXPECT_LE(found.count(t), 1u);
    }
  }
  EXPECT_TRUE(count < 1000 || offered < 200 * count / 4) << "no faster than to look at all boxes";
}

} // namespace

TEST(BoxTree, FindsAllTrianglesThatMeetABox)
{
  for (const int count : { 0, 1, 2, 4, 5, 17, 1000 })
  {
    ExpectAllFound<2>(count);
    ExpectAllFound<3>(count);
  }
}

TEST(BoxTree, StopsWhenAVisitReturnsFalse)
{
  const auto box = Box<2>::Around({ 0.0, 0.0 }, 1.0);
  BoxTree<2> tree;
  tree.Build({ 0, 1, 2, 3, 4, 5, 6, 7 }, [&box](TriangleIndex) { return box; });
  int visits = 0;
  tree.Search(box, [&visits](TriangleIndex) { return ++visits < 3; });
  EXPECT_EQ(visits, 3);
}

// Nodes are stored as floats: rounding may only enlarge boxes.
TEST(BoxTree, RoundsBoxesOutward)
{
  const double edge = 1.0 + 0x1p-40;
  BoxTree<2> tree;
  tree.Build({ 0, 1 }, [edge](TriangleIndex t) {
    Box<2> box;
    box.Add({ t * 10.0, 0.0 });
    box.Add({ t * 10.0 + edge, edge });
    return box;
  });
  int visits = 0;
  tree.Search(Box<2>::Around({ edge, edge }, 0.0), [&visits](TriangleIndex t) {
    visits += t == 0;
    return true;
  });
  EXPECT_EQ(visits, 1);
}
