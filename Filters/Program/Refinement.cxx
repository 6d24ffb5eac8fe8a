// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Refinement.h"

#include "Command.h"
#include "Console.h"
#include "Failure.h"
#include "MeshParts.h"
#include "Numbers.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>
#include <unordered_map>
#include <vector>

namespace dhm
{
namespace
{

using Point = std::array<double, 2>;
using Barycentric = std::array<double, 3>;

/// A part of one of the pair's triangles.
struct Part
{
  std::array<vtkIdType, 3> Points;
  /// Barycentric coordinates of the points in the pair's triangle: multiples of powers of 1/2,
  /// without rounding, so that a point is on an edge exactly if one of them is 0.
  std::array<Barycentric, 3> Places;
  vtkIdType Triangle;
  bool Divided = false;
};

struct EdgeHash
{
  std::size_t operator()(const std::array<vtkIdType, 2>& edge) const
  {
    return std::hash<vtkIdType>()(edge[0] * vtkIdType(1000003) + edge[1]);
  }
};

/// Triangles that are lower than this, over their longest edge, are not made still longer: the
/// slightest bend would turn needles over.
constexpr double needle = 0.03;

double Area(const Point& a, const Point& b, const Point& c)
{
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

class Refiner
{
public:
  Refiner(const MeshPair& pair, const MapOptions& map)
    : Pair(pair)
  {
    map.ApplyTo(this->Map.Get());
    this->Map->SetSourceData(pair.Source());
    this->Map->SetTargetData(pair.Target());
    this->Map->BlankOutsideOff();
    for (std::size_t side = 0; side < 2; ++side)
    {
      vtkPolyData* mesh = pair.Meshes[side];
      this->Points[side].resize(static_cast<std::size_t>(mesh->GetNumberOfPoints()));
      for (std::size_t i = 0; i < this->Points[side].size(); ++i)
      {
        double p[3];
        mesh->GetPoint(static_cast<vtkIdType>(i), p);
        this->Points[side][i] = { p[0], p[1] };
      }
    }
    ForEachCell(
      pair.Source()->GetPolys(), [this](vtkIdType number, vtkIdType, const vtkIdType* corners) {
        this->Triangles.push_back({ corners[0], corners[1], corners[2] });
        this->Add(
          { this->Triangles.back(), { { { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } } }, number });
      });
  }

  vtkIdType GetNumberOfParts() const { return this->NumberOfParts; }

  /// The undivided parts.
  std::vector<std::size_t> GetParts() const
  {
    std::vector<std::size_t> parts;
    for (std::size_t i = 0; i < this->Parts.size(); ++i)
    {
      if (!this->Parts[i].Divided)
      {
        parts.push_back(i);
      }
    }
    return parts;
  }

  /// How far the linear map of a part is from the map.
  struct Distance
  {
    /// At the inner points of the part and of its edges; infinite if the part is turned over.
    double Largest = 0.0;
    /// At the inner points of each edge.
    std::array<double, 3> OfEdges{ 0.0, 0.0, 0.0 };
  };

  /// Measures some parts at the points of a barycentric grid.
  std::vector<Distance> MeasureDistances(const std::vector<std::size_t>& parts, int divisions)
  {
    std::vector<Barycentric> grid;
    for (int i = 0; i <= divisions; ++i)
    {
      for (int j = 0; j <= divisions - i; ++j)
      {
        const int k = divisions - i - j;
        if (i != divisions && j != divisions && k != divisions)
        {
          grid.push_back({ static_cast<double>(i) / divisions, static_cast<double>(j) / divisions,
            static_cast<double>(k) / divisions });
        }
      }
    }
    const auto within = [&](std::size_t side, const Part& part, const Barycentric& weights) {
      Point point{ 0.0, 0.0 };
      for (std::size_t k = 0; k < 3; ++k)
      {
        const Point& corner = this->Points[side][static_cast<std::size_t>(part.Points[k])];
        point[0] += weights[k] * corner[0];
        point[1] += weights[k] * corner[1];
      }
      return point;
    };
    this->Samples = 0;
    std::vector<Distance> distances;
    // Some at a time: the samples of all would take a lot of memory.
    constexpr std::size_t atOnce = 2000;
    std::vector<Point> samples;
    for (std::size_t begin = 0; begin < parts.size(); begin += atOnce)
    {
      const std::size_t end = std::min(parts.size(), begin + atOnce);
      samples.clear();
      for (std::size_t i = begin; i < end; ++i)
      {
        for (const Barycentric& weights : grid)
        {
          samples.push_back(within(0, this->Parts[parts[i]], weights));
        }
      }
      const std::vector<Point> images = this->MapPoints(samples);
      for (std::size_t i = begin; i < end; ++i)
      {
        const Part& part = this->Parts[parts[i]];
        Distance result;
        for (std::size_t k = 0; k < grid.size(); ++k)
        {
          const Point& image = images[(i - begin) * grid.size() + k];
          const Point linear = within(1, part, grid[k]);
          const double distance = std::hypot(image[0] - linear[0], image[1] - linear[1]);
          if (std::isnan(distance))
          {
            continue;
          }
          result.Largest = std::max(result.Largest, distance);
          for (std::size_t edge = 0; edge < 3; ++edge)
          {
            if (grid[k][edge] == 0.0)
            {
              result.OfEdges[edge] = std::max(result.OfEdges[edge], distance);
            }
          }
        }
        if (this->IsTurnedOver(part))
        {
          result.Largest = std::numeric_limits<double>::infinity();
        }
        distances.push_back(result);
      }
      this->Samples += static_cast<vtkIdType>(samples.size());
    }
    return distances;
  }

  /// At how many points the last distances were measured.
  vtkIdType GetNumberOfSamples() const { return this->Samples; }

  bool IsDivided(std::size_t index) const { return this->Parts[index].Divided; }

  /// Halves edges of a part that is too far from the map: those that are too far themselves or, if
  /// none is, the farthest; if it is turned over, its longest.
  void Divide(std::size_t index, const Distance& distance, double tolerance)
  {
    std::size_t worst = 0;
    for (const std::size_t edge : { 1, 2 })
    {
      worst = distance.OfEdges[edge] > distance.OfEdges[worst] ? edge : worst;
    }
    if (std::isinf(distance.Largest) || distance.OfEdges[worst] == 0.0)
    {
      worst = this->LongestEdge(index);
    }
    std::array<std::array<vtkIdType, 2>, 3> edges;
    for (std::size_t edge = 0; edge < 3; ++edge)
    {
      edges[edge] = this->Edge(index, edge);
    }
    for (std::size_t edge = 0; edge < 3; ++edge)
    {
      if (edge == worst || distance.OfEdges[edge] > tolerance)
      {
        this->HalveWithCare(edges[edge]);
      }
    }
  }

  /// Finds where the points that have been added since the last time go.
  void MapNewPoints()
  {
    std::vector<Point> places;
    for (const std::size_t point : this->Unmapped)
    {
      places.push_back(this->Points[0][point]);
    }
    const std::vector<Point> images = this->MapPoints(places);
    for (std::size_t i = 0; i < images.size(); ++i)
    {
      this->Points[1][this->Unmapped[i]] = images[i];
    }
    this->Unmapped.clear();
  }

  std::array<vtkSmartPointer<vtkPolyData>, 2> MakeMeshes() const
  {
    vtkNew<vtkCellArray> polygons;
    for (const std::size_t part : this->GetParts())
    {
      // All wound alike, counterclockwise in the source.
      std::array<vtkIdType, 3> ids = this->Parts[part].Points;
      const auto corner = [this, &ids](std::size_t k) {
        return this->Points[0][static_cast<std::size_t>(ids[k])];
      };
      if (Area(corner(0), corner(1), corner(2)) < 0.0)
      {
        std::swap(ids[1], ids[2]);
      }
      polygons->InsertNextCell(3, ids.data());
    }
    std::array<vtkSmartPointer<vtkPolyData>, 2> meshes;
    for (std::size_t side = 0; side < 2; ++side)
    {
      vtkNew<vtkPoints> points;
      points->SetDataTypeToDouble();
      double first[3];
      this->Pair.Meshes[side]->GetPoint(0, first);
      for (const Point& point : this->Points[side])
      {
        points->InsertNextPoint(point[0], point[1], first[2]);
      }
      meshes[side] = vtkSmartPointer<vtkPolyData>::New();
      meshes[side]->SetPoints(points);
      meshes[side]->SetPolys(polygons);
    }
    return meshes;
  }

private:
  /// The two points of an edge, which is opposite a part's point.
  std::array<vtkIdType, 2> Edge(std::size_t part, std::size_t edge) const
  {
    const auto& points = this->Parts[part].Points;
    const vtkIdType a = points[(edge + 1) % 3];
    const vtkIdType b = points[(edge + 2) % 3];
    return { std::min(a, b), std::max(a, b) };
  }

  double Length(const std::array<vtkIdType, 2>& ends) const
  {
    const Point& a = this->Points[0][static_cast<std::size_t>(ends[0])];
    const Point& b = this->Points[0][static_cast<std::size_t>(ends[1])];
    return std::hypot(b[0] - a[0], b[1] - a[1]);
  }

  /// Of edges of the same length, the points' numbers decide: for both parts alike.
  std::size_t LongestEdge(std::size_t part) const
  {
    const auto key = [&](std::size_t edge) {
      const auto ends = this->Edge(part, edge);
      return std::make_tuple(this->Length(ends), ends[0], ends[1]);
    };
    std::size_t longest = 0;
    for (const std::size_t edge : { 1, 2 })
    {
      longest = key(edge) > key(longest) ? edge : longest;
    }
    return longest;
  }

  void Add(const Part& part)
  {
    const std::size_t index = this->Parts.size();
    this->Parts.push_back(part);
    ++this->NumberOfParts;
    for (std::size_t edge = 0; edge < 3; ++edge)
    {
      const auto found = this->PartsOfEdge.emplace(
        this->Edge(index, edge), std::array<std::size_t, 2>{ index, index });
      if (!found.second)
      {
        found.first->second[1] = index;
      }
    }
  }

  /// Forgets a part that has been divided, and its edges where it was alone.
  void Remove(std::size_t index)
  {
    this->Parts[index].Divided = true;
    --this->NumberOfParts;
    for (std::size_t edge = 0; edge < 3; ++edge)
    {
      const auto found = this->PartsOfEdge.find(this->Edge(index, edge));
      auto& parts = found->second;
      const std::size_t other = parts[0] == index ? parts[1] : parts[0];
      if (other == index)
      {
        this->PartsOfEdge.erase(found);
      }
      else
      {
        parts = { other, other };
      }
    }
  }

  /// Halves an edge, unless that has been done; where a part that has it is a needle, the needle's
  /// longest edge first.
  void HalveWithCare(const std::array<vtkIdType, 2>& ends)
  {
    for (auto found = this->PartsOfEdge.find(ends); found != this->PartsOfEdge.end();
         found = this->PartsOfEdge.find(ends))
    {
      std::array<vtkIdType, 2> first = ends;
      for (const std::size_t part : found->second)
      {
        const auto longest = this->Edge(part, this->LongestEdge(part));
        if (this->Length(longest) > this->Length(first) && this->IsNeedle(part))
        {
          first = longest;
        }
      }
      if (first == ends)
      {
        this->Halve(ends);
        return;
      }
      // The way to ever longer edges ends.
      this->HalveWithCare(first);
    }
  }

  bool IsNeedle(std::size_t index) const
  {
    const auto& points = this->Parts[index].Points;
    const auto corner = [this, &points](std::size_t k) {
      return this->Points[0][static_cast<std::size_t>(points[k])];
    };
    const double length = this->Length(this->Edge(index, this->LongestEdge(index)));
    return std::abs(Area(corner(0), corner(1), corner(2))) < needle * length * length;
  }

  /// Halves an edge, and the parts on both sides of it, unless that has been done.
  void Halve(const std::array<vtkIdType, 2>& ends)
  {
    const auto found = this->PartsOfEdge.find(ends);
    if (found == this->PartsOfEdge.end())
    {
      return;
    }
    const std::array<std::size_t, 2> parts = found->second;
    const auto middle = static_cast<vtkIdType>(this->Points[0].size());
    const Part part = this->Parts[parts[0]];
    const Barycentric place = Middle(part, this->FindEdge(parts[0], ends));
    const auto& corners = this->Triangles[static_cast<std::size_t>(part.Triangle)];
    for (std::size_t side = 0; side < 2; ++side)
    {
      Point point{ 0.0, 0.0 };
      for (std::size_t k = 0; k < 3; ++k)
      {
        const Point& corner = this->Points[side][static_cast<std::size_t>(corners[k])];
        point[0] += place[k] * corner[0];
        point[1] += place[k] * corner[1];
      }
      this->Points[side].push_back(point);
    }
    // Edges of the pair are mapped linearly.
    if (std::find(place.begin(), place.end(), 0.0) == place.end())
    {
      this->Unmapped.push_back(static_cast<std::size_t>(middle));
    }
    this->HalvePart(parts[0], ends, middle);
    if (parts[1] != parts[0])
    {
      this->HalvePart(parts[1], ends, middle);
    }
  }

  std::size_t FindEdge(std::size_t part, const std::array<vtkIdType, 2>& ends) const
  {
    std::size_t edge = 0;
    while (this->Edge(part, edge) != ends)
    {
      ++edge;
    }
    return edge;
  }

  static Barycentric Middle(const Part& part, std::size_t edge)
  {
    const Barycentric& a = part.Places[(edge + 1) % 3];
    const Barycentric& b = part.Places[(edge + 2) % 3];
    return { 0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1]), 0.5 * (a[2] + b[2]) };
  }

