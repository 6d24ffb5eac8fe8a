// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Drawing.h"

#include "vtkActor2D.h"
#include "vtkCellArray.h"
#include "vtkDataArray.h"
#include "vtkIdList.h"
#include "vtkImageShrink3D.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPNGWriter.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyDataMapper2D.h"
#include "vtkProperty2D.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkTextActor.h"
#include "vtkTextProperty.h"
#include "vtkTextRenderer.h"
#include "vtkUnsignedCharArray.h"
#include "vtkWindowToImageFilter.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace
{

// Drawn three times as large and averaged, which smooths lines and letters on any renderer.
constexpr int oversampling = 3;
constexpr int dotsPerInch = 72;

/// A piece of a label that is set in one way.
struct Run
{
  std::string Text;
  bool Variable = false;
  /// -1 low, 1 high
  int Level = 0;
};

std::vector<Run> SplitIntoRuns(const std::string& text)
{
  std::vector<Run> runs;
  const auto append = [&runs](const std::string& piece, bool variable, int level) {
    if (runs.empty() || runs.back().Variable != variable || runs.back().Level != level)
    {
      runs.push_back({ "", variable, level });
    }
    runs.back().Text += piece;
  };
  bool variable = false;
  for (std::size_t i = 0; i < text.size(); ++i)
  {
    if (text[i] == '$')
    {
      variable = !variable;
    }
    else if ((text[i] == '_' || text[i] == '^') && i + 1 < text.size())
    {
      const int level = text[i] == '_' ? -1 : 1;
      const std::size_t end = text[i + 1] == '{' ? text.find('}', i) : std::string::npos;
      if (end != std::string::npos)
      {
        append(text.substr(i + 2, end - i - 2), variable, level);
        i = end;
      }
      else
      {
        append(text.substr(i + 1, 1), variable, level);
        ++i;
      }
    }
    else
    {
      append(text.substr(i, 1), variable, 0);
    }
  }
  return runs;
}

void SetLetters(vtkTextProperty* letters, const Run& run, double size)
{
  const double factor = (run.Level == 0 ? 1.0 : 0.72) * (run.Variable ? 1.12 : 1.0);
  letters->SetFontSize(static_cast<int>(std::lround(size * factor * oversampling)));
  if (run.Variable)
  {
    letters->SetFontFamilyToTimes();
    letters->ItalicOn();
  }
  else
  {
    letters->SetFontFamilyToArial();
  }
  letters->SetJustificationToLeft();
  letters->SetVerticalJustificationToBottom();
}

vtkTextRenderer::Metrics Measure(vtkTextProperty* letters, const std::string& text)
{
  vtkTextRenderer::Metrics metrics;
  vtkTextRenderer* const renderer = vtkTextRenderer::GetInstance();
  if (!renderer || !renderer->GetMetrics(letters, text, metrics, dotsPerInch))
  {
    throw std::runtime_error("VTK has no letters to write \"" + text + "\" with.");
  }
  return metrics;
}

/// The width of text with the space around it, which bounding boxes leave out.
int Advance(vtkTextProperty* letters, const std::string& text)
{
  const auto width = [letters](const std::string& t) {
    const auto box = Measure(letters, t).BoundingBox;
    return box[1] - box[0];
  };
  return width("n" + text + "n") - width("nn");
}

void AddText(vtkRenderer* renderer, vtkTextProperty* letters, const std::string& text, double x,
  double y, const Color& color, bool halo)
{
  const auto add = [&](double dx, double dy, const Color& ink) {
    vtkNew<vtkTextActor> actor;
    actor->SetInput(text.c_str());
    actor->GetTextProperty()->ShallowCopy(letters);
    actor->GetTextProperty()->SetColor(ink.Red, ink.Green, ink.Blue);
    actor->SetPosition(std::round(x + dx), std::round(y + dy));
    renderer->AddActor2D(actor);
  };
  if (halo)
  {
    constexpr int copies = 12;
    constexpr double radius = 1.7 * oversampling;
    for (int k = 0; k < copies; ++k)
    {
      const double angle = 2.0 * vtkMath::Pi() * k / copies;
      add(radius * std::cos(angle), radius * std::sin(angle), { 1.0, 1.0, 1.0 });
    }
  }
  add(0.0, 0.0, color);
}

void AddLabel(
  vtkRenderer* renderer, const Point& position, const std::string& content, const Lettering& style)
{
  const double x = position[0] * oversampling;
  const double y = position[1] * oversampling;
  if (style.Orientation != 0.0)
  {
    vtkNew<vtkTextProperty> letters;
    SetLetters(letters, {}, style.Size);
    letters->SetOrientation(style.Orientation);
    letters->SetJustificationToCentered();
    letters->SetVerticalJustificationToCentered();
    AddText(renderer, letters, content, x, y, style.Ink, style.Halo);
    return;
  }

  const std::vector<Run> runs = SplitIntoRuns(content);
  double width = 0.0;
  for (const Run& run : runs)
  {
    vtkNew<vtkTextProperty> letters;
    SetLetters(letters, run, style.Size);
    width += Advance(letters, run.Text);
  }
  const double share =
    style.Horizontal == Alignment::Left ? 0.0 : (style.Horizontal == Alignment::Center ? 0.5 : 1.0);
  double left = x - share * width;
  // Half the height of a capital letter below the middle.
  const double baseline = y - 0.36 * style.Size * oversampling;
  // The halos first, lest they cover the letters beside them.
  for (const bool halo : { true, false })
  {
    double pen = left;
    for (const Run& run : runs)
    {
      vtkNew<vtkTextProperty> letters;
      SetLetters(letters, run, style.Size);
      const double shift =
        (run.Level > 0 ? 0.38 : (run.Level < 0 ? -0.2 : 0.0)) * style.Size * oversampling;
      const double descent = Measure(letters, run.Text).Descent[1];
      if (style.Halo || !halo)
      {
        AddText(renderer, letters, run.Text, pen, baseline + shift + descent,
          halo ? Color{ 1.0, 1.0, 1.0 } : style.Ink, halo);
      }
      pen += Advance(letters, run.Text);
    }
  }
}

unsigned char ToByte(double value)
{
  return static_cast<unsigned char>(std::lround(255.0 * std::clamp(value, 0.0, 1.0)));
}

/// What is left of a convex polygon where coordinate @a axis times @a sign is at most @a limit.
Curve CutOff(const Curve& polygon, std::size_t axis, double sign, double limit)
{
  Curve result;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const Point& a = polygon[i];
    const Point& b = polygon[(i + 1) % polygon.size()];
    const double beyondA = sign * a[axis] - limit;
    const double beyondB = sign * b[axis] - limit;
    if (beyondA <= 0.0)
    {
      result.push_back(a);
    }
    if ((beyondA < 0.0 && beyondB > 0.0) || (beyondA > 0.0 && beyondB < 0.0))
    {
      result.push_back(Between(a, b, beyondA / (beyondA - beyondB)));
    }
  }
  return result;
}

