// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "CoordinateLines.h"

#include "VTKVersions.h"

#include "vtkTriangularCoordinates.h"

#include "vtkAlgorithm.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkDoubleArray.h"
#include "vtkIdTypeArray.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"

#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

namespace homeomorphism
{
namespace
{

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Collects polylines with the arrays that describe them.
class LineCollector
{
public:
  explicit LineCollector(const Homeomorphism& map)
    : Map(map)
    , Geometry(map.GetPair().GetGeometry(Domain::Source))
  {
    this->Points->SetDataTypeToDouble();
    this->Type->SetName("LineType");
    this->Triangle->SetName("TriangleId");
    this->Edge->SetName("EdgeLabel");
    this->EdgeParameter->SetName("EdgeParameter");
    this->ContourParameter->SetName("ContourParameter");
  }

  /// A polyline through points of the frame of a triangle.
  void Add(TriangleIndex triangle, const std::vector<Vector2>& line, int type, int edge,
    double edgeParameter, double contourParameter)
  {
    this->Lines->InsertNextCell(static_cast<int>(line.size()));
    for (const Vector2& inFrame : line)
    {
      double point[3];
      this->Geometry.FromNormalized(this->Geometry.FromFrame(triangle, { inFrame, 0.0 }), point);
      this->Lines->InsertCellPoint(this->Points->InsertNextPoint(point));
    }
    this->Type->InsertNextValue(type);
    this->Triangle->InsertNextValue(this->Map.GetPair().GetTriangulation().GetCellId(triangle));
    this->Edge->InsertNextValue(edge);
    this->EdgeParameter->InsertNextValue(edgeParameter);
    this->ContourParameter->InsertNextValue(contourParameter);
  }

  void Finish(vtkPolyData* output)
  {
    output->SetPoints(this->Points);
    output->SetLines(this->Lines);
    output->GetCellData()->AddArray(this->Triangle);
    output->GetCellData()->AddArray(this->Edge);
    output->GetCellData()->AddArray(this->EdgeParameter);
    output->GetCellData()->AddArray(this->ContourParameter);
    output->GetCellData()->SetScalars(this->Type);
  }

private:
  const Homeomorphism& Map;
  const MeshGeometry& Geometry;
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Lines;
  vtkNew<vtkIntArray> Type;
  vtkNew<vtkIdTypeArray> Triangle;
  vtkNew<vtkIntArray> Edge;
  vtkNew<vtkDoubleArray> EdgeParameter;
  vtkNew<vtkDoubleArray> ContourParameter;
};

/// A polyline through the images of evenly spaced points of [0, 1].
template <typename PointAt>
std::vector<Vector2> Sample(int pieces, PointAt&& pointAt)
{
  std::vector<Vector2> line;
  line.reserve(pieces + 1);
  for (int i = 0; i <= pieces; ++i)
  {
    line.push_back(pointAt(static_cast<double>(i) / pieces));
  }
  return line;
}

/// Center and wing segments. @a construction is the chart on whose triangle they are straight, @a
/// toShown maps that triangle to the triangle shown.
template <typename ToShown>
void AddGuides(LineCollector& lines, TriangleIndex triangle, const ContourChart& construction,
  const TriangleShape& shape, int pieces, ToShown&& toShown)
{
  const Vector2 center = construction.Center();
  const auto addSegment = [&](const Vector2& from, const Vector2& to, int type, int edge) {
    lines.Add(triangle,
      Sample(pieces, [&](double t) { return toShown((1.0 - t) * from + t * to); }), type, edge,
      none, none);
  };
  for (int edge = 1; edge <= 3; ++edge)
  {
    const Vector2 foot = construction.Foot(edge);
    const Vector2 middle = 0.5 * (center + foot);
    addSegment(center, foot, vtkTriangularCoordinates::CENTER_SEGMENT, edge);
    addSegment(
      shape.Corner(NextCorner(edge - 1)), middle, vtkTriangularCoordinates::WING_SEGMENT, edge);
    addSegment(
      shape.Corner(PreviousCorner(edge - 1)), middle, vtkTriangularCoordinates::WING_SEGMENT, edge);
  }
}

} // namespace

void MakeCoordinateLines(vtkAlgorithm* self, const Homeomorphism& map,
  const CoordinateLineOptions& options, vtkPolyData* output)
{
  const Triangulation& topology = map.GetPair().GetTriangulation();
  const ChartedTriangulation& charts = map.GetCharts(Domain::Source);
  LineCollector lines(map);
  for (TriangleIndex t = 0; t < topology.GetNumberOfTriangles(); ++t)
  {
    if (t % 1024 == 0)
    {
      self->UpdateProgress(0.1 * t / topology.GetNumberOfTriangles());
      if (ShouldAbort(self))
      {
        break;
      }
    }
    if (topology.IsMasked(t))
    {
      continue;
    }
    const auto pointAt = [&](int edge, double p, double c) {
      return charts.FromCoordinates(t, { edge, p, c });
    };
    charts.VisitChart(t, [&](const auto& chart) {
      using Chart = std::decay_t<decltype(chart)>;
      if constexpr (std::is_same_v<Chart, ContourChart>)
      {
        AddGuides(lines, t, chart, charts.GetGeometry().GetShape(t), 1,
          [](const Vector2& point) { return point; });
      }
      else
      {
        // The guides of the equilateral triangle, mapped by the chart.
        AddGuides(lines, t, ContourChart::Equilateral(), ContourChart::EquilateralShape(),
          options.Resolution, [&chart](const Vector2& point) {
            return chart.ToPoint(ContourChart::EquilateralShape().ToBarycentric(point));
          });
      }
    });
    for (int edge = 1; edge <= 3; ++edge)
    {
      // p = 1 equals p = 0 of the next edge.
      for (int i = 0; i < options.NumberOfContours; ++i)
      {
        const double p = static_cast<double>(i) / options.NumberOfContours;
        lines.Add(t, Sample(options.Resolution, [&](double c) { return pointAt(edge, p, c); }),
          vtkTriangularCoordinates::CONTOUR_LINE, edge, p, none);
      }
    }
    for (int i = 1; i < options.NumberOfRings; ++i)
    {
      const double c = static_cast<double>(i) / options.NumberOfRings;
      std::vector<Vector2> ring;
      for (int edge = 1; edge <= 3; ++edge)
      {
        const std::vector<Vector2> domain =
          Sample(options.Resolution, [&](double p) { return pointAt(edge, p, c); });
        ring.insert(ring.end(), domain.begin() + (edge > 1 ? 1 : 0), domain.end());
      }
      lines.Add(t, ring, vtkTriangularCoordinates::RING_LINE, 0, none, c);
    }
  }
  lines.Finish(output);
}

} // namespace homeomorphism
