// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// The contours of the published construction: those of a triangle, and how one is made in half an
// edge's share of it.

#include "Drawing.h"
#include "Meshes.h"

#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

const Color ink{ 0.13, 0.14, 0.17 };
const Color contourColor{ 0.13, 0.40, 0.67 };
const Color faintColor{ 0.62, 0.74, 0.87 };
const Color centerColor{ 0.80, 0.36, 0.08 };
const Color wingColor{ 0.16, 0.52, 0.30 };

Point Foot(const Point& point, const Point& a, const Point& b)
{
  const Point edge = Subtract(b, a);
  return Add(a, edge, ScalarProduct(Subtract(point, a), edge) / ScalarProduct(edge, edge));
}

/// Of the points of some lines, the one nearest to a place.
Point NearestPoint(vtkPolyData* lines, const Point& place)
{
  Point nearest{};
  double least = VTK_DOUBLE_MAX;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < lines->GetLines()->GetNumberOfCells(); ++cell)
  {
    lines->GetLines()->GetCellAtId(cell, ids);
    for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
    {
      const double* found = lines->GetPoint(ids->GetId(i));
      const Point point{ found[0], found[1] };
      const double distance = Length(Subtract(point, place));
      if (distance < least)
      {
        least = distance;
        nearest = point;
      }
    }
  }
  return nearest;
}

/// The letter phi, which VTK's own letters lack, about a point of the page.
void DrawPhi(Panel page, const Point& middle)
{
  constexpr int pieces = 48;
  constexpr double slant = 0.22;
  Curve bowl;
  for (int k = 0; k < pieces; ++k)
  {
    const double angle = 2.0 * vtkMath::Pi() * k / pieces;
    const double y = 5.2 * std::sin(angle);
    bowl.push_back(Add(middle, { 5.6 * std::cos(angle) + slant * y, y }));
  }
  const Curve stem{ Add(middle, { -10.5 * slant, -10.5 }), Add(middle, { 10.5 * slant, 10.5 }) };
  for (const Pen& pen : { Pen{ { 1.0, 1.0, 1.0 }, 5.0 }, Pen{ ink, 1.7 } })
  {
    page.StrokeClosed(bowl, pen);
    page.Stroke(stem, pen);
  }
}

void DrawTriangle(Panel& panel)
{
  const Curve corners{ { 0.0, 0.0 }, { 4.4, 0.35 }, { 1.55, 3.6 } };
  const auto mesh = MakeMesh(corners, { { 0, 1, 2 } });
  const auto coordinates = MakeCoordinates(mesh, vtkTriangularCoordinates::CONTOUR, 8, 1);
  if (!IsConcordant(coordinates, 0))
  {
    throw std::runtime_error("The triangle is discordant.");
  }
  const Point center = Between(corners[0], Between(corners[1], corners[2], 0.5), 2.0 / 3.0);
  Curve feet;
  Curve hexagon;
  for (std::size_t k = 0; k < 3; ++k)
  {
    feet.push_back(Foot(center, corners[k], corners[(k + 1) % 3]));
  }
  for (std::size_t k = 0; k < 3; ++k)
  {
    // Its sides are the wing segments.
    hexagon.push_back(Between(center, feet[k], 0.5));
    hexagon.push_back(corners[(k + 1) % 3]);
  }
  panel.Fill(corners, { 0.985, 0.988, 0.994 });
  for (std::size_t k = 0; k < 6; ++k)
  {
    panel.Fill({ center, hexagon[k], hexagon[(k + 1) % 6] }, { 0.99, 0.93, 0.78 });
  }
  panel.StrokeLines(
    SelectLines(coordinates, vtkTriangularCoordinates::CONTOUR_LINE), { faintColor, 1.2 });
  panel.StrokeLines(
    SelectLines(coordinates, vtkTriangularCoordinates::WING_SEGMENT), { wingColor, 2.0 });
  panel.StrokeLines(
    SelectLines(coordinates, vtkTriangularCoordinates::CENTER_SEGMENT), { centerColor, 2.4 });
  for (std::size_t k = 0; k < 3; ++k)
  {
    panel.RightAngle(feet[k], center, corners[k], 11.0, { centerColor, 1.4 });
    panel.Dot(Between(center, feet[k], 0.5), 3.6, wingColor);
  }
  panel.StrokeEdges(mesh, { ink, 2.6 });
  panel.Dot(center, 4.8, ink);
  panel.Label(center, "$G$", { 20.0 }, { -15.0, 13.0 });

  // Names beside the triangle, with lines that lead to what they name.
  const auto name = [&panel](const Point& thing, const Point& place, const std::string& text,
                      const Color& color) {
    panel.Stroke({ thing, place }, { color, 1.0 });
    panel.Dot(thing, 2.4, color);
    Lettering letters{ 17.0, color };
    letters.Horizontal = Alignment::Left;
    panel.Label(place, text, letters, { 6.0, 0.0 });
  };
  name(Between(center, feet[1], 0.78), { 3.05, 2.75 }, "center segment", centerColor);
  name(Between(hexagon[2], corners[1], 0.36), { 3.4, 2.2 }, "wing segment", wingColor);
  const Point place{ 3.75, 1.65 };
  const auto contours = SelectLines(coordinates, vtkTriangularCoordinates::CONTOUR_LINE);
  name(NearestPoint(contours, { 3.5, 1.13 }), place, "contour", contourColor);
}