/// The dashes of a line, each as a line of its own.
std::vector<Curve> CutIntoDashes(const Curve& curve, double dash)
{
  std::vector<Curve> dashes(1, Curve{ curve.front() });
  bool drawn = true;
  double left = dash;
  for (std::size_t i = 0; i + 1 < curve.size(); ++i)
  {
    Point from = curve[i];
    double length = Length(Subtract(curve[i + 1], from));
    while (length > left)
    {
      from = Between(from, curve[i + 1], left / length);
      length -= left;
      if (drawn)
      {
        dashes.back().push_back(from);
      }
      else
      {
        dashes.push_back({ from });
      }
      drawn = !drawn;
      left = drawn ? dash : 0.8 * dash;
    }
    left -= length;
    if (drawn)
    {
      dashes.back().push_back(curve[i + 1]);
    }
  }
  return dashes;
}

} // namespace

// --- Points
// ---------------------------------------------------------------------------------------

Point Add(const Point& a, const Point& b, double factor)
{
  return { a[0] + factor * b[0], a[1] + factor * b[1] };
}

Point Subtract(const Point& a, const Point& b)
{
  return { a[0] - b[0], a[1] - b[1] };
}

Point Between(const Point& a, const Point& b, double proportion)
{
  return Add(a, Subtract(b, a), proportion);
}

double ScalarProduct(const Point& a, const Point& b)
{
  return a[0] * b[0] + a[1] * b[1];
}

double Length(const Point& a)
{
  return std::hypot(a[0], a[1]);
}

