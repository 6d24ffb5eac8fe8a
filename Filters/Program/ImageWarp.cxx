// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "ImageWarp.h"

#include "Command.h"
#include "Console.h"
#include "DataFile.h"
#include "Failure.h"
#include "Numbers.h"
#include "OutputFile.h"

#include "vtkDataArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkResampleThroughHomeomorphism.h"

#include <algorithm>
#include <cmath>
#include <type_traits>

namespace dhm
{
namespace
{

template <typename Value>
Value ToValue(double value)
{
  return static_cast<Value>(std::is_floating_point<Value>::value ? value : std::round(value));
}

template <typename Value>
void FillPixels(const Value* from, const unsigned char* mask, vtkIdType count, int components,
  int colors, bool hasAlpha, const Background& background, double brightest, Value* to,
  int newComponents)
{
  const auto opaque = ToValue<Value>(brightest);
  for (vtkIdType i = 0; i < count; ++i, from += components, to += newComponents)
  {
    const bool inside = mask[i] != 0;
    for (int k = 0; k < newComponents; ++k)
    {
      const bool isAlpha = k == colors;
      if (inside)
      {
        to[k] = isAlpha && !hasAlpha ? opaque : from[k];
      }
      else if (!background)
      {
        to[k] = Value(0);
      }
      else if (isAlpha)
      {
        to[k] = opaque;
      }
      else
      {
        const auto& color = *background;
        const double gray = (color[0] + color[1] + color[2]) / 3.0;
        to[k] =
          ToValue<Value>(brightest * (colors == 3 ? color[static_cast<std::size_t>(k)] : gray));
      }
    }
  }
}

template <typename Value>
void BlendPixels(const Value* first, const Value* second, vtkIdType count, double t, Value* result)
{
  for (vtkIdType i = 0; i < count; ++i)
  {
    result[i] = ToValue<Value>(
      (1.0 - t) * static_cast<double>(first[i]) + t * static_cast<double>(second[i]));
  }
}

/// "x from 0 to 3, y from 0 to 2".
std::string DescribeBox(const double* bounds)
{
  return "x from " + ToText(bounds[0]) + " to " + ToText(bounds[1]) + ", y from " +
    ToText(bounds[2]) + " to " + ToText(bounds[3]);
}

/// The pixels of a warped image.
vtkDataArray* PixelsOf(vtkImageData* warped)
{
  vtkDataArray* pixels = warped->GetPointData()->GetScalars();
  if (!pixels)
  {
    throw Failure(FILE_TROUBLE, "The image has no pixels.");
  }
  return pixels;
}

vtkSmartPointer<vtkImageData> LikeWithout(vtkImageData* image)
{
  auto result = vtkSmartPointer<vtkImageData>::New();
  result->CopyStructure(image);
  return result;
}

} // namespace

double Brightest(vtkDataArray* pixels)
{
  const int type = pixels->GetDataType();
  return type == VTK_FLOAT || type == VTK_DOUBLE ? 1.0 : pixels->GetDataTypeMax();
}

Background ReadBackground(const std::string& text)
{
  if (text == "transparent")
  {
    return {};
  }
  if (text == "white" || text == "black")
  {
    const double value = text == "white" ? 1.0 : 0.0;
    return std::array<double, 3>{ value, value, value };
  }
  std::array<double, 3> color{};
  bool valid = text.size() == 7 && text[0] == '#';
  for (std::size_t k = 0; valid && k < 3; ++k)
  {
    unsigned int value = 0;
    const char* begin = text.data() + 1 + 2 * k;
    const auto result = std::from_chars(begin, begin + 2, value, 16);
    valid = result.ec == std::errc() && result.ptr == begin + 2;
    color[k] = value / 255.0;
  }
  if (!valid)
  {
    throw Failure(WRONG_USAGE,
      "\"" + text +
        "\" is no color: transparent, white, black, or #rrggbb, such as #ff8000 for orange.");
  }
  return color;
}

Background ReadBackgroundFor(const std::string& format, const std::string& text)
{
  if (!IsPicture(format) && format != "vti")
  {
    throw Failure(WRONG_USAGE,
      CannotWrite("an image", format) + ": .png, .jpg, .tif, .ppm and .vti are images.");
  }
  const bool opaque = format[0] == 'j' || (format[0] == 'p' && format != "png");
  const Background background = ReadBackground(!text.empty() ? text
      : opaque                                               ? "white"
                                                             : "transparent");
  if (!background && opaque)
  {
    throw Failure(WRONG_USAGE,
      "A ." + format +
        " picture cannot be transparent: give it another --background, or write a .png.");
  }
  return background;
}

std::array<int, 2> ReadSize(const std::string& text)
{
  constexpr int largest = 100000;
  if (text.empty())
  {
    return { 0, 0 };
  }
  const std::size_t x = text.find('x');
  if (x != std::string::npos)
  {
    const auto width = ToNumber<int>(text.substr(0, x));
    const auto height = ToNumber<int>(text.substr(x + 1));
    if (width && height && *width >= 1 && *height >= 1 && *width <= largest && *height <= largest)
    {
      return { *width, *height };
    }
  }
  throw Failure(WRONG_USAGE,
    "\"" + text + "\" is no size: WIDTHxHEIGHT in pixels, each from 1 to " +
      std::to_string(largest) + ", such as 640x480.");
}

vtkSmartPointer<vtkImageData> MakeGrid(vtkImageData* image, const std::array<int, 2>& size)
{
  vtkSmartPointer<vtkImageData> grid = LikeWithout(image);
  if (size[0] > 0)
  {
    grid->SetExtent(0, size[0] - 1, 0, size[1] - 1, 0, 0);
  }
  return grid;
}

void RequireOverlap(
  vtkImageData* image, const std::string& imageName, vtkPolyData* mesh, const std::string& meshName)
{
  double pixels[6];
  double domain[6];
  image->GetBounds(pixels);
  mesh->GetBounds(domain);
  double covered = 1.0;
  for (int axis = 0; axis < 2; ++axis)
  {
    // A pixel is as wide as the distance to the next.
    const double half = 0.5 * image->GetSpacing()[axis];
    const double low = pixels[2 * axis] - half;
    const double high = pixels[2 * axis + 1] + half;
    const double common = std::min(high, domain[2 * axis + 1]) - std::max(low, domain[2 * axis]);
    covered *= std::max(common, 0.0) / (high - low);
  }
  const std::string boxes =
    imageName + " (" + DescribeBox(pixels) + ") and " + meshName + " (" + DescribeBox(domain) + ")";
  if (covered == 0.0)
  {
    throw Failure(REFUSED,
      boxes +
        " do not overlap: meshes must be in the image's coordinates (a picture's are its pixels, y "
        "upwards).");
  }
  if (covered < 0.01)
  {
    Warn(boxes +
      " overlap in less than a hundredth of the image: meshes must be in its coordinates (a "
      "picture's are its pixels, y upwards).");
  }
}

vtkSmartPointer<vtkImageData> WarpImage(vtkImageData* image, vtkPolyData* source,
  vtkPolyData* target, vtkImageData* grid, bool inverse, const MapOptions& map,
  const std::string& what)
{
  // Pixels without a name would not be found again.
  const auto named = vtkSmartPointer<vtkImageData>::New();
  named->ShallowCopy(image);
  if (!PixelsOf(named)->GetName())
  {
    PixelsOf(named)->SetName("Pixels");
  }
  const std::string name = PixelsOf(named)->GetName();

  vtkNew<vtkResampleThroughHomeomorphism> resample;
  map.ApplyTo(resample.Get());
  resample->SetSourceData(source);
  resample->SetTargetData(target);
  resample->SetDataObject(named);
  resample->SetGridData(grid);
  resample->SetInverse(inverse);
  resample->BlankOutsideOff();
  Run(resample, what);
  vtkSmartPointer<vtkImageData> result =
    vtkImageData::SafeDownCast(resample->GetOutputDataObject(0));
  result->GetPointData()->SetActiveScalars(name.c_str());
  return result;
}

vtkSmartPointer<vtkImageData> Blend(vtkImageData* first, vtkImageData* second, double t)
{
  vtkDataArray* a = PixelsOf(first);
  vtkDataArray* b = PixelsOf(second);
  if (a->GetDataType() != b->GetDataType() ||
    a->GetNumberOfComponents() != b->GetNumberOfComponents() ||
    a->GetNumberOfTuples() != b->GetNumberOfTuples())
  {
    throw Failure(REFUSED,
      "The two images are not of the same kind: " + std::to_string(a->GetNumberOfComponents()) +
        " components of " + a->GetDataTypeAsString() + ", and " +
        std::to_string(b->GetNumberOfComponents()) + " of " + b->GetDataTypeAsString() + ".");
  }
  const auto pixels = vtk::TakeSmartPointer(a->NewInstance());
  pixels->SetName(a->GetName());
  pixels->SetNumberOfComponents(a->GetNumberOfComponents());
  pixels->SetNumberOfTuples(a->GetNumberOfTuples());
  switch (a->GetDataType())
  {
    vtkTemplateMacro(BlendPixels(static_cast<const VTK_TT*>(a->GetVoidPointer(0)),
      static_cast<const VTK_TT*>(b->GetVoidPointer(0)), a->GetNumberOfValues(), t,
      static_cast<VTK_TT*>(pixels->GetVoidPointer(0))));
  }
  vtkSmartPointer<vtkImageData> result = LikeWithout(first);
  result->GetPointData()->SetScalars(pixels);
  result->GetPointData()->AddArray(first->GetPointData()->GetArray("vtkValidPointMask"));
  return result;
}

vtkSmartPointer<vtkImageData> Finish(vtkImageData* warped, const Background& background)
{
  vtkDataArray* from = PixelsOf(warped);
  vtkDataArray* mask = warped->GetPointData()->GetArray("vtkValidPointMask");
  const int components = from->GetNumberOfComponents();
  const bool hasAlpha = components == 2 || components == 4;
  const int colors = components - (hasAlpha ? 1 : 0);
  const bool isPicture = components <= 4;
  const int newComponents = components + (!background && !hasAlpha && isPicture ? 1 : 0);
  const auto pixels = vtk::TakeSmartPointer(from->NewInstance());
  pixels->SetName(from->GetName());
  pixels->SetNumberOfComponents(newComponents);
  pixels->SetNumberOfTuples(from->GetNumberOfTuples());
  switch (from->GetDataType())
  {
    vtkTemplateMacro(FillPixels(static_cast<const VTK_TT*>(from->GetVoidPointer(0)),
      static_cast<const unsigned char*>(mask->GetVoidPointer(0)), from->GetNumberOfTuples(),
      components, colors, hasAlpha, background, Brightest(from),
      static_cast<VTK_TT*>(pixels->GetVoidPointer(0)), newComponents));
  }
  vtkSmartPointer<vtkImageData> result = LikeWithout(warped);
  result->GetPointData()->SetScalars(pixels);
  return result;
}

} // namespace dhm
