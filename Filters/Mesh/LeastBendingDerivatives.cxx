// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Mesh/LeastBendingDerivatives.h"

#include "Kernel/Simd/BendingBatch.h"
#include "Kernel/Simd/Vectorize.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace homeomorphism
{
namespace
{

constexpr int MaximumSteps = 1000;
/// The iteration ends when the squared residual is this share of the initial one. This is about the
/// relative excess of the energy, which is not visible. The derivatives then have about a ten
/// thousandth of their initial errors. The certificate is computed from the derivatives that are
/// found, so it does not depend on this.
constexpr double EnoughResidual = 1e-10;

/// A matrix by rows that acts on the two derivatives of a component, the same for both components.
using Block = std::array<double, 4>;

Matrix2 operator*(const Block& b, const Matrix2& m)
{
  return { b[0] * m.ImageOfX + b[1] * m.ImageOfY, b[2] * m.ImageOfX + b[3] * m.ImageOfY };
}

Block Transposed(const Block& b)
{
  return { b[0], b[2], b[1], b[3] };
}

Block operator*(const Block& a, const Block& b)
{
  return { a[0] * b[0] + a[1] * b[2], a[0] * b[1] + a[1] * b[3], a[2] * b[0] + a[3] * b[2],
    a[2] * b[1] + a[3] * b[3] };
}

/// Scales each component by its own factor.
Matrix2 Scaled(const Vector2& s, const Matrix2& m)
{
  return { { s.x * m.ImageOfX.x, s.y * m.ImageOfX.y }, { s.x * m.ImageOfY.x, s.y * m.ImageOfY.y } };
}

/// Adds the inner product of two points' derivatives, separately for each component.
void AddProduct(Vector2& sum, const Matrix2& a, const Matrix2& b)
{
  sum.x += a.ImageOfX.x * b.ImageOfX.x + a.ImageOfY.x * b.ImageOfY.x;
  sum.y += a.ImageOfX.y * b.ImageOfX.y + a.ImageOfY.y * b.ImageOfY.y;
}

/// Sets the rows [begin, end) of @a image, the product of the matrix and @a step. Returns their
/// contribution to the inner product of @a step and @a image. The diagonal blocks are the identity.
HOMEOMORPHISM_FOR_WIDE_VECTORS
Vector2 Multiply(const std::int32_t* first, const std::int32_t* columns, const Block* blocks,
  const Matrix2* step, Matrix2* image, std::size_t begin, std::size_t end)
{
  Vector2 sum;
  for (std::size_t point = begin; point < end; ++point)
  {
    const Matrix2 own = step[point];
    // The x and y components of the derivative by x, then those of the derivative by y.
    double total[4] = { own.ImageOfX.x, own.ImageOfX.y, own.ImageOfY.x, own.ImageOfY.y };
    for (std::int32_t at = first[point]; at < first[point + 1]; ++at)
    {
      const Block& block = blocks[at];
      const Matrix2& other = step[columns[at]];
      const double byX[4] = { other.ImageOfX.x, other.ImageOfX.y, other.ImageOfX.x,
        other.ImageOfX.y };
      const double byY[4] = { other.ImageOfY.x, other.ImageOfY.y, other.ImageOfY.x,
        other.ImageOfY.y };
      const double first_[4] = { block[0], block[0], block[2], block[2] };
      const double second[4] = { block[1], block[1], block[3], block[3] };
      for (int l = 0; l < 4; ++l)
      {
        total[l] += first_[l] * byX[l] + second[l] * byY[l];
      }
    }
    image[point] = { { total[0], total[1] }, { total[2], total[3] } };
    AddProduct(sum, own, image[point]);
  }
  return sum;
}

class Solver
{
public:
  Solver(const CubicTemplate& cubicTemplate, const PointFans& fans,
    const std::map<int, BoundaryPoint>& boundary, LargeScratch scratch,
    const ParallelFor& parallelFor)
    : Template(cubicTemplate)
    , Pair(cubicTemplate.GetPair())
    , Fans(fans)
    , Boundary(boundary)
    , Scratch(scratch)
    , Parallel(parallelFor)
    , Count(this->Pair.Source.size())
  {
  }

  LeastBendingDerivatives Run()
  {
    this->Start();
    this->FindRows();
    this->Assemble();
    this->Normalize();
    this->Iterate();
    return std::move(this->Result);
  }

private:
  void Start();
  void FindRows();
  void Assemble();
  void Normalize();
  void Iterate();

  /// Calls body(point) for all points.
  template <typename Body>
  void ForAll(Body&& body)
  {
    this->Parallel(
      static_cast<std::int64_t>(this->Count), [&body](std::int64_t begin, std::int64_t end) {
        for (int point = static_cast<int>(begin); point < end; ++point)
        {
          body(point);
        }
      });
  }

  /// The sum of what body(begin, end) returns for all points, in an order that does not depend on
  /// threads.
  template <typename Body>
  Vector2 SumForBlocks(Body&& body)
  {
    constexpr std::size_t blockSize = 1024;
    this->Sums.resize((this->Count + blockSize - 1) / blockSize);
    this->Parallel(
      static_cast<std::int64_t>(this->Sums.size()), [&](std::int64_t begin, std::int64_t end) {
        for (std::int64_t block = begin; block < end; ++block)
        {
          const std::size_t first = static_cast<std::size_t>(block) * blockSize;
          this->Sums[static_cast<std::size_t>(block)] =
            body(first, std::min(this->Count, first + blockSize));
        }
      });
    return std::accumulate(this->Sums.begin(), this->Sums.end(), Vector2{});
  }

  /// The sum of what body(point, sum) adds.
  template <typename Body>
  Vector2 SumForAll(Body&& body)
  {
    return this->SumForBlocks([&body](std::size_t begin, std::size_t end) {
      Vector2 sum;
      for (std::size_t point = begin; point < end; ++point)
      {
        body(static_cast<int>(point), sum);
      }
      return sum;
    });
  }

  const CubicTemplate& Template;
  const PlanarPair& Pair;
  const PointFans& Fans;
  const std::map<int, BoundaryPoint>& Boundary;
  LargeScratch Scratch;
  const ParallelFor& Parallel;
  const std::size_t Count;
  LeastBendingDerivatives Result;
  /// For each point, the index of its first neighbor in Columns and Blocks.
  LargeArray<std::int32_t> First;
  LargeArray<std::int32_t> Columns;
  LargeArray<Block> Blocks;
  /// The diagonal block of each point. After Normalize, the transformation that makes it the
  /// identity in the directions in which the derivative is unknown, and zero in other directions.
  LargeArray<Block> Own;
  LargeArray<Matrix2> Residual;
  std::vector<Vector2> Sums;
};

//------------------------------------------------------------------------------
void Solver::Start()
{
  this->Result.AtPoints = LargeArray<Matrix2>(this->Count);
  LargeArray<Matrix2>& derivatives = this->Result.AtPoints;
  this->ForAll([&](int point) { derivatives[point] = this->Template.GetDerivative(point); });
  for (const auto& entry : this->Boundary)
  {
    const BoundaryPoint& boundary = entry.second;
    Matrix2& derivative = derivatives[entry.first];
    derivative = boundary.Straight
      ? derivative + OuterProduct(boundary.Slope - derivative * boundary.Tangent, boundary.Tangent)
      : boundary.Derivative;
  }
}

//------------------------------------------------------------------------------
// A point has as many neighbors as triangles, one more on the boundary.
void Solver::FindRows()
{
  constexpr std::int32_t none = -1;
  this->First = LargeArray<std::int32_t>(this->Count + 1, 0);
  for (const std::array<std::int32_t, 3>& corners : this->Pair.Triangles)
  {
    for (const std::int32_t point : corners)
    {
      ++this->First[point + 1];
    }
  }
  for (std::size_t point = 0; point < this->Count; ++point)
  {
    const std::int32_t t = this->Fans.First[point];
    const bool isOpen = t >= 0 &&
      this->Pair.Neighbors[t][PreviousCorner(this->Pair.GetCorner(t, static_cast<int>(point)))] < 0;
    this->First[point + 1] += this->First[point] + (isOpen ? 1 : 0);
  }
  const auto entries = static_cast<std::size_t>(this->First[this->Count]);
  this->Blocks = LargeArray<Block>(entries, this->Scratch);
  this->Columns = LargeArray<std::int32_t>(entries, this->Scratch);
  std::fill(this->Columns.begin(), this->Columns.end(), none);
}

//------------------------------------------------------------------------------
void Solver::Assemble()
{
  this->Own = LargeArray<Block>(this->Count, this->Scratch);
  std::fill(this->Own.begin(), this->Own.end(), Block{});
  this->Residual = LargeArray<Matrix2>(this->Count, this->Scratch);
  std::fill(this->Residual.begin(), this->Residual.end(), Matrix2{});
  const auto add = [this](int row, int column, const Block& block) {
    int at = this->First[row];
    while (this->Columns[at] != column && this->Columns[at] >= 0)
    {
      ++at;
    }
    Block& sum = this->Blocks[at];
    if (this->Columns[at] < 0)
    {
      this->Columns[at] = column;
      sum = block;
      return;
    }
    for (int n = 0; n < 4; ++n)
    {
      sum[n] += block[n];
    }
  };
  const int triangles = this->Pair.GetNumberOfTriangles();
  BendingBatch batch{};
  for (int begin = 0; begin < triangles; begin += BendingBatch::Size)
  {
    const int count = std::min(triangles - begin, BendingBatch::Size);
    for (int n = 0; n < count; ++n)
    {
      batch.SetCorners(n, this->Pair.GetSourceCorners(begin + n));
    }
    batch.SetMatrices();
    for (int n = 0; n < count; ++n)
    {
      const int t = begin + n;
      const std::array<std::int32_t, 3>& corners = this->Pair.Triangles[t];
      const Matrix2& affine = this->Template.GetAffine(t);
      std::array<Matrix2, 3> from;
      std::array<Matrix2, 3> force;
      for (int i = 0; i < 3; ++i)
      {
        const double(&entries)[3][BendingBatch::Size] = batch.Diagonal[i];
        const Block block{ entries[0][n], entries[1][n], entries[1][n], entries[2][n] };
        Block& sum = this->Own[corners[i]];
        for (int m = 0; m < 4; ++m)
        {
          sum[m] += block[m];
        }
        from[i] = this->Result.AtPoints[corners[i]] - affine;
        force[i] = block * from[i];
      }
      for (int k = 0; k < 3; ++k)
      {
        const int i = NextCorner(k);
        const int j = PreviousCorner(k);
        const double(&entries)[4][BendingBatch::Size] = batch.Edge[k];
        const Block block{ entries[0][n], entries[1][n], entries[2][n], entries[3][n] };
        const Block transposed = Transposed(block);
        add(corners[i], corners[j], block);
        add(corners[j], corners[i], transposed);
        force[i] = force[i] + block * from[j];
        force[j] = force[j] + transposed * from[i];
      }
      for (int i = 0; i < 3; ++i)
      {
        this->Residual[corners[i]] = this->Residual[corners[i]] - force[i];
        this->Result.Energy +=
          Dot(force[i].ImageOfX, from[i].ImageOfX) + Dot(force[i].ImageOfY, from[i].ImageOfY);
      }
    }
  }
}

//------------------------------------------------------------------------------
// Block Jacobi preconditioning: transforms the unknowns so that the diagonal blocks are the
// identity.
void Solver::Normalize()
{
  this->ForAll([this](int point) {
    Block& own = this->Own[point];
    if (this->Fans.First[point] < 0)
    {
      own = {};
    }
    else if (this->Template.IsBoundary(point))
    {
      const BoundaryPoint& boundary = this->Boundary.at(point);
      const Vector2 n{ -boundary.Tangent.y, boundary.Tangent.x };
      const double s =
        1.0 / std::sqrt(own[0] * n.x * n.x + 2.0 * own[1] * n.x * n.y + own[3] * n.y * n.y);
      own = boundary.Straight ? Block{ s * n.x, s * n.y, 0.0, 0.0 } : Block{};
    }
    else
    {
      // The inverse of the Cholesky factor.
      const double first = std::sqrt(own[0]);
      const double off = own[1] / first;
      const double second = std::sqrt(own[3] - off * off);
      own = { 1.0 / first, 0.0, -off / (first * second), 1.0 / second };
    }
    this->Residual[point] = own * this->Residual[point];
  });
  this->ForAll([this](int point) {
    for (int at = this->First[point]; at < this->First[point + 1]; ++at)
    {
      this->Blocks[at] =
        this->Own[point] * this->Blocks[at] * Transposed(this->Own[this->Columns[at]]);
    }
  });
}

//------------------------------------------------------------------------------
// Conjugate gradients for both components at once, each with its own step lengths.
void Solver::Iterate()
{
  LargeArray<Matrix2> step(this->Count, this->Scratch);
  LargeArray<Matrix2> image(this->Count, this->Scratch);
  LargeArray<Matrix2> solution(this->Count, this->Scratch);
  Vector2 product = this->SumForAll([&](int point, Vector2& sum) {
    solution[point] = {};
    step[point] = this->Residual[point];
    AddProduct(sum, step[point], step[point]);
  });
  const Vector2 start = product;
  for (int n = 0; n < MaximumSteps &&
       (product.x > EnoughResidual * start.x || product.y > EnoughResidual * start.y);
       ++n)
  {
    const Vector2 curvature = this->SumForBlocks([&](std::size_t begin, std::size_t end) {
      return Multiply(this->First.begin(), this->Columns.begin(), this->Blocks.begin(),
        step.begin(), image.begin(), begin, end);
    });
    const Vector2 share{ curvature.x > 0.0 ? product.x / curvature.x : 0.0,
      curvature.y > 0.0 ? product.y / curvature.y : 0.0 };
    this->Result.Energy -= Dot(share, product);
    const Vector2 next = this->SumForAll([&](int point, Vector2& sum) {
      Matrix2& residual = this->Residual[point];
      residual = residual - Scaled(share, image[point]);
      AddProduct(sum, residual, residual);
    });
    const Vector2 turn{ product.x > 0.0 ? next.x / product.x : 0.0,
      product.y > 0.0 ? next.y / product.y : 0.0 };
    product = next;
    this->ForAll([&](int point) {
      solution[point] = solution[point] + Scaled(share, step[point]);
      step[point] = this->Residual[point] + Scaled(turn, step[point]);
    });
  }
  this->ForAll([&](int point) {
    this->Result.AtPoints[point] =
      this->Result.AtPoints[point] + Transposed(this->Own[point]) * solution[point];
  });
}

} // anonymous namespace

//------------------------------------------------------------------------------
LeastBendingDerivatives FindLeastBendingDerivatives(const CubicTemplate& cubicTemplate,
  const PointFans& fans, const std::map<int, BoundaryPoint>& boundary, LargeScratch scratch,
  const ParallelFor& parallelFor)
{
  return Solver(cubicTemplate, fans, boundary, scratch, parallelFor).Run();
}

} // namespace homeomorphism