std::string Decimal(double value, int decimals)
{
  char digits[64];
  std::snprintf(digits, sizeof digits, "%.*f", decimals, std::abs(value));
  const bool negative = value < 0.0 && std::strtod(digits, nullptr) != 0.0;
  return (negative ? "\u2212" : "") + std::string(digits);
}

// --- Panel
// ----------------------------------------------------------------------------------------

Panel::Panel(Drawing& drawing, const Rectangle& place, const Rectangle& world, bool stretched)
  : Page(drawing)
  , Place(place)
  , Scale({ place.Width / world.Width, place.Height / world.Height })
{
  if (!stretched)
  {
    this->Scale[0] = this->Scale[1] = std::min(this->Scale[0], this->Scale[1]);
  }
  this->Origin = { place.Left + 0.5 * place.Width -
      this->Scale[0] * (world.Left + 0.5 * world.Width),
    place.Bottom + 0.5 * place.Height - this->Scale[1] * (world.Bottom + 0.5 * world.Height) };
}

Point Panel::ToPage(const Point& point) const
{
  return { this->Origin[0] + this->Scale[0] * point[0],
    this->Origin[1] + this->Scale[1] * point[1] };
}

void Panel::Triangle(const Point& a, const Point& b, const Point& c, const Color& color)
{
  Curve polygon{ a, b, c };
  polygon = CutOff(polygon, 0, -1.0, -this->Place.Left);
  polygon = CutOff(polygon, 0, 1.0, this->Place.Left + this->Place.Width);
  polygon = CutOff(polygon, 1, -1.0, -this->Place.Bottom);
  polygon = CutOff(polygon, 1, 1.0, this->Place.Bottom + this->Place.Height);
  for (std::size_t i = 2; i < polygon.size(); ++i)
  {
    this->Page.Corners.insert(this->Page.Corners.end(), { polygon[0], polygon[i - 1], polygon[i] });
    this->Page.Colors.insert(this->Page.Colors.end(), 3,
      { ToByte(color.Red), ToByte(color.Green), ToByte(color.Blue), ToByte(color.Opacity) });
  }
}

void Panel::Fill(const Curve& polygon, const Color& color)
{
  Point mean{ 0.0, 0.0 };
  for (const Point& corner : polygon)
  {
    mean = Add(mean, corner, 1.0 / static_cast<double>(polygon.size()));
  }
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    this->Triangle(this->ToPage(mean), this->ToPage(polygon[i]),
      this->ToPage(polygon[(i + 1) % polygon.size()]), color);
  }
}

void Panel::Hatch(const Curve& polygon, double spacing, const Pen& pen)
{
  Curve corners;
  for (const Point& corner : polygon)
  {
    corners.push_back(this->ToPage(corner));
  }
  // The lines x - y = constant, a multiple of the same on the whole page.
  const auto height = [](const Point& p) { return (p[0] - p[1]) * std::sqrt(0.5); };
  double lowest = height(corners[0]);
  double highest = lowest;
  for (const Point& corner : corners)
  {
    lowest = std::min(lowest, height(corner));
    highest = std::max(highest, height(corner));
  }
  const int first = static_cast<int>(std::ceil(lowest / spacing));
  for (int line = first; line * spacing < highest; ++line)
  {
    const double level = line * spacing;
    Curve ends;
    for (std::size_t i = 0; i < corners.size(); ++i)
    {
      const Point& a = corners[i];
      const Point& b = corners[(i + 1) % corners.size()];
      const double share = (level - height(a)) / (height(b) - height(a));
      if (share >= 0.0 && share < 1.0)
      {
        ends.push_back(Between(a, b, share));
      }
    }
    if (ends.size() == 2)
    {
      this->StrokeOnPage(ends, pen);
    }
  }
}

void Panel::DotOnPage(const Point& center, double radius, const Color& color)
{
  const int pieces = std::max(10, static_cast<int>(4.0 * std::sqrt(radius * oversampling)) + 8);
  Point last = Add(center, { radius, 0.0 });
  for (int k = 1; k <= pieces; ++k)
  {
    const double angle = 2.0 * vtkMath::Pi() * k / pieces;
    const Point next = Add(center, { std::cos(angle), std::sin(angle) }, radius);
    this->Triangle(center, last, next, color);
    last = next;
  }
}

