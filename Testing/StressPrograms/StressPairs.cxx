// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Makes pairs of difficult figures, checks each, and prints a table in Markdown:
//   StressPairs
// or only the row of a number of smoothly displaced landmarks, and the peak memory:
//   StressPairs --smooth NUMBER
// or, as CSV, the smallest angle and the shares of obtuse and discordant triangles for numbers of
// added points:
//   StressPairs --curve NAME MAXIMUM [STEP]
// The column `seconds` is the time of each search.
//
// Times are those of the processor, in one thread.

#include "Construction/Figures.h"

#include <cstring>
#include <ctime>
#include <iostream>

#include <sys/resource.h> // for the memory

using namespace figures;

namespace
{

double Seconds()
{
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

int Failures = 0;

void Row(const std::string& name, const FigurePair& figure,
  const IsomorphicTriangulationOptions& options = {})
{
  const double start = Seconds();
  const IsomorphicTriangulationResult result = MakeIsomorphicTriangulation(figure, options);
  const double seconds = Seconds() - start;
  const std::string wrong = Check(figure, result);
  Failures += wrong.empty() ? 0 : 1;
  char text[200];
  std::snprintf(text, sizeof(text), " | %zu | %d | %.2g | %.2f | ", figure.Points[0].size(),
    result.NumberOfAddedPoints, result.IsComplete() ? SmallestAngle(result) : 0.0, seconds);
  std::cout << "| " << name << text << (wrong.empty() ? "valid" : wrong) << " |" << std::endl;
}

/// A square with many square holes, bent in the target.
FigurePair Holes(int side, int landmarksInBays)
{
  FigurePair figure;
  const auto add = [&](double x, double y) {
    Add(figure, { x, y }, { x + 0.3 * std::sin(0.5 * y), y + 0.3 * std::sin(0.4 * x) });
    return static_cast<int>(figure.Points[0].size()) - 1;
  };
  const double size = 2.0 * side;
  figure.Loops.push_back({ add(-1, -1), add(size, -1), add(size, size), add(-1, size) });
  for (int i = 0; i < side; ++i)
  {
    for (int k = 0; k < side; ++k)
    {
      const double x = 2.0 * i;
      const double y = 2.0 * k;
      figure.Loops.push_back(
        { add(x, y), add(x + 1, y), add(x + 1, y + 1), add(x + 0.8, y + 0.2), add(x, y + 1) });
      if (i * side + k < landmarksInBays)
      {
        add(x + 0.6, y + 0.6);
      }
    }
  }
  return figure;
}

FigurePair Scaled(FigurePair figure, double x, double y, double scale, bool toFloat)
{
  for (auto& points : figure.Points)
  {
    for (Vector2& p : points)
    {
      p = { x + scale * p.x, y + scale * p.y };
      if (toFloat)
      {
        p = { static_cast<float>(p.x), static_cast<float>(p.y) };
      }
    }
  }
  return figure;
}

void Table()
{
  std::cout << "| figure | points | added | smallest angle | seconds | result |\n"
               "| --- | ---: | ---: | ---: | ---: | --- |\n";
  for (const char* name : { "nobeoka", "nobeoka-inset", "fushimi-castle", "tatebayashi-town",
         "uno-bus", "uno-bus-bent", "letters-U-S", "outlines-37" })
  {
    FigurePair figure;
    if (Read(name, figure, true))
    {
      IsomorphicTriangulationOptions options;
      options.LeaveOutConflictingSegments = true;
      if (figure.Points[0].size() < 40)
      {
        figure.Loops.push_back(Range(0, static_cast<int>(figure.Points[0].size())));
      }
      Row(name, figure, options);
    }
  }
  for (const double spacings : { 0.1, 0.25, 0.5, 1.0, 1.5, 2.0 })
  {
    char name[40];
    std::snprintf(name, sizeof(name), "noise of %g spacings", spacings);
    Row(name, Noise(1000, spacings, 1));
  }
  for (const int n : { 10, 30, 100, 300, 1000 })
  {
    Row("unrelated positions", Unrelated(n, 2));
  }
  for (const int n : { 40, 100, 500 })
  {
    Row("spiral against circle", Outline(Spiral(n, 2.0), Circle(n)));
    Row("comb against shifted comb", Outline(Comb(n, 0), Comb(n, n / 4)));
  }
  for (const int n : { 16, 32, 64, 128, 256 })
  {
    Row("snake against shifted snake", Outline(Snake(n, false), Snake(n, true)));
  }
  Row("annulus, turned by a third", Annulus(24, 2.1, false));
  Row("island in a hole, turned", Annulus(24, 2.1, true));
  Row("1024 holes, landmarks in their bays", Holes(32, 1024));
  Row("Web Mercator coordinates", Scaled(Noise(500, 0.3, 3), 1.5e7, 4e6, 1e3, false));
  Row("national grid, float", Scaled(Noise(500, 0.3, 3), 3.5e6, 6.7e6, 1e5, true));
}

/// Prints the row of one number of landmarks and the peak memory of the process, which should run
/// nothing else.
void Growth(int number)
{
  Row("smooth", Smooth(number, 4));
  rusage usage;
  getrusage(RUSAGE_SELF, &usage);
  std::printf("%d smooth landmarks: at most %.0f MB\n", number, usage.ru_maxrss / 1e3);
}

/// Prints the curve for the interior of an outline, or for landmarks in a frame.
int Curve(const std::string& name, int maximum, int step)
{
  const bool isOutline = name == "letters-U-S" || name == "outlines-37";
  std::cout << "name,quality,points,source_angle,target_angle,obtuse,discordant,seconds\n";
  for (const PairQuality quality :
    { PairQuality::MinimumAngle, PairQuality::Concordance, PairQuality::NonObtuse })
  {
    for (int count = 0; count <= maximum; count += step)
    {
      FigurePair figure;
      if (!Read(name, figure, true))
      {
        std::cerr << "There is no " << name << "\n";
        return 1;
      }
      if (isOutline)
      {
        figure.Loops.push_back(Range(0, static_cast<int>(figure.Points[0].size())));
      }
      IsomorphicTriangulationOptions options;
      options.LeaveOutConflictingSegments = true;
      options.MaximumNumberOfAddedPoints = count;
      options.TargetQuality = 90.0;
      options.Quality = quality;
      const double start = Seconds();
      const auto result = MakeIsomorphicTriangulation(figure, options);
      const double seconds = Seconds() - start;
      if (!result.IsComplete())
      {
        continue;
      }
      if (!Check(figure, result).empty())
      {
        return 1;
      }
      const auto s = MeasureQualities(result.Points, result.Triangles);
      std::cout << name << "," << static_cast<int>(quality) << "," << count << ","
                << s.MinimumAngle[0] << "," << s.MinimumAngle[1] << "," << s.ObtuseShare << ","
                << s.DiscordantShare << "," << seconds << std::endl;
    }
  }
  return 0;
}

} // namespace

int main(int argc, char** argv)
{
  if ((argc == 4 || argc == 5) && std::strcmp(argv[1], "--curve") == 0)
  {
    return Curve(argv[2], std::atoi(argv[3]), argc == 5 ? std::atoi(argv[4]) : 1);
  }
  if (argc == 3 && std::strcmp(argv[1], "--smooth") == 0)
  {
    Growth(std::atoi(argv[2]));
    return Failures == 0 ? 0 : 1;
  }
  Table();
  return Failures == 0 ? 0 : 1;
}
