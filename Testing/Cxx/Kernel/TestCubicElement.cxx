// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The cubic element and its certificate: agreement with exact rational numbers, computed from the
// definition of the element by Testing/Reference/cubic_element.py, and properties of all elements.

#include "Fixtures/Tables.h"
#include "Fixtures/Triangles.h"

#include "Kernel/CubicElement.h"
#include "Kernel/LinearProgram.h"
#include "Kernel/Simd/BendingBatch.h"
#include "Mesh/Vector3.h"

namespace
{

using namespace homeomorphism_test;

CubicElement ToElement(const fixtures::Row& row)
{
  const auto vector = [&row](const std::string& name) {
    return Vector2{ row.at(name + "x"), row.at(name + "y") };
  };
  const auto numbered = [&row](const std::string& name, int i) {
    return Vector2{ row.at(name + std::to_string(i)), row.at(name + std::to_string(i + 1)) };
  };
  CubicElement element{ { vector("a"), vector("b"), vector("c") }, { vector("x"), vector("y") }, {},
    {} };
  for (int i = 0; i < 3; ++i)
  {
    element.Values[i] = numbered("v", 2 * i);
    element.Gradients[i] = { numbered("g", 4 * i), numbered("g", 4 * i + 2) };
  }
  return element;
}

/// Random elements and what they consist of.
struct Elements : fixtures::Random
{
  using fixtures::Random::Random;

  homeomorphism::Vector3 Vector3() { return this->fixtures::Random::Vector(); }
  Vector2 Vector(double size) { return { this->Uniform(-size, size), this->Uniform(-size, size) }; }
  Matrix2 Matrix(double size) { return { this->Vector(size), this->Vector(size) }; }
  std::array<Vector2, 3> Triangle()
  {
    std::array<Vector2, 3> p;
    do
    {
      p = { this->Vector(1.0), this->Vector(1.0), this->Vector(1.0) };
    } while (!(Cross(p[1] - p[0], p[2] - p[0]) > 0.1));
    return p;
  }

  /// An element whose derivative differs from that of its affine map by up to @a change.
  CubicElement Element(double change)
  {
    CubicElement element{ this->Triangle(), this->Matrix(1.0), {}, {} };
    while (!(element.Affine.Determinant() > 0.05))
    {
      element.Affine = this->Matrix(1.0);
    }
    for (int i = 0; i < 3; ++i)
    {
      element.Values[i] = this->Vector(change);
      element.Gradients[i] = this->Matrix(change);
    }
    return element;
  }
};

Vector2 PointAt(const std::array<Vector2, 3>& p, const Barycentric& l)
{
  return l[0] * p[0] + l[1] * p[1] + l[2] * p[2];
}

} // anonymous namespace

/// The value and the derivative of an element without its affine map.
struct Value
{
  Vector2 Point;
  Matrix2 Derivative;

  Value(const CubicElement& element, const Barycentric& l)
  {
    Evaluate(element, GetOrdinates(element), l, this->Point, this->Derivative);
  }
};

TEST(CubicElement, AgreesWithRationalNumbers)
{
  const std::vector<fixtures::Row> rows =
    fixtures::ReadTable(REFERENCE_DATA_DIR "/cubic_element.csv");
  ASSERT_GE(rows.size(), 45u);
  for (const fixtures::Row& row : rows)
  {
    const CubicElement element = ToElement(row);
    const auto& [a, b, c] = element.Points;
    const double size = std::max({ Norm(b - a), Norm(c - b), Norm(a - c) });
    // The point of a piece with these coordinates, in the triangle.
    const int k = static_cast<int>(row.at("piece"));
    const double third = row.at("l2") / 3.0;
    Barycentric l;
    l[k] = third;
    l[NextCorner(k)] = row.at("l0") + third;
    l[PreviousCorner(k)] = row.at("l1") + third;
    const Value value(element, l);
    EXPECT_NEAR(value.Point.x, row.at("fx"), 1e-13 * size);
    EXPECT_NEAR(value.Point.y, row.at("fy"), 1e-13 * size);
    const DeterminantCoefficients found = GetDeterminantCoefficients(element);
    DeterminantCoefficients exact;
    for (std::size_t n = 0; n < exact.size(); ++n)
    {
      exact[n] = row.at("c" + std::to_string(n));
    }
    const auto [low, high] = std::minmax_element(exact.begin(), exact.end());
    const double least = *low;
    const double greatest = std::max(std::abs(least), std::abs(*high));
    for (std::size_t n = 0; n < exact.size(); ++n)
    {
      EXPECT_NEAR(found[n], exact[n], 1e-12 * greatest);
    }
    // Never above the exact coefficient, and close to it.
    const double bound = LeastDeterminant(element, 0.0, 0);
    EXPECT_LE(bound, least);
    EXPECT_GE(bound, least - 1e-9 * greatest);
  }
}