void Panel::StrokeOnPage(const Curve& curve, const Pen& pen)
{
  if (pen.Dash > 0.0 && !curve.empty())
  {
    for (const Curve& dash : CutIntoDashes(curve, pen.Dash))
    {
      this->StrokeOnPage(dash, { pen.Ink, pen.Width, 0.0 });
    }
    return;
  }
  // A rectangle along each piece, and round joints.
  const double half = 0.5 * pen.Width;
  Point from{};
  Point sideBefore{};
  bool begun = false;
  for (std::size_t i = 0; i < curve.size(); ++i)
  {
    if (i == 0)
    {
      from = curve[i];
      continue;
    }
    const Point& to = curve[i];
    const Point along = Subtract(to, from);
    const double length = Length(along);
    if (length < 0.02 || (length < 0.2 && i + 1 < curve.size()))
    {
      continue;
    }
    const Point side{ -along[1] * half / length, along[0] * half / length };
    this->Triangle(Add(from, side), Subtract(from, side), Add(to, side), pen.Ink);
    this->Triangle(Add(to, side), Subtract(from, side), Subtract(to, side), pen.Ink);
    if (begun)
    {
      if (ScalarProduct(side, sideBefore) < 0.95 * half * half)
      {
        this->DotOnPage(from, half, pen.Ink);
      }
      else
      {
        this->Triangle(from, Add(from, sideBefore), Add(from, side), pen.Ink);
        this->Triangle(from, Subtract(from, sideBefore), Subtract(from, side), pen.Ink);
      }
    }
    sideBefore = side;
    begun = true;
    from = to;
  }
}

void Panel::Stroke(const Curve& curve, const Pen& pen)
{
  Curve onPage;
  onPage.reserve(curve.size());
  for (const Point& point : curve)
  {
    onPage.push_back(this->ToPage(point));
  }
  this->StrokeOnPage(onPage, pen);
}

void Panel::StrokeClosed(Curve polygon, const Pen& pen)
{
  polygon.push_back(polygon[0]);
  if (pen.Dash == 0.0)
  {
    // Beyond the first corner, for a joint there.
    polygon.push_back(Between(polygon[0], polygon[1], 0.5));
  }
  this->Stroke(polygon, pen);
}

void Panel::StrokeLines(vtkPolyData* lines, const Pen& pen)
{
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < lines->GetLines()->GetNumberOfCells(); ++cell)
  {
    lines->GetLines()->GetCellAtId(cell, ids);
    Curve curve;
    for (vtkIdType i = 0; i < ids->GetNumberOfIds(); ++i)
    {
      double point[3];
      lines->GetPoint(ids->GetId(i), point);
      curve.push_back({ point[0], point[1] });
    }
    this->Stroke(curve, pen);
  }
}

void Panel::StrokeEdges(vtkPolyData* mesh, const Pen& pen)
{
  std::set<std::pair<vtkIdType, vtkIdType>> drawn;
  vtkNew<vtkIdList> ids;
  for (vtkIdType cell = 0; cell < mesh->GetPolys()->GetNumberOfCells(); ++cell)
  {
    mesh->GetPolys()->GetCellAtId(cell, ids);
    const vtkIdType count = ids->GetNumberOfIds();
    for (vtkIdType i = 0; i < count; ++i)
    {
      const auto ends = std::minmax({ ids->GetId(i), ids->GetId((i + 1) % count) });
      if (drawn.insert(ends).second)
      {
        double a[3];
        double b[3];
        mesh->GetPoint(ends.first, a);
        mesh->GetPoint(ends.second, b);
        this->Stroke({ { a[0], a[1] }, { b[0], b[1] } }, pen);
        // Round ends, which join the edges at a vertex.
        this->DotOnPage(this->ToPage({ a[0], a[1] }), 0.5 * pen.Width, pen.Ink);
        this->DotOnPage(this->ToPage({ b[0], b[1] }), 0.5 * pen.Width, pen.Ink);
      }
    }
  }
}

void Panel::StrokeArc(
  const Point& center, double radius, double fromAngle, double toAngle, const Pen& pen)
{
  constexpr int pieces = 120;
  Curve arc;
  for (int k = 0; k <= pieces; ++k)
  {
    const double angle = fromAngle + (toAngle - fromAngle) * k / pieces;
    arc.push_back(Add(center, { std::cos(angle), std::sin(angle) }, radius));
  }
  this->Stroke(arc, pen);
}

