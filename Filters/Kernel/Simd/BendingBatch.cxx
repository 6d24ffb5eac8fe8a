// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "BendingBatch.h"

#include <algorithm>
#include <cmath>

namespace homeomorphism
{
namespace
{

constexpr int N = BendingBatch::Size;

// The index of the entry of two functions in the lower triangle of a symmetric matrix.
constexpr int Entry(int m, int n)
{
  return m < n ? n * (n + 1) / 2 + m : m * (m + 1) / 2 + n;
}

} // anonymous namespace

//------------------------------------------------------------------------------
void BendingBatch::SetCorners(int number, const std::array<Vector2, 3>& points)
{
  for (int c = 0; c < 2; ++c)
  {
    const Vector2 point = points[c + 1] - points[0];
    this->Corners[c][0][number] = point.x;
    this->Corners[c][1][number] = point.y;
  }
}

//------------------------------------------------------------------------------
// The basis functions 2c and 2c + 1 are zero at the corners, and all but one of their derivatives
// are zero there: that at corner c along the whole edge to the next or to the previous corner.
// Their ordinates (see CubicOrdinates) are the same numbers in all triangles, except for the
// position of the centroid along the edges. The second derivatives in a piece are those along its
// edge and across it.
HOMEOMORPHISM_FOR_WIDE_VECTORS
void BendingBatch::SetMatrices()
{
  const double(&x1)[N] = this->Corners[0][0];
  const double(&y1)[N] = this->Corners[0][1];
  const double(&x2)[N] = this->Corners[1][0];
  const double(&y2)[N] = this->Corners[1][1];
  double edges[3][2][N];
  // The position of the centroid along each edge, from its start.
  double along[3][N];
  // The factors from second differences to second derivatives, times the square root of the weight
  // of a quadrature point.
  double scales[3][3][N];
  HOMEOMORPHISM_SIMD
  for (int l = 0; l < N; ++l)
  {
    edges[0][0][l] = x2[l] - x1[l];
    edges[0][1][l] = y2[l] - y1[l];
    edges[1][0][l] = -x2[l];
    edges[1][1][l] = -y2[l];
    edges[2][0][l] = x1[l];
    edges[2][1][l] = y1[l];
  }
  constexpr double third = 1.0 / 3.0;
  for (int k = 0; k < 3; ++k)
  {
    const double(&x)[N] = edges[k][0];
    const double(&y)[N] = edges[k][1];
    const double(&nextX)[N] = edges[NextCorner(k)][0];
    const double(&nextY)[N] = edges[NextCorner(k)][1];
    HOMEOMORPHISM_SIMD
    for (int l = 0; l < N; ++l)
    {
      // The vector from the start to the centroid is two thirds of the edge plus a third of the
      // next edge.
      const double toCentroid = third * (x[l] * nextX[l] + y[l] * nextY[l]);
      const double squared = x[l] * x[l] + y[l] * y[l];
      const double cross = third * (x[l] * nextY[l] - y[l] * nextX[l]);
      const double root = 6.0 * std::sqrt(cross / 24.0);
      along[k][l] = 2.0 * third + toCentroid / squared;
      scales[k][0][l] = root / squared;
      scales[k][1][l] = 1.4142135623730951 * root / cross;
      scales[k][2][l] = root * squared / (cross * cross);
    }
  }
  // The ordinates of each function. Inner ordinates are 1/9 for both functions of their corner.
  // Ordinates on an edge are 1/3 for the derivative along it.
  constexpr double ninth = 1.0 / 9.0;
  double middle[3][6][N] = {};
  double spoke[3][6][N];
  double center[6][N];
  for (int k = 0; k < 3; ++k)
  {
    const int i = 2 * NextCorner(k);
    const int j = 2 * PreviousCorner(k);
    HOMEOMORPHISM_SIMD
    for (int l = 0; l < N; ++l)
    {
      middle[k][i][l] = 7.0 / 18.0 - 0.5 * along[k][l];
      middle[k][i + 1][l] = 1.0 / 18.0;
      middle[k][j][l] = 1.0 / 18.0;
      middle[k][j + 1][l] = 0.5 * along[k][l] - ninth;
    }
  }
  for (int f = 0; f < 6; ++f)
  {
    for (int c = 0; c < 3; ++c)
    {
      const double inner = f / 2 == c ? ninth : 0.0;
      const double(&next)[N] = middle[NextCorner(c)][f];
      const double(&previous)[N] = middle[PreviousCorner(c)][f];
      HOMEOMORPHISM_SIMD
      for (int l = 0; l < N; ++l)
      {
        spoke[c][f][l] = third * (inner + next[l] + previous[l]);
      }
    }
    HOMEOMORPHISM_SIMD
    for (int l = 0; l < N; ++l)
    {
      center[f][l] = third * (spoke[0][f][l] + spoke[1][f][l] + spoke[2][f][l]);
    }
  }
  double entries[21][N] = {};
  for (int k = 0; k < 3; ++k)
  {
    const int i = NextCorner(k);
    const int j = PreviousCorner(k);
    // Sums of second derivatives at two corners of the piece, for the midpoint between them.
    double middles[6][9][N];
    for (int f = 0; f < 6; ++f)
    {
      const double after = f == 2 * i ? third : 0.0;
      const double before = f == 2 * j + 1 ? third : 0.0;
      const double innerStart = f / 2 == i ? ninth : 0.0;
      const double innerEnd = f / 2 == j ? ninth : 0.0;
      double(&sums)[9][N] = middles[f];
      HOMEOMORPHISM_SIMD
      for (int l = 0; l < N; ++l)
      {
        const double m = middle[k][f][l];
        const double start = spoke[i][f][l];
        const double end = spoke[j][f][l];
        // Second differences along the edge (EE), mixed (EC), and towards the centroid (CC): at the
        // start, at the end, and at the centroid.
        const double startEE = before - 2.0 * after;
        const double startEC = m - after - innerStart;
        const double startCC = start - 2.0 * innerStart;
        const double endEE = after - 2.0 * before;
        const double endEC = after + innerEnd - before - m;
        const double endCC = after + end - 2.0 * m;
        const double centerEE = innerStart + innerEnd - 2.0 * m;
        const double centerEC = innerStart + end - m - start;
        const double centerCC = innerStart + center[f][l] - 2.0 * start;
        const double t = along[k][l];
        const double xx = scales[k][0][l];
        const double xy = scales[k][1][l];
        const double yy = scales[k][2][l];
        sums[0][l] = xx * (startEE + endEE);
        sums[1][l] = xy * (startEC + endEC - t * (startEE + endEE));
        sums[2][l] = yy * (startCC + endCC - t * (2.0 * (startEC + endEC) - t * (startEE + endEE)));
        sums[3][l] = xx * (endEE + centerEE);
        sums[4][l] = xy * (endEC + centerEC - t * (endEE + centerEE));
        sums[5][l] =
          yy * (endCC + centerCC - t * (2.0 * (endEC + centerEC) - t * (endEE + centerEE)));
        sums[6][l] = xx * (centerEE + startEE);
        sums[7][l] = xy * (centerEC + startEC - t * (centerEE + startEE));
        sums[8][l] =
          yy * (centerCC + startCC - t * (2.0 * (centerEC + startEC) - t * (centerEE + startEE)));
      }
    }
    for (int m = 0; m < 6; ++m)
    {
      for (int n = 0; n <= m; ++n)
      {
        const double(&a)[9][N] = middles[m];
        const double(&b)[9][N] = middles[n];
        double(&entry)[N] = entries[Entry(m, n)];
        HOMEOMORPHISM_SIMD
        for (int l = 0; l < N; ++l)
        {
          entry[l] += ((a[0][l] * b[0][l] + a[1][l] * b[1][l]) + a[2][l] * b[2][l]) +
            ((a[3][l] * b[3][l] + a[4][l] * b[4][l]) + a[5][l] * b[5][l]) +
            ((a[6][l] * b[6][l] + a[7][l] * b[7][l]) + a[8][l] * b[8][l]);
        }
      }
    }
  }
  // Convert derivatives along the edges to those by x and y.
  for (int c = 0; c < 3; ++c)
  {
    const double(&nextX)[N] = edges[PreviousCorner(c)][0];
    const double(&nextY)[N] = edges[PreviousCorner(c)][1];
    const double(&beforeX)[N] = edges[NextCorner(c)][0];
    const double(&beforeY)[N] = edges[NextCorner(c)][1];
    const double(&nn)[N] = entries[Entry(2 * c, 2 * c)];
    const double(&np)[N] = entries[Entry(2 * c, 2 * c + 1)];
    const double(&pp)[N] = entries[Entry(2 * c + 1, 2 * c + 1)];
    HOMEOMORPHISM_SIMD
    for (int l = 0; l < N; ++l)
    {
      const double previousX = -beforeX[l];
      const double previousY = -beforeY[l];
      const double nextByX = nn[l] * nextX[l] + np[l] * previousX;
      const double nextByY = nn[l] * nextY[l] + np[l] * previousY;
      const double previousByX = np[l] * nextX[l] + pp[l] * previousX;
      const double previousByY = np[l] * nextY[l] + pp[l] * previousY;
      this->Diagonal[c][0][l] = nextX[l] * nextByX + previousX * previousByX;
      this->Diagonal[c][1][l] = nextX[l] * nextByY + previousX * previousByY;
      this->Diagonal[c][2][l] = nextY[l] * nextByY + previousY * previousByY;
    }
  }
  for (int k = 0; k < 3; ++k)
  {
    // At the start of the edge, the edge leads to the next corner and the previous edge to the
    // previous corner. At its end, the next edge leads to the next corner and the edge to the
    // previous corner.
    const int i = 2 * NextCorner(k);
    const int j = 2 * PreviousCorner(k);
    const double(&x)[N] = edges[k][0];
    const double(&y)[N] = edges[k][1];
    const double(&beforeX)[N] = edges[PreviousCorner(k)][0];
    const double(&beforeY)[N] = edges[PreviousCorner(k)][1];
    const double(&nextX)[N] = edges[NextCorner(k)][0];
    const double(&nextY)[N] = edges[NextCorner(k)][1];
    const double(&nn)[N] = entries[Entry(i, j)];
    const double(&np)[N] = entries[Entry(i, j + 1)];
    const double(&pn)[N] = entries[Entry(i + 1, j)];
    const double(&pp)[N] = entries[Entry(i + 1, j + 1)];
    HOMEOMORPHISM_SIMD
    for (int l = 0; l < N; ++l)
    {
      const double nextByX = nn[l] * nextX[l] - np[l] * x[l];
      const double nextByY = nn[l] * nextY[l] - np[l] * y[l];
      const double previousByX = pn[l] * nextX[l] - pp[l] * x[l];
      const double previousByY = pn[l] * nextY[l] - pp[l] * y[l];
      this->Edge[k][0][l] = x[l] * nextByX - beforeX[l] * previousByX;
      this->Edge[k][1][l] = x[l] * nextByY - beforeX[l] * previousByY;
      this->Edge[k][2][l] = y[l] * nextByX - beforeY[l] * previousByX;
      this->Edge[k][3][l] = y[l] * nextByY - beforeY[l] * previousByY;
    }
  }
}

} // namespace homeomorphism