TEST(CubicElement, CertifiesNoneThatIsNotPositive)
{
  // Elements all of whose coefficients are zero to rounding: the map x -> (L x) + u g(x) with L
  // singular in the direction of u, and a change by a few parts in 10^14.
  Elements random(1);
  int missed = 0;
  for (int n = 0; n < 100000; ++n)
  {
    CubicElement element;
    element.Points = random.Triangle();
    const Vector2 u = random.Vector(1.0);
    // Multiples of u by integers up to 2^20 over 2^20: exact in doubles.
    const auto multiple = [&] {
      const double s = std::floor(random.Uniform(-1048576.0, 1048576.0)) / 1048576.0;
      return Vector2{ s * std::ldexp(std::round(std::ldexp(u.x, 20)), -20),
        s * std::ldexp(std::round(std::ldexp(u.y, 20)), -20) };
    };
    element.Affine = { multiple(), multiple() };
    for (int i = 0; i < 3; ++i)
    {
      element.Values[i] = multiple();
      element.Gradients[i] = { multiple(), multiple() };
    }
    // det f' is exactly zero everywhere.
    EXPECT_FALSE(LeastDeterminant(element, 0.0, 2) > 0.0);
    // An affine map next to it, whose determinant is known exactly.
    CubicElement affine;
    affine.Points = element.Points;
    const double excess = (n % 2 == 0 ? 1.0 : -1.0) * std::exp2(random.Uniform(-46.0, -33.0));
    affine.Affine = { { 1.0, 1.0 }, { 1.0, 1.0 + excess } };
    const double exact = affine.Affine.ImageOfY.y - 1.0;
    const bool isCertified = LeastDeterminant(affine, 0.0, 2) > 0.0;
    EXPECT_FALSE(isCertified && exact <= 0.0);
    missed += exact > 1e-12 && !isCertified ? 1 : 0;
  }
  // One in a hundred of those whose determinant is above 1e-12.
  EXPECT_LT(missed, 270);
}

TEST(CubicElement, ReproducesQuadraticMaps)
{
  Elements random(3);
  for (int n = 0; n < 200; ++n)
  {
    const Vector2 xx = random.Vector(1.0);
    const Vector2 xy = random.Vector(1.0);
    const Vector2 yy = random.Vector(1.0);
    const auto value = [&](const Vector2& p) {
      return p.x * p.x * xx + p.x * p.y * xy + p.y * p.y * yy;
    };
    const auto derivative = [&](const Vector2& p) {
      return Matrix2{ 2.0 * p.x * xx + p.y * xy, p.x * xy + 2.0 * p.y * yy };
    };
    CubicElement element{ random.Triangle(), {}, {}, {} };
    for (int i = 0; i < 3; ++i)
    {
      element.Values[i] = value(element.Points[i]);
      element.Gradients[i] = derivative(element.Points[i]);
    }
    const Barycentric l = random.Weights();
    const Vector2 p = PointAt(element.Points, l);
    const Value at(element, l);
    EXPECT_LT(Norm(at.Point - value(p)), 1e-13);
    EXPECT_LT(Norm(at.Derivative - derivative(p)), 1e-11);
    // Its second derivatives are constant: so is what is integrated.
    const BendingMatrix bending = GetBendingMatrix(element.Points);
    double energy = 0.0;
    std::vector<Vector2> data;
    for (int i = 0; i < 3; ++i)
    {
      const Matrix2& gradient = element.Gradients[i];
      data.insert(data.end(), { element.Values[i], gradient.ImageOfX, gradient.ImageOfY });
    }
    for (std::size_t i = 0; i < 81; ++i)
    {
      energy += bending[i / 9][i % 9] * Dot(data[i / 9], data[i % 9]);
    }
    const double area =
      0.5 * Cross(element.Points[1] - element.Points[0], element.Points[2] - element.Points[0]);
    const double expected = area * (4.0 * Dot(xx, xx) + 2.0 * Dot(xy, xy) + 4.0 * Dot(yy, yy));
    EXPECT_NEAR(energy, expected, 1e-8 * expected);
  }
}