void Panel::StrokeCircle(const Point& center, double radius, const Pen& pen)
{
  this->StrokeArc(center, radius, 0.0, 2.0 * vtkMath::Pi(), pen);
}

void Panel::FillCircle(const Point& center, double radius, const Color& color)
{
  constexpr int pieces = 120;
  Curve circle;
  for (int k = 0; k < pieces; ++k)
  {
    const double angle = 2.0 * vtkMath::Pi() * k / pieces;
    circle.push_back(Add(center, { std::cos(angle), std::sin(angle) }, radius));
  }
  this->Fill(circle, color);
}

void Panel::Dot(const Point& center, double radius, const Color& color)
{
  this->DotOnPage(this->ToPage(center), radius, color);
}

void Panel::Ring(const Point& center, double radius, const Color& inside, const Pen& pen)
{
  this->Dot(center, radius + 0.5 * pen.Width, pen.Ink);
  this->Dot(center, radius - 0.5 * pen.Width, inside);
}

void Panel::Arrow(const Point& from, const Point& to, const Pen& pen)
{
  const Point a = this->ToPage(from);
  const Point b = this->ToPage(to);
  const double length = Length(Subtract(b, a));
  const Point along = Between({ 0.0, 0.0 }, Subtract(b, a), 1.0 / length);
  const Point side{ -along[1], along[0] };
  const double head = 5.0 + 2.5 * pen.Width;
  const Point base = Add(b, along, -head);
  this->StrokeOnPage({ a, Add(b, along, -0.8 * head) }, pen);
  this->Triangle(b, Add(base, side, 0.36 * head), Add(base, side, -0.36 * head), pen.Ink);
}

void Panel::RightAngle(
  const Point& corner, const Point& first, const Point& second, double size, const Pen& pen)
{
  const Point origin = this->ToPage(corner);
  const auto leg = [&](const Point& end) {
    const Point along = Subtract(this->ToPage(end), origin);
    return Between({ 0.0, 0.0 }, along, size / Length(along));
  };
  const Point a = leg(first);
  const Point b = leg(second);
  this->StrokeOnPage({ Add(origin, a), Add(Add(origin, a), b), Add(origin, b) }, pen);
}

void Panel::Image(vtkImageData* image)
{
  int size[3];
  image->GetDimensions(size);
  const double* origin = image->GetOrigin();
  const double* spacing = image->GetSpacing();
  for (int row = 0; row < size[1]; ++row)
  {
    for (int column = 0; column < size[0]; ++column)
    {
      const auto component = [&](int k) {
        return image->GetScalarComponentAsDouble(column, row, 0, k) / 255.0;
      };
      const Color color{ component(0), component(1), component(2) };
      const double left = origin[0] + (column - 0.5) * spacing[0];
      const double bottom = origin[1] + (row - 0.5) * spacing[1];
      const Point a = this->ToPage({ left, bottom });
      const Point b = this->ToPage({ left + spacing[0], bottom + spacing[1] });
      this->Triangle(a, { b[0], a[1] }, b, color);
      this->Triangle(a, b, { a[0], b[1] }, color);
    }
  }
}

void Panel::Frame(const Pen& pen)
{
  const double right = this->Place.Left + this->Place.Width;
  const double top = this->Place.Bottom + this->Place.Height;
  Panel page = this->Page.GetPage();
  page.StrokeClosed({ { this->Place.Left, this->Place.Bottom }, { right, this->Place.Bottom },
                      { right, top }, { this->Place.Left, top } },
    pen);
}

void Panel::Label(
  const Point& point, const std::string& text, const Lettering& lettering, const Point& offset)
{
  this->Page.Texts.push_back({ Add(this->ToPage(point), offset), text, lettering });
}

// --- Drawing
// --------------------------------------------------------------------------------------

Drawing::Drawing(int width, int height)
  : Width(width)
  , Height(height)
{
}

Panel Drawing::GetPage()
{
  const Rectangle all{ 0.0, 0.0, static_cast<double>(this->Width),
    static_cast<double>(this->Height) };
  return { *this, all, all };
}

