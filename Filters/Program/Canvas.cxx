// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "Canvas.h"

#include "Failure.h"
#include "ImageWarp.h"
#include "MeshParts.h"
#include "OutputFile.h"

#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>

namespace dhm
{

class Canvas::Internals
{
public:
  Internals(double width, double height, const OutputFile& file)
    : File(file)
  {
    if (file.GetFormat() == "svg")
    {
      this->Surface = cairo_svg_surface_create_for_stream(&Internals::Keep, this, width, height);
    }
    else if (file.GetFormat() == "pdf")
    {
      this->Surface = cairo_pdf_surface_create_for_stream(&Internals::Keep, this, width, height);
    }
    else
    {
      this->Surface = cairo_image_surface_create(CAIRO_FORMAT_RGB24,
        static_cast<int>(std::ceil(width)), static_cast<int>(std::ceil(height)));
    }
    this->Context = cairo_create(this->Surface);
    cairo_set_line_join(this->Context, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(this->Context, CAIRO_LINE_CAP_ROUND);
  }

  ~Internals()
  {
    cairo_destroy(this->Context);
    cairo_surface_destroy(this->Surface);
  }

  void SetColor(const Color& color)
  {
    cairo_set_source_rgba(this->Context, color.Red, color.Green, color.Blue, color.Opacity);
  }

  void AddPath(vtkPolyData* data, vtkIdType count, const vtkIdType* points, bool closed)
  {
    for (vtkIdType k = 0; k < count; ++k)
    {
      double p[3];
      data->GetPoint(points[k], p);
      if (k == 0)
      {
        cairo_move_to(this->Context, p[0], p[1]);
      }
      else
      {
        cairo_line_to(this->Context, p[0], p[1]);
      }
    }
    if (closed)
    {
      cairo_close_path(this->Context);
    }
  }

  /// Strokes the path with a line whose width is in the page's units.
  void Stroke(double width)
  {
    cairo_save(this->Context);
    cairo_identity_matrix(this->Context);
    cairo_set_line_width(this->Context, width);
    cairo_stroke(this->Context);
    cairo_restore(this->Context);
  }

  /// Cairo's own files are closed without a look at whether all could be written.
  static cairo_status_t Keep(void* self, const unsigned char* bytes, unsigned int count)
  {
    static_cast<Internals*>(self)->Bytes.append(reinterpret_cast<const char*>(bytes), count);
    return CAIRO_STATUS_SUCCESS;
  }

  const OutputFile& File;
  std::string Bytes;
  cairo_surface_t* Surface;
  cairo_t* Context;
};

bool Canvas::IsFormat(const std::string& format)
{
  return format == "png" || format == "svg" || format == "pdf";
}

Canvas::Canvas(double width, double height, const OutputFile& file)
  : Internal(std::make_unique<Internals>(width, height, file))
{
}

Canvas::~Canvas() = default;

void Canvas::Enter(const Area& area, const std::array<double, 4>& bounds)
{
  cairo_t* context = this->Internal->Context;
  cairo_save(context);
  cairo_rectangle(context, area.Left, area.Top, area.Width, area.Height);
  cairo_clip(context);
  const double scale =
    std::min(area.Width / (bounds[1] - bounds[0]), area.Height / (bounds[3] - bounds[2]));
  cairo_translate(context, area.Left + 0.5 * area.Width, area.Top + 0.5 * area.Height);
  cairo_scale(context, scale, -scale);
  cairo_translate(context, -0.5 * (bounds[0] + bounds[1]), -0.5 * (bounds[2] + bounds[3]));
}

void Canvas::Leave()
{
  cairo_restore(this->Internal->Context);
}

void Canvas::FillPage(const Color& color)
{
  this->Internal->SetColor(color);
  cairo_paint(this->Internal->Context);
}

void Canvas::DrawFrame(const Area& area, const Color& color)
{
  this->Internal->SetColor(color);
  cairo_rectangle(this->Internal->Context, area.Left, area.Top, area.Width, area.Height);
  this->Internal->Stroke(1.0);
}

void Canvas::DrawLines(vtkPolyData* data, const Color& color, double width)
{
  this->Internal->SetColor(color);
  ForEachCell(data->GetLines(), [&](vtkIdType, vtkIdType count, const vtkIdType* points) {
    this->Internal->AddPath(data, count, points, false);
  });
  this->Internal->Stroke(width);
}

void Canvas::DrawEdges(vtkPolyData* mesh, const Color& color, double width)
{
  // Each edge once: twice would look darker where it is not opaque.
  std::vector<std::array<vtkIdType, 2>> edges;
  ForEachCell(mesh->GetPolys(), [&](vtkIdType, vtkIdType count, const vtkIdType* points) {
    for (vtkIdType k = 0; k < count; ++k)
    {
      const vtkIdType next = points[(k + 1) % count];
      edges.push_back({ std::min(points[k], next), std::max(points[k], next) });
    }
  });
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  this->Internal->SetColor(color);
  for (const auto& edge : edges)
  {
    this->Internal->AddPath(mesh, 2, edge.data(), false);
  }
  this->Internal->Stroke(width);
}

void Canvas::FillCells(
  vtkPolyData* mesh, const std::function<bool(vtkIdType cell)>& isShown, const Color& color)
{
  this->Internal->SetColor(color);
  const vtkIdType first = FirstPolygon(mesh);
  ForEachCell(mesh->GetPolys(), [&](vtkIdType cell, vtkIdType count, const vtkIdType* points) {
    if (isShown(first + cell))
    {
      this->Internal->AddPath(mesh, count, points, true);
      cairo_fill(this->Internal->Context);
    }
  });
}

void Canvas::DrawDot(double x, double y, double radius, const Color& color)
{
  cairo_t* context = this->Internal->Context;
  cairo_user_to_device(context, &x, &y);
  cairo_save(context);
  cairo_identity_matrix(context);
  cairo_arc(context, x, y, radius, 0.0, 2.0 * std::acos(-1.0));
  this->Internal->SetColor(color);
  cairo_fill(context);
  cairo_restore(context);
}

void Canvas::DrawImage(vtkImageData* image)
{
  vtkDataArray* pixels = image->GetPointData()->GetScalars();
  const int* size = image->GetDimensions();
  if (!pixels || size[0] < 1 || size[1] < 1)
  {
    return;
  }
  const int components = pixels->GetNumberOfComponents();
  const bool hasAlpha = components == 2 || components == 4;
  const double brightest = Brightest(pixels);
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, size[0], size[1]);
  cairo_surface_flush(surface);
  unsigned char* rows = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  for (int y = 0; y < size[1]; ++y)
  {
    auto* row = reinterpret_cast<std::uint32_t*>(
      rows + static_cast<std::ptrdiff_t>(stride) * (size[1] - 1 - y));
    for (int x = 0; x < size[0]; ++x)
    {
      const vtkIdType pixel = static_cast<vtkIdType>(y) * size[0] + x;
      const auto value = [&](int component) {
        return std::clamp(pixels->GetComponent(pixel, component) / brightest, 0.0, 1.0);
      };
      const double alpha = hasAlpha ? value(components - 1) : 1.0;
      std::uint32_t packed = static_cast<std::uint32_t>(std::lround(255.0 * alpha));
      for (int k = 0; k < 3; ++k)
      {
        packed = packed << 8 |
          static_cast<std::uint32_t>(std::lround(255.0 * alpha * value(components >= 3 ? k : 0)));
      }
      row[x] = packed;
    }
  }
  cairo_surface_mark_dirty(surface);
  double bounds[6];
  image->GetBounds(bounds);
  const double* spacing = image->GetSpacing();
  cairo_t* context = this->Internal->Context;
  cairo_save(context);
  // A pixel is a square around its point; rows run downwards in the surface.
  cairo_translate(context, bounds[0] - 0.5 * spacing[0], bounds[3] + 0.5 * spacing[1]);
  cairo_scale(context, spacing[0], -spacing[1]);
  cairo_set_source_surface(context, surface, 0.0, 0.0);
  cairo_paint(context);
  cairo_restore(context);
  cairo_surface_destroy(surface);
}

void Canvas::Write(const std::string& text, double x, double y, double size, bool centered)
{
  cairo_t* context = this->Internal->Context;
  cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, size);
  cairo_text_extents_t extents;
  cairo_text_extents(context, text.c_str(), &extents);
  this->Internal->SetColor({ 0.13, 0.14, 0.17, 1.0 });
  cairo_move_to(context, centered ? x - 0.5 * extents.x_advance : x, y);
  cairo_show_text(context, text.c_str());
}

void Canvas::Finish()
{
  cairo_surface_t* surface = this->Internal->Surface;
  cairo_status_t status = cairo_status(this->Internal->Context);
  if (status == CAIRO_STATUS_SUCCESS && this->Internal->File.GetFormat() == "png")
  {
    status = cairo_surface_write_to_png_stream(surface, &Internals::Keep, this->Internal.get());
  }
  cairo_surface_finish(surface);
  if (status == CAIRO_STATUS_SUCCESS)
  {
    status = cairo_surface_status(surface);
  }
  if (status != CAIRO_STATUS_SUCCESS)
  {
    throw Failure(FILE_TROUBLE,
      "Cannot write " + this->Internal->File.GetName() + ": " + cairo_status_to_string(status) +
        ".");
  }
  this->Internal->File.Write(this->Internal->Bytes);
}

} // namespace dhm