TEST(CubicElement, BendingOfManyTrianglesIsThatOfEach)
{
  Elements random(5);
  BendingBatch batch;
  std::array<std::array<Vector2, 3>, BendingBatch::Size> triangles;
  for (int n = 0; n < BendingBatch::Size; ++n)
  {
    triangles[static_cast<std::size_t>(n)] = random.Triangle();
    batch.SetCorners(n, triangles[static_cast<std::size_t>(n)]);
  }
  batch.SetMatrices();
  for (int n = 0; n < BendingBatch::Size; ++n)
  {
    const BendingMatrix matrix = GetBendingMatrix(triangles[static_cast<std::size_t>(n)]);
    double tolerance = 0.0;
    for (const std::array<double, 9>& row : matrix)
    {
      tolerance = std::max(tolerance, 1e-13 * *std::max_element(row.begin(), row.end()));
    }
    for (int k = 0; k < 3; ++k)
    {
      const std::size_t here = 3 * static_cast<std::size_t>(k) + 1;
      const std::size_t start = 3 * static_cast<std::size_t>(NextCorner(k)) + 1;
      const std::size_t end = 3 * static_cast<std::size_t>(PreviousCorner(k)) + 1;
      for (const auto& [a, b] : { std::pair{ 0u, 0u }, { 0u, 1u }, { 1u, 0u }, { 1u, 1u } })
      {
        EXPECT_NEAR(batch.Diagonal[k][a + b][n], matrix[here + a][here + b], tolerance);
        EXPECT_NEAR(batch.Edge[k][2 * a + b][n], matrix[start + a][end + b], tolerance);
      }
    }
  }
}

TEST(LinearProgram, FindsTheBestCorner)
{
  // Against all intersections of three planes.
  Elements random(6);
  int solved = 0;
  for (int n = 0; n < 300; ++n)
  {
    std::vector<HalfSpace<3>> halfSpaces;
    for (int i = 0; i < 12; ++i)
    {
      const bool through = n % 3 == 0;
      halfSpaces.push_back(
        { random.Vector3(), through ? random.Uniform(-0.3, 0.3) : random.Uniform(0.0, 0.5) });
    }
    const Vector3 objective = random.Vector3();
    std::vector<HalfSpace<3>> all = halfSpaces;
    for (const double sign : { -1.0, 1.0 })
    {
      all.insert(all.end(),
        { { { sign, 0.0, 0.0 }, 1.0 }, { { 0.0, sign, 0.0 }, 1.0 }, { { 0.0, 0.0, sign }, 1.0 } });
    }
    double best = -fixtures::Infinity;
    for (auto a = all.begin(); a != all.end(); ++a)
    {
      for (auto b = all.begin(); b != a; ++b)
      {
        for (auto c = all.begin(); c != b; ++c)
        {
          // Cramer's rule.
          const std::array<Vector3, 3> rows{ Cross3(b->Normal, c->Normal),
            Cross3(c->Normal, a->Normal), Cross3(a->Normal, b->Normal) };
          const double d = Dot3(a->Normal, rows[0]);
          Vector3 x;
          for (std::size_t i = 0; i < 3; ++i)
          {
            x[i] = (a->Limit * rows[0][i] + b->Limit * rows[1][i] + c->Limit * rows[2][i]) / d;
          }
          if (std::abs(d) > 1e-9 &&
            std::all_of(all.begin(), all.end(),
              [&x](const HalfSpace<3>& h) { return Dot3(h.Normal, x) <= h.Limit + 1e-9; }))
          {
            best = std::max(best, Dot3(objective, x));
          }
        }
      }
    }
    Vector3 x;
    const bool found = MaximizeLinear<3>(objective, halfSpaces, { 1.0, 1.0, 1.0 }, x);
    ASSERT_EQ(found, std::isfinite(best)) << n;
    solved += found;
    EXPECT_TRUE(!found || std::abs(Dot3(objective, x) - best) < 1e-6) << n;
  }
  EXPECT_GT(solved, 200);
}

