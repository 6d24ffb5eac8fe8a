// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Builds Cubic maps of random pairs and prints the tables of Documentation/cubic.md. Fails if a map
// is not certified, folds at a sampled point, or if a point does not return in a round trip.
//
//   CubicStress [SHARE] [pairs|stars|needles|far|bending]...
//
// SHARE is the fraction of the full run, 1 by default. The results depend only on it.

#include "Mesh/CubicPairs.h"

#include "Mesh/CubicMap.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <set>
#include <string>
#include <vector>

namespace
{

using namespace homeomorphism;
using namespace cubic_test;

double Share = 1.0;
bool Failed = false;

int Count(int full)
{
  return std::max(1, static_cast<int>(full * Share));
}

Vector2 MapLinearly(const PlanarPair& pair, int t, const Vector2& point)
{
  const std::int32_t corner = pair.Triangles[t][0];
  return pair.Target[corner] + pair.GetAffine(t) * (point - pair.Source[corner]);
}

struct Result
{
  std::int64_t Points = 0;
  int Maps = 0;
  int Uncertified = 0;
  int ExceptionalInterior = 0;
  int Rings = 0;
  int TookTemplate = 0;
  double LeastCertificate = 1e300;
  double LeastRatio = 1e300;
  std::int64_t Folds = 0;
  std::int64_t Lost = 0;
  double RoundTrip = 0.0;
};

void Measure(const CubicMap& map, int points, Random& random, Result& result)
{
  const PlanarPair& pair = map.GetPair();
  const CubicMapStatistics& statistics = map.GetStatistics();
  ++result.Maps;
  result.Uncertified += statistics.UncertifiedTriangles;
  result.ExceptionalInterior += static_cast<int>(statistics.ExceptionalInteriorPoints.size());
  result.Rings += statistics.Rings;
  result.TookTemplate += statistics.Bending.TookTemplate ? 1 : 0;
  for (double certificate : map.GetCertificates())
  {
    result.LeastCertificate = std::min(result.LeastCertificate, certificate);
  }
  double size = 0.0;
  for (const Vector2& p : pair.Target)
  {
    size = std::max({ size, std::abs(p.x), std::abs(p.y) });
  }
  result.Points += points;
  CubicTriangle prepared = map.Prepare();
  for (const Sample& sample : RandomSamples(pair, random.Bits(), points))
  {
    const int t = sample.Triangle;
    const Vector2 point = sample.In(pair, pair.Source);
    const Vector2 image = map.MapPoint(t, point, prepared);
    const double determinant = map.GetDerivative(t, point, prepared).Determinant();
    result.Folds += determinant > 0.0 ? 0 : 1;
    result.LeastRatio = std::min(result.LeastRatio, determinant / pair.GetAffine(t).Determinant());
    int at = LocateImage(pair, image, t);
    Vector2 back;
    if (!map.FindPreimage(image, at, back, prepared))
    {
      ++result.Lost;
      continue;
    }
    const Vector2 again = map.MapPoint(at, back, prepared);
    result.RoundTrip = std::max(result.RoundTrip, Norm(again - image) / size);
  }
}

void Print(const char* what, const Result& r)
{
  std::printf("| %s | %d | %d | %d | %d | %.1e | %.1e | %lld of %lld | %lld | %.1e |\n", what,
    r.Maps, r.Uncertified, r.ExceptionalInterior, r.Rings, r.LeastCertificate, r.LeastRatio,
    static_cast<long long>(r.Folds), static_cast<long long>(r.Points),
    static_cast<long long>(r.Lost), r.RoundTrip);
  std::fflush(stdout);
  Failed = Failed || r.Uncertified > 0 || r.Folds > 0 || r.Lost > 0 || !(r.RoundTrip < 1e-13);
}

void PrintHead()
{
  std::printf("| pairs | maps | uncertified triangles | exceptional interior vertices | rings | "
              "least certificate | least determinant, sampled, over the affine one | "
              "determinants <= 0 | preimages not found | round trip |\n"
              "|---|---|---|---|---|---|---|---|---|---|\n");
}

void RunPairs()
{
  PrintHead();
  for (double strength : { 0.5, 1.2, 2.0, 3.0, 4.0 })
  {
    for (CubicBending bending : { CubicBending::Local, CubicBending::Least })
    {
      const bool least = bending == CubicBending::Least;
      Result result;
      Random random(1);
      for (int seed = 0; seed < Count(least ? 6 : 60); ++seed)
      {
        const CubicMap map(RandomPair(seed, strength, 11), Options(bending));
        Measure(map, 2000, random, result);
      }
      char name[64];
      std::snprintf(name, sizeof(name), "random, %.1f, %s", strength, least ? "LEAST" : "LOCAL");
      Print(name, result);
    }
  }
}

void RunNeedles()
{
  PrintHead();
  Random random(2);
  Result result;
  for (int n = 0; n < Count(10000); ++n)
  {
    const CubicMap map(RandomNeedles(random, 20.0), Options(CubicBending::Local));
    Measure(map, 20, random, result);
  }
  Print("two needles, LOCAL", result);
}

void RunStars()
{
  Random random(3);
  // Row 0 is for stars whose rays turn by less than 90 degrees, row 1 for others. The columns count
  // all stars, those with a derivative without rings, those with a derivative inside rings, and
  // those without a derivative.
  int numbers[2][4] = {};
  int uncertified = 0;
  std::vector<int> rings;
  for (int n = 0; n < Count(10000); ++n)
  {
    double turn;
    PlanarPair pair = RandomStar(random, 3 + n % 7, 2.8, &turn);
    const CubicMap map(std::move(pair), Options(CubicBending::Local));
    const CubicMapStatistics& statistics = map.GetStatistics();
    uncertified += statistics.UncertifiedTriangles;
    int* row = numbers[turn < 0.5 * 3.141592653589793 ? 0 : 1];
    const bool isExceptional = !statistics.ExceptionalInteriorPoints.empty();
    const int column = isExceptional ? 3 : statistics.Rings > 0 ? 2 : 1;
    ++row[0];
    ++row[column];
    if (column == 2)
    {
      rings.push_back(statistics.Rings);
    }
  }
  std::sort(rings.begin(), rings.end());
  std::printf("| rays turn within | stars | derivative without rings | derivative inside rings | "
              "exceptional |\n"
              "|---|---|---|---|---|\n");
  for (int wide = 0; wide < 2; ++wide)
  {
    std::printf("| %s | %d | %d | %d | %d |\n", wide ? "more than 90 degrees" : "90 degrees",
      numbers[wide][0], numbers[wide][1], numbers[wide][2], numbers[wide][3]);
  }
  std::printf("\nuncertified triangles: %d; rings where needed: median %d, at most %d\n",
    uncertified, rings.empty() ? 0 : rings[rings.size() / 2], rings.empty() ? 0 : rings.back());
  Failed = Failed || uncertified > 0;
}

void RunFar()
{
  PrintHead();
  for (CubicBending bending : { CubicBending::Local, CubicBending::Least })
  {
    Result result;
    Random random(4);
    for (int seed = 0; seed < Count(10); ++seed)
    {
      // A map sheet of 10 km at coordinates of 10^7 m, in millimeters.
      const auto away = [](const Vector2& p) {
        return Vector2{ 1e7 + std::round(1e7 * p.x) / 1000.0,
          1e7 + std::round(1e7 * p.y) / 1000.0 };
      };
      const CubicMap map(Moved(RandomPair(seed, 0.5, 11), away), Options(bending));
      Measure(map, 2000, random, result);
    }
    Print(bending == CubicBending::Least ? "at 10^7, LEAST" : "at 10^7, LOCAL", result);
  }
  Result result;
  Random random(5);
  for (int seed = 0; seed < Count(10); ++seed)
  {
    // Cells that shrink by 0.7 from one to the next.
    const auto grade = [](const Vector2& p) {
      const double shrunk = std::pow(0.7, 11.0 * p.x);
      return Vector2{ (1.0 - shrunk) / (1.0 - std::pow(0.7, 11.0)), p.y };
    };
    PlanarPair pair = Moved(RandomPair(seed, 0.5, 11), grade);
    bool valid = true;
    for (int t = 0; t < pair.GetNumberOfTriangles(); ++t)
    {
      const std::array<Vector2, 3> a = pair.GetSourceCorners(t);
      const std::array<Vector2, 3> b = pair.GetTargetCorners(t);
      valid = valid && Cross(a[1], a[2]) > 0.0 && Cross(b[1], b[2]) > 0.0;
    }
    if (valid)
    {
      const CubicMap map(std::move(pair), Options(CubicBending::Local));
      Measure(map, 2000, random, result);
    }
  }
  Print("graded, LOCAL", result);
}

/// The root mean square of the second differences at a step of a tenth of an edge, with the edge as
/// the unit of length.
double SecondDifferences(const CubicMap& map, bool linear, int cells)
{
  const PlanarPair& pair = map.GetPair();
  const double h = 0.1 / cells;
  Random random(6);
  double sum = 0.0;
  const int count = 4000;
  int t = 0;
  CubicTriangle prepared = map.Prepare();
  for (int n = 0; n < count; ++n)
  {
    const Vector2 x{ random.Uniform(h, 1.0 - h), random.Uniform(h, 1.0 - h) };
    const auto value = [&](const Vector2& p) {
      t = std::max(0, Locate(pair, pair.Source, t, p));
      return linear ? MapLinearly(pair, t, p) : map.MapPoint(t, p, prepared);
    };
    const Vector2 middle = value(x);
    const auto difference = [&](const Vector2& d) {
      return (1.0 / (h * h)) * (value(x + d) + value(x - d) - 2.0 * middle);
    };
    const Vector2 xx = difference({ h, 0.0 });
    const Vector2 yy = difference({ 0.0, h });
    const double diagonal = h * std::sqrt(0.5);
    const Vector2 xy = difference({ diagonal, diagonal }) - 0.5 * (xx + yy);
    sum += Dot(xx, xx) + Dot(yy, yy) + 2.0 * Dot(xy, xy);
  }
  return std::sqrt(sum / count) / cells;
}

void RunBending()
{
  std::printf(
    "| strength | refinement | Linear | LOCAL | LEAST | LEAST / Linear | cut | equal to "
    "the template | elements | rounds, proximal |\n|---|---|---|---|---|---|---|---|---|---|\n");
  constexpr int cells = 11;
  for (double strength : { 0.0, 0.5, 1.2, 2.0, 3.0 })
  {
    const PlanarPair pair = RandomPair(100, strength, cells);
    const CubicMap local(pair, Options(CubicBending::Local));
    CubicMapOptions options = Options(CubicBending::Least);
    const double linear = SecondDifferences(local, true, cells);
    for (int level = 0; level < (Share < 1.0 ? 1 : 2); ++level)
    {
      options.FairnessRefinement = level;
      const CubicMap least(pair, options);
      const double bending = SecondDifferences(least, false, cells);
      const CubicMapStatistics& s = least.GetStatistics();
      const int triangles = pair.GetNumberOfTriangles() << (2 * level);
      std::printf("| %.1f | %d | %.2f | %.2f | %.2f | %.2f | %d of %d | %d | %lld | %d, %d |\n",
        strength, level, linear, SecondDifferences(local, false, cells), bending, bending / linear,
        s.Bending.CutTriangles, triangles, s.Bending.TemplateTriangles,
        static_cast<long long>(s.Elements), s.Bending.Rounds, s.Bending.ProximalRounds);
      std::fflush(stdout);
      Failed = Failed || s.UncertifiedTriangles > 0;
    }
  }
}

} // anonymous namespace

int main(int argc, char* argv[])
{
  std::set<std::string> parts;
  for (int i = 1; i < argc; ++i)
  {
    char* end;
    const double number = std::strtod(argv[i], &end);
    if (end != argv[i])
    {
      Share = number;
    }
    else
    {
      parts.insert(argv[i]);
    }
  }
  const struct
  {
    const char* Name;
    void (*Run)();
  } all[] = { { "pairs", RunPairs }, { "needles", RunNeedles }, { "stars", RunStars },
    { "far", RunFar }, { "bending", RunBending } };
  for (const auto& part : all)
  {
    if (parts.empty() || parts.count(part.Name) != 0)
    {
      std::printf("\n%s\n\n", part.Name);
      part.Run();
    }
  }
  return Failed ? EXIT_FAILURE : EXIT_SUCCESS;
}