  void HalvePart(std::size_t index, const std::array<vtkIdType, 2>& ends, vtkIdType middle)
  {
    const Part part = this->Parts[index];
    const std::size_t edge = this->FindEdge(index, ends);
    const Barycentric place = Middle(part, edge);
    this->Remove(index);
    for (const std::size_t end : { (edge + 1) % 3, (edge + 2) % 3 })
    {
      Part half = part;
      half.Points[end] = middle;
      half.Places[end] = place;
      this->Add(half);
    }
  }

  bool IsTurnedOver(const Part& part) const
  {
    const auto area = [this](std::size_t side, const std::array<vtkIdType, 3>& points) {
      const auto& all = this->Points[side];
      return Area(all[static_cast<std::size_t>(points[0])],
        all[static_cast<std::size_t>(points[1])], all[static_cast<std::size_t>(points[2])]);
    };
    const auto& triangle = this->Triangles[static_cast<std::size_t>(part.Triangle)];
    const bool mirrored = (area(0, triangle) > 0.0) != (area(1, triangle) > 0.0);
    const double product = area(0, part.Points) * area(1, part.Points);
    return !(mirrored ? product < 0.0 : product > 0.0);
  }

  std::vector<Point> MapPoints(const std::vector<Point>& points)
  {
    vtkNew<vtkPoints> places;
    places->SetDataTypeToDouble();
    places->SetNumberOfPoints(static_cast<vtkIdType>(points.size()));
    double first[3];
    this->Pair.Source()->GetPoint(0, first);
    for (std::size_t i = 0; i < points.size(); ++i)
    {
      places->SetPoint(static_cast<vtkIdType>(i), points[i][0], points[i][1], first[2]);
    }
    vtkNew<vtkPolyData> data;
    data->SetPoints(places);
    this->Map->SetDataObject(data);
    Run(this->Map, "", false);
    auto* output = vtkPolyData::SafeDownCast(this->Map->GetOutputDataObject(0));
    vtkDataArray* mask = output->GetPointData()->GetArray("vtkValidPointMask");
    std::vector<Point> images(points.size());
    for (std::size_t i = 0; i < images.size(); ++i)
    {
      double image[3];
      output->GetPoint(static_cast<vtkIdType>(i), image);
      const bool inside = mask->GetTuple1(static_cast<vtkIdType>(i)) != 0.0;
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      images[i] = inside ? Point{ image[0], image[1] } : Point{ none, none };
    }
    return images;
  }