TEST(CubicElement, RightAnglesChangeNothingButRounding)
{
  Elements random(8);
  for (int n = 0; n < 500; ++n)
  {
    const double leg = random.Uniform(0.5, 2.0);
    const double height =
      n % 2 == 0 ? random.Uniform(0.3, 3.0) : std::exp2(random.Uniform(-20.0, 0.0));
    const double angle = random.Uniform(-3.0, 3.0);
    const Vector2 tangent{ std::cos(angle), std::sin(angle) };
    const bool left = n % 4 < 2;
    const Vector2 normal =
      left ? Vector2{ -tangent.y, tangent.x } : Vector2{ tangent.y, -tangent.x };
    CubicElement element{ {}, random.Matrix(1.0), {}, {}, {} };
    // Start, right angle and third corner, counterclockwise.
    const int start = n % 3;
    const int corner = left ? NextCorner(start) : PreviousCorner(start);
    const int third = 3 - start - corner;
    element.Points[corner] = leg * tangent;
    element.Points[third] = leg * tangent + height * normal;
    for (int i = 0; i < 3; ++i)
    {
      element.Values[i] = height * random.Vector(1.0);
      element.Gradients[i] = random.Matrix(1.0);
    }
    CubicElement right = element;
    right.Right = { corner, start, tangent, normal, leg, height, {}, {} };
    for (int i = 0; i < 3; ++i)
    {
      right.Right.ByTangent[i] = element.Gradients[i] * tangent;
      right.Right.ByNormal[i] = element.Gradients[i] * normal;
    }
    const DeterminantCoefficients a = GetDeterminantCoefficients(element);
    const DeterminantCoefficients b = GetDeterminantCoefficients(right);
    for (std::size_t k = 0; k < a.size(); ++k)
    {
      EXPECT_NEAR(a[k], b[k], 1e-12 / height / height);
    }
    const Barycentric l = random.Weights();
    const Value one(element, l);
    const Value other(right, l);
    EXPECT_LT(Norm(one.Point - other.Point), 1e-14 / std::min(1.0, height));
    EXPECT_LT(Norm(one.Derivative - other.Derivative), 1e-13 / height / height);
  }
}

TEST(CubicElement, ThinRightAnglesReproduceQuadratics)
{
  Elements random(34);
  for (int n = 0; n < 500; ++n)
  {
    const double leg = random.Uniform(0.5, 2.0);
    const double height = std::exp2(random.Uniform(-60.0, 0.0));
    const double angle = random.Uniform(-3.0, 3.0);
    const Vector2 tangent{ std::cos(angle), std::sin(angle) };
    const Vector2 normal{ -tangent.y, tangent.x };
    // By t along the tangent and u along the normal, from 0 to 1: they change alike.
    const Vector2 tt = random.Vector(1.0);
    const Vector2 tu = random.Vector(1.0);
    const Vector2 uu = random.Vector(1.0);
    const double corners[3][2] = { { 0.0, 0.0 }, { leg, 0.0 }, { leg, 1.0 } };
    const auto valueAt = [&](double t, double u) {
      return (t * t) * tt + (t * u) * tu + (u * u) * uu;
    };
    CubicElement element{ {}, {}, {}, {}, {} };
    element.Right = { 1, 0, tangent, normal, leg, height, {}, {} };
    for (int i = 0; i < 3; ++i)
    {
      const auto [t, u] = corners[i];
      element.Points[i] = t * tangent + (height * u) * normal;
      element.Values[i] = valueAt(t, u);
      element.Right.ByTangent[i] = (2.0 * t) * tt + u * tu;
      element.Right.ByNormal[i] = (1.0 / height) * (t * tu + (2.0 * u) * uu);
      element.Gradients[i] = OuterProduct(element.Right.ByTangent[i], tangent) +
        OuterProduct(element.Right.ByNormal[i], normal);
    }
    const Barycentric l = random.Weights();
    EXPECT_LT(Norm(Value(element, l).Point - valueAt(leg * (l[1] + l[2]), l[2])), 1e-13) << height;
  }
}