void Drawing::ColorBar(const Rectangle& place, const std::function<Color(double)>& colorOf,
  const std::vector<std::pair<double, std::string>>& ticks)
{
  Panel page = this->GetPage();
  const double right = place.Left + place.Width;
  const int steps = static_cast<int>(place.Height) * oversampling;
  for (int k = 0; k < steps; ++k)
  {
    const double bottom = place.Bottom + place.Height * k / steps;
    const double top = place.Bottom + place.Height * (k + 1) / steps;
    page.Fill({ { place.Left, bottom }, { right, bottom }, { right, top }, { place.Left, top } },
      colorOf((k + 0.5) / steps));
  }
  const Pen thin{ { 0.13, 0.14, 0.17 }, 1.0 };
  for (const auto& [position, label] : ticks)
  {
    const double y = place.Bottom + position * place.Height;
    page.Stroke({ { right, y }, { right + 5.0, y } }, thin);
    Lettering lettering;
    lettering.Size = 14.0;
    lettering.Horizontal = Alignment::Left;
    page.Label({ right + 9.0, y }, label, lettering);
  }
  Panel(*this, place, place).Frame(thin);
}

void Drawing::Write(const std::string& fileName) const
{
  vtkNew<vtkPoints> points;
  vtkNew<vtkCellArray> triangles;
  vtkNew<vtkUnsignedCharArray> colors;
  colors->SetNumberOfComponents(4);
  for (std::size_t i = 0; i < this->Corners.size(); ++i)
  {
    const vtkIdType id = points->InsertNextPoint(
      oversampling * this->Corners[i][0], oversampling * this->Corners[i][1], 0.0);
    colors->InsertNextTypedTuple(this->Colors[i].data());
    if (i % 3 == 2)
    {
      triangles->InsertNextCell({ id - 2, id - 1, id });
    }
  }
  vtkNew<vtkPolyData> shapes;
  shapes->SetPoints(points);
  shapes->SetPolys(triangles);
  shapes->GetPointData()->SetScalars(colors);
  vtkNew<vtkPolyDataMapper2D> mapper;
  mapper->SetInputData(shapes);
  vtkNew<vtkActor2D> actor;
  actor->SetMapper(mapper);

  vtkNew<vtkRenderer> renderer;
  renderer->SetBackground(1.0, 1.0, 1.0);
  renderer->AddActor2D(actor);
  for (const Text& text : this->Texts)
  {
    AddLabel(renderer, text.Position, text.Content, text.Style);
  }
  vtkNew<vtkRenderWindow> window;
  window->SetOffScreenRendering(1);
  window->SetMultiSamples(0);
  window->SetDPI(dotsPerInch);
  window->SetSize(oversampling * this->Width, oversampling * this->Height);
  window->AddRenderer(renderer);
  window->Render();

  vtkNew<vtkWindowToImageFilter> capture;
  capture->SetInput(window);
  capture->ReadFrontBufferOff();
  vtkNew<vtkImageShrink3D> smaller;
  smaller->SetInputConnection(capture->GetOutputPort());
  smaller->SetShrinkFactors(oversampling, oversampling, 1);
  smaller->MeanOn();
  vtkNew<vtkPNGWriter> writer;
  writer->SetInputConnection(smaller->GetOutputPort());
  writer->SetFileName(fileName.c_str());
  writer->Write();
  if (writer->GetErrorCode() != 0)
  {
    throw std::runtime_error("Cannot write " + fileName + ".");
  }
  std::cout << "wrote " << fileName << std::endl;
}

// --- The programs
// ---------------------------------------------------------------------------------

int RunFigure(int argc, char* argv[], const std::vector<std::string>& options,
  const std::function<void(const std::string&, const std::vector<std::string>&)>& draw)
{
  std::string folder;
  std::vector<std::string> given;
  for (int i = 1; i < argc; ++i)
  {
    const std::string argument = argv[i];
    if (std::find(options.begin(), options.end(), argument) != options.end())
    {
      given.push_back(argument);
    }
    else if (folder.empty() && !argument.empty() && argument[0] != '-')
    {
      folder = argument;
    }
    else
    {
      std::cerr << "Usage: " << std::filesystem::path(argv[0]).filename().string();
      for (const std::string& option : options)
      {
        std::cerr << " [" << option << "]";
      }
      std::cerr << " [OUTPUT_FOLDER]\n";
      return EXIT_FAILURE;
    }
  }
  if (folder.empty())
  {
    folder = "Output/Figures";
  }
  try
  {
    std::filesystem::create_directories(folder);
    draw(folder, given);
  }
  catch (const std::exception& error)
  {
    std::cerr << error.what() << "\n";
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