void DrawConstruction(Panel& panel, const Panel& page)
{
  // The half edge from its foot, at the origin, to its end.
  constexpr double h = 3.1;
  constexpr double b = 4.4;
  constexpr double s = 0.46;
  const double straight = 0.5 * std::hypot(h * (1.0 + s), 2.0 * b * s);
  const double phi = std::atan2(2.0 * b * s, h * (1.0 + s));
  const double radius = h * (1.0 - s) * straight / (2.0 * b * s);
  const Point foot{ 0.0, 0.0 };
  const Point center{ 0.0, h };
  const Point end{ b, 0.0 };
  const Point middle{ 0.0, 0.5 * h };
  const Point wing{ b * s, 0.5 * h * (1.0 - s) };
  const Point arcCenter{ b * s - h * h * (1.0 - s * s) / (4.0 * b * s), 0.0 };
  const Point edgePoint{ arcCenter[0] + radius, 0.0 };

  // The contour through the wing point must be the library's.
  const auto mesh = MakeMesh({ { -b, 0.0 }, end, { 0.0, 3.0 * h } }, { { 0, 1, 2 } });
  const auto data = MakeMesh({ wing, edgePoint, center }, {});
  const auto coordinates = MakeCoordinates(mesh, vtkTriangularCoordinates::CONTOUR, 1, 1);
  coordinates->SetDataObject(data);
  coordinates->Update();
  vtkPointData* const found =
    vtkPolyData::SafeDownCast(coordinates->GetOutputDataObject(0))->GetPointData();
  const double difference = std::max(
    { std::abs(found->GetArray("EdgeParameter")->GetTuple1(0) - 0.5 * (1.0 + edgePoint[0] / b)),
      std::abs(found->GetArray("EdgeParameter")->GetTuple1(1) - 0.5 * (1.0 + edgePoint[0] / b)),
      std::abs(found->GetArray("ContourParameter")->GetTuple1(0) -
        straight / (straight + radius * phi)) });
  std::cout << "largest difference from the library's coordinates " << difference << "\n";
  if (!(difference < 1e-12))
  {
    throw std::runtime_error("The construction is not the library's.");
  }

  const Color gray{ 0.45, 0.47, 0.52 };
  panel.Fill({ foot, end, center }, { 0.985, 0.988, 0.994 });
  panel.Fill({ center, middle, end }, { 0.99, 0.93, 0.78 });
  panel.Stroke({ center, end }, { { 0.6, 0.62, 0.67 }, 1.4, 6.0 });
  panel.Stroke({ arcCenter, wing }, { gray, 1.5, 5.0 });
  panel.StrokeArc(arcCenter, radius, phi, vtkMath::Pi(), { faintColor, 1.4, 5.0 });
  panel.Stroke({ middle, end }, { wingColor, 2.0 });
  panel.Stroke({ center, foot }, { centerColor, 2.4 });
  panel.Stroke({ { -0.3, 0.0 }, Add(end, { 0.25, 0.0 }) }, { ink, 2.6 });
  panel.RightAngle(foot, center, end, 12.0, { centerColor, 1.4 });
  panel.RightAngle(edgePoint, end, Add(edgePoint, { 0.0, 1.0 }), 12.0, { contourColor, 1.4 });
  panel.RightAngle(wing, center, arcCenter, 11.0, { gray, 1.3 });
  panel.StrokeArc(arcCenter, 0.34, 0.0, phi, { ink, 1.3 });
  panel.Stroke({ center, wing }, { contourColor, 3.4 });
  panel.StrokeArc(arcCenter, radius, 0.0, phi, { contourColor, 3.4 });
  for (const Point& point : { foot, center, end, wing, arcCenter, edgePoint })
  {
    panel.Dot(point, 4.4, ink);
  }
  panel.Dot(middle, 3.6, wingColor);

  const Lettering letters{ 20.0 };
  panel.Label(center, "$G$", letters, { -17.0, 6.0 });
  panel.Label(foot, "$F$", letters, { 0.0, -19.0 });
  panel.Label(wing, "$W$", letters, { 16.0, 13.0 });
  panel.Label(arcCenter, "$O$", letters, { 0.0, -19.0 });
  panel.Label(edgePoint, "$E$", letters, { 0.0, -19.0 });
  panel.Label(Between(arcCenter, wing, 0.58), "$r$", letters, { -10.0, 8.0 });
  const Point onArc = Add(arcCenter, { std::cos(0.5 * phi), std::sin(0.5 * phi) }, 0.34);
  DrawPhi(page, Add(panel.ToPage(onArc), { 15.0, 5.0 }));

  const Pen measure{ gray, 1.2 };
  const double below = -0.52;
  panel.Arrow({ 0.5 * b, below }, { 0.0, below }, measure);
  panel.Arrow({ 0.5 * b, below }, { b, below }, measure);
  panel.Label({ 0.5 * b, below }, "$b$", letters, { 0.0, 0.0 });
  const double beside = -0.42;
  panel.Arrow({ beside, 0.5 * h }, { beside, 0.0 }, measure);
  panel.Arrow({ beside, 0.5 * h }, { beside, h }, measure);
  panel.Label({ beside, 0.5 * h }, "$h$", letters);
}

void Draw(const std::string& folder)
{
  Drawing drawing(1240, 520);
  Panel whole(drawing, { 10.0, 10.0, 600.0, 500.0 }, { -0.1, -0.1, 4.6, 3.8 });
  DrawTriangle(whole);
  Panel half(drawing, { 630.0, 10.0, 600.0, 500.0 }, { -0.65, -0.7, 5.4, 4.0 });
  DrawConstruction(half, drawing.GetPage());
  drawing.Write(folder + "/figure-3-contours.png");
}

} // namespace

int main(int argc, char* argv[])
{
  return RunFigure(argc, argv, {},
    [](const std::string& folder, const std::vector<std::string>&) { Draw(folder); });
}