TEST(CubicElement, NetsAgreeWithTheElement)
{
  Elements random(21);
  for (int n = 0; n < 2000; ++n)
  {
    const CubicElement element = random.Element(0.5);
    const CubicNet net(element);
    const Barycentric l = random.Weights();
    const Value value(element, l);
    const Vector2 point = PointAt(element.Points, l);
    const Vector2 image = element.Affine * point + value.Point;
    EXPECT_LT(Norm(net(l) - image), 1e-14);
    // Newton's step brings the derivative to the residual.
    const Vector2 target = random.Vector(1.0);
    Vector2 step;
    const Vector2 residual = net.GetResidual(l, element.Points, target, step);
    EXPECT_LT(Norm(residual - (target - image)), 1e-14);
    const Matrix2 derivative = element.Affine + value.Derivative;
    EXPECT_LT(Norm(derivative * step - residual), 1e-12 * (1.0 + Norm(step)));
    const Barycentric again = BarycentricFrame(element.Points)(point);
    for (int i = 0; i < 3; ++i)
    {
      EXPECT_NEAR(again[i], l[i], 1e-13);
    }
  }
}

TEST(CubicElement, BoundsHold)
{
  Elements random(22);
  int bounded = 0;
  int positive = 0;
  for (int n = 0; n < 20000; ++n)
  {
    const CubicElement element = random.Element(std::pow(10.0, -4.0 * (n % 100) / 100.0));
    const DeterminantCoefficients c = GetDeterminantCoefficients(element);
    const double least = *std::min_element(c.begin(), c.end());
    // Without subdivision no bound is above the least coefficient.
    const double bound = LeastDeterminant(element, 0.0, 0);
    EXPECT_LE(bound, least + 1e-14 * std::abs(least));
    bounded += bound > 0.0 && bound < 0.999999 * least ? 1 : 0;
    const double subdivided = LeastDeterminant(element);
    positive += subdivided > 0.0 ? 1 : 0;
    const double displacement = GreatestDisplacement(element);
    for (int sample = 0; sample < 5; ++sample)
    {
      const Value value(element, random.Weights());
      const Matrix2 derivative = element.Affine + value.Derivative;
      EXPECT_GE(derivative.Determinant(), subdivided - 1e-13 * (1.0 + SquaredNorm(derivative)));
      EXPECT_LE(Norm(value.Point), displacement * (1.0 + 1e-13));
    }
  }
  EXPECT_GT(bounded, 2000);
  EXPECT_GT(positive, 5000);
}

TEST(CubicElement, TinyFoldsAreNotCertified)
{
  // f(x, y) = (-2 x, y), times powers of two down to where squares of the derivative's entries, or
  // products of these, underflow.
  for (int exponent = 0; exponent >= -530; exponent -= 10)
  {
    const double s = std::ldexp(1.0, exponent);
    for (const double size : { 1.0, s })
    {
      // The derivatives are as small, or the triangle.
      const double slope = s / size;
      CubicElement element;
      element.Points = { Vector2{}, Vector2{ size, 0.0 }, Vector2{ 0.0, size } };
      element.Affine = { { slope, 0.0 }, { 0.0, slope } };
      element.Values[1] = { -3.0 * s, 0.0 };
      element.Gradients.fill({ { -3.0 * slope, 0.0 }, {} });
      EXPECT_FALSE(LeastDeterminant(element) > 0.0) << exponent;
    }
  }
}