  const MeshPair& Pair;
  vtkNew<vtkDifferentiableHomeomorphism> Map;
  std::array<std::vector<Point>, 2> Points;
  std::vector<std::array<vtkIdType, 3>> Triangles;
  std::vector<Part> Parts;
  vtkIdType NumberOfParts = 0;
  std::unordered_map<std::array<vtkIdType, 2>, std::array<std::size_t, 2>, EdgeHash> PartsOfEdge;
  std::vector<std::size_t> Unmapped;
  vtkIdType Samples = 0;
};

} // namespace

Refinement Refine(
  const MeshPair& pair, const MapOptions& map, double tolerance, vtkIdType mostTriangles)
{
  Refiner refiner(pair, map);
  Refinement result;
  // Looks grow closer: what one finds near enough is looked at by the next. The first two leave a
  // margin for what is farther between their points.
  constexpr std::array<int, 3> divisions{ 6, 20, 33 };
  const std::array<double, 3> limits{ 0.8 * tolerance, 0.8 * tolerance, tolerance };
  const auto requireFew = [&](double reached) {
    if (refiner.GetNumberOfParts() > mostTriangles)
    {
      throw Failure(REFUSED,
        "More than " + std::to_string(mostTriangles) + " triangles are needed to be within " +
          ToText(tolerance) + " everywhere (" + ToText(reached) +
          " was reached): ask for a larger distance, or allow more (--most-triangles).");
    }
  };
  ProgressBar bar("Refining");
  std::vector<std::size_t> parts = refiner.GetParts();
  for (std::size_t look = 0; look < divisions.size();)
  {
    const auto distances = refiner.MeasureDistances(parts, divisions[look]);
    double largest = 0.0;
    for (const auto& distance : distances)
    {
      largest = std::max(largest, distance.Largest);
    }
    requireFew(largest);
    if (largest <= limits[look])
    {
      ++look;
      result.Distance = largest;
      parts = refiner.GetParts();
      continue;
    }
    const std::vector<std::size_t> old = refiner.GetParts();
    for (std::size_t i = 0; i < parts.size(); ++i)
    {
      if (distances[i].Largest > limits[look] && !refiner.IsDivided(parts[i]))
      {
        refiner.Divide(parts[i], distances[i], limits[look]);
      }
      requireFew(largest);
    }
    refiner.MapNewPoints();
    parts = refiner.GetParts();
    if (look == 0)
    {
      // What has not been divided is as good as it was.
      std::vector<std::size_t> fresh;
      std::set_difference(
        parts.begin(), parts.end(), old.begin(), old.end(), std::back_inserter(fresh));
      parts = fresh;
    }
    else
    {
      // So few have been divided that all are looked at again, to have a number for all.
      look = 1;
    }
  }
  result.Samples = refiner.GetNumberOfSamples();
  result.Pair = pair;
  result.Pair.Meshes = refiner.MakeMeshes();
  return result;
}

} // namespace dhm
