// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// A table of defective inputs, and of inputs that only look defective: the message and the output
// of each. Documentation/diagnostics.md describes them.

#include "FilterRuns.h"

#include "Pipeline/DiagnosticMessages.h"

#include "vtkAlgorithmOutput.h"
#include "vtkCellData.h"
#include "vtkDataSetAttributes.h"
#include "vtkHomeomorphismTransform.h"
#include "vtkIdTypeArray.h"
#include "vtkImageData.h"
#include "vtkJacobianContinuity.h"
#include "vtkMultiBlockDataSet.h"
#include "vtkResampleThroughHomeomorphism.h"
#include "vtkTable.h"
#include "vtkTransform.h"
#include "vtkTriangularCoordinates.h"
#include "vtkTypeInt32Array.h"
#include "vtkTypeInt64Array.h"
#include "vtkXMLImageDataWriter.h"
#include "vtkXMLPolyDataReader.h"
#include "vtkXMLPolyDataWriter.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <iterator>
#include <regex>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace
{

using namespace filter_runs;

constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();
constexpr double Infinity = std::numeric_limits<double>::infinity();

/// What happened: the messages, without file names, line numbers and addresses, and whether what
/// came out is as it should be.
struct Outcome
{
  std::string Message;
  bool AsItShouldBe = true;
};

/// Collects every error and warning, one after the other.
class Listener
{
public:
  void ListenTo(vtkObject* object)
  {
    object->AddObserver(vtkCommand::ErrorEvent, this, &Listener::Hear);
    object->AddObserver(vtkCommand::WarningEvent, this, &Listener::Hear);
  }
  void ListenTo(vtkAlgorithm* algorithm)
  {
    this->ListenTo(static_cast<vtkObject*>(algorithm));
    this->ListenTo(algorithm->GetExecutive());
  }
  const std::string& GetText() const { return this->Text; }
  void Clear() { this->Text.clear(); }

private:
  void Hear(vtkObject*, unsigned long, void* text)
  {
    std::string message = static_cast<const char*>(text);
    // What an executive adds to an error of its algorithm.
    if (message.find("returned failure for request") != std::string::npos)
    {
      return;
    }
    // "ERROR: In file, line n", then "class (address): ", then what matters.
    const std::size_t start = message.find("): ");
    message = start == std::string::npos ? message : message.substr(start + 3);
    message = std::regex_replace(message, std::regex("\\(?0x[0-9a-f]+\\)?"), "");
    message = std::regex_replace(message, std::regex("[^!-~]+"), " ");
    while (!message.empty() && message.back() == ' ')
    {
      message.pop_back();
    }
    this->Text += (this->Text.empty() ? "" : " ") + message;
  }

  std::string Text;
};

struct BadInput
{
  const char* Group;
  const char* Kind;
  /// What must be said; an empty list: nothing must be said.
  std::vector<std::string> Said;
  /// What becomes of it, or what a user should do.
  const char* Consequence;
  std::function<Outcome()> Provoke;
};

MeshPair GoodPair()
{
  return MakePlanarPair(4, 11);
}

/// Runs the filter with this pair; a refused pair has no output.
Outcome Run(const MeshPair& pair, bool taken, const System& system = Smooth, bool mask = false)
{
  vtkNew<vtkDifferentiableHomeomorphism> filter;
  Listener listener;
  listener.ListenTo(filter);
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  filter->SetDataObject(MakeCloud({ { 0.3, 0.2, 0.0 }, { 1.4, 2.6, 0.0 }, { 50.0, 0.0, 0.0 } }));
  filter->SetCoordinateSystem(system.CoordinateSystem);
  filter->SetMaskInvalidTriangles(mask);
  filter->Update();
  vtkPointSet* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  Outcome outcome{ listener.GetText() };
  if (!taken)
  {
    outcome.AsItShouldBe = output->GetNumberOfPoints() == 0 && filter->GetErrorCode() != 0 &&
      filter->GetNumberOfOutsidePoints() == -1;
    return outcome;
  }
  vtkDataArray* mask0 = PointArray(output, "vtkValidPointMask");
  outcome.AsItShouldBe = output->GetNumberOfPoints() == 3 && filter->GetErrorCode() == 0 && mask0 &&
    mask0->GetComponent(2, 0) == 0.0 && SameBits(PointOf(output, 2)[0], 50.0);
  for (vtkIdType i = 0; i < output->GetNumberOfPoints(); ++i)
  {
    const Point p = PointOf(output, i);
    outcome.AsItShouldBe = outcome.AsItShouldBe && std::isfinite(p[0]) && std::isfinite(p[1]);
  }
  return outcome;
}

/// The same with one mesh of a good pair spoilt, or both.
enum class Which
{
  Source,
  Target,
  Both
};
std::function<Outcome()> Spoilt(Which which, const std::function<void(vtkPolyData*)>& spoil,
  bool taken = false, const System& system = Smooth, bool mask = false)
{
  return [=]() {
    const MeshPair pair = GoodPair();
    if (which != Which::Target)
    {
      spoil(pair.Source);
    }
    if (which != Which::Source)
    {
      spoil(pair.Target);
    }
    return Run(pair, taken, system, mask);
  };
}

void MovePoint(vtkPolyData* mesh, vtkIdType id, const Point& surfacePoint)
{
  mesh->GetPoints()->SetPoint(id, surfacePoint.data());
}

void SetTriangles(vtkPolyData* mesh, const std::vector<Triangle>& triangles)
{
  vtkNew<vtkCellArray> cells;
  for (const Triangle& triangle : triangles)
  {
    cells->InsertNextCell(3, triangle.data());
  }
  mesh->SetPolys(cells);
}

void AddTriangle(vtkPolyData* mesh, const Triangle& triangle)
{
  vtkNew<vtkCellArray> cells;
  cells->DeepCopy(mesh->GetPolys());
  cells->InsertNextCell(3, triangle.data());
  mesh->SetPolys(cells);
}

std::string TemporaryFile(const char* name)
{
  return testing::TempDir() + "bad_input_" + name;
}

void WriteFile(const std::string& name, const std::string& content)
{
  std::ofstream(name, std::ios::binary) << content;
}

/// Reads the source from a file; the filter must give nothing.
Outcome RunWithFile(const std::string& name)
{
  vtkNew<vtkXMLPolyDataReader> reader;
  vtkNew<vtkDifferentiableHomeomorphism> filter;
  Listener listener;
  listener.ListenTo(static_cast<vtkObject*>(reader.Get()));
  reader->SetFileName(name.c_str());
  filter->SetSourceConnection(reader->GetOutputPort());
  filter->SetTargetData(GoodPair().Target);
  Listener ours;
  ours.ListenTo(filter);
  filter->Update();
  std::string text = listener.GetText() + (ours.GetText().empty() ? "" : " ") + ours.GetText();
  const std::size_t path = text.find(name);
  if (path != std::string::npos)
  {
    text.replace(path, name.size(), "(the file)");
  }
  Outcome outcome{ text };
  outcome.AsItShouldBe =
    vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0))->GetNumberOfPoints() == 0;
  std::remove(name.c_str());
  return outcome;
}

std::string GoodFile()
{
  const std::string name = TemporaryFile("good.vtp");
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetFileName(name.c_str());
  writer->SetDataModeToBinary();
  writer->SetInputData(GoodPair().Source);
  writer->Write();
  std::ifstream file(name, std::ios::binary);
  const std::string content{ std::istreambuf_iterator<char>(file),
    std::istreambuf_iterator<char>() };
  std::remove(name.c_str());
  return content;
}

/// A pair on which the transform is asked; what an outside point's image is.
Outcome AskTransform(vtkHomeomorphismTransform* transform, bool taken)
{
  Listener listener;
  listener.ListenTo(static_cast<vtkObject*>(transform));
  const Point probe{ 0.5, 0.4, 0.0 };
  Point image;
  transform->TransformPoint(probe.data(), image.data());
  const bool inside = transform->IsInside(probe.data());
  Outcome outcome{ listener.GetText() };
  outcome.AsItShouldBe = inside == taken && (taken || image[0] >= 1e30);
  return outcome;
}

Outcome AskFilterWithoutInput(int missingPort)
{
  const MeshPair pair = GoodPair();
  vtkNew<vtkDifferentiableHomeomorphism> filter;
  Listener listener;
  listener.ListenTo(filter);
  if (missingPort != 0)
  {
    filter->SetSourceData(pair.Source);
  }
  if (missingPort != 1)
  {
    filter->SetTargetData(pair.Target);
  }
  filter->Update();
  auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  return { listener.GetText(), !output || output->GetNumberOfPoints() == 0 };
}

Outcome RunWithData(
  vtkDataObject* data, const std::function<bool(vtkPointSet*)>& isRight, vtkIdType outside)
{
  const MeshPair pair = GoodPair();
  vtkNew<vtkDifferentiableHomeomorphism> filter;
  Listener listener;
  listener.ListenTo(filter);
  filter->SetSourceData(pair.Source);
  filter->SetTargetData(pair.Target);
  filter->SetDataObject(data);
  filter->Update();
  auto* output = vtkPointSet::SafeDownCast(filter->GetOutputDataObject(0));
  return { listener.GetText(), isRight(output) && filter->GetNumberOfOutsidePoints() == outside };
}

/// A strip of @a count quadrilaterals, closed into a ring, with half a turn or without.
vtkSmartPointer<vtkPolyData> Ring(int count, bool twisted, double radius)
{
  std::vector<Point> points;
  std::vector<Triangle> triangles;
  for (vtkIdType i = 0; i < count; ++i)
  {
    const double angle = 6.283185307179586 * static_cast<double>(i) / count;
    const double turn = twisted ? 0.5 * angle : 0.0;
    for (const double side : { -0.4, 0.4 })
    {
      const double r = radius + side * std::cos(turn);
      points.push_back({ r * std::cos(angle), r * std::sin(angle), side * std::sin(turn) });
    }
    const vtkIdType a = 2 * i;
    const vtkIdType b = a + 1;
    const bool last = i + 1 == count;
    const vtkIdType c = last ? (twisted ? 1 : 0) : a + 2;
    const vtkIdType d = last ? (twisted ? 0 : 1) : a + 3;
    triangles.push_back({ a, c, b });
    triangles.push_back({ b, c, d });
  }
  return MakeMesh(points, triangles);
}

std::vector<BadInput> Table()
{
  const char* const files = "Files";
  const char* const pairs = "Two meshes that are not the same";
  const char* const cells = "Cells";
  const char* const points = "Points and triangles";
  const char* const surfaces = "Triangles among each other";
  const char* const harmless = "Looks wrong and is taken";
  const char* const dataToMap = "Data to be mapped";
  const char* const use = "Use of the classes";
  const std::string repair =
    "Repair or remove them in both meshes, or turn MaskInvalidTriangles on";
  const std::string sameMesh =
    "Source and target must be the same mesh with different point coordinates.";

  const auto quads = [](vtkPolyData* mesh) {
    vtkNew<vtkCellArray> polygons;
    polygons->InsertNextCell({ 0, 1, 6, 5 });
    polygons->InsertNextCell({ 1, 2, 7 });
    mesh->SetPolys(polygons);
  };
  const auto strips = [](vtkPolyData* mesh) {
    vtkNew<vtkCellArray> strip;
    strip->InsertNextCell({ 0, 1, 5, 6, 10, 11 });
    mesh->SetStrips(strip);
  };
  const auto badId = [](vtkIdType id) {
    return [id](vtkPolyData* mesh) { AddTriangle(mesh, { 0, 1, id }); };
  };
  const auto coordinate = [](double x) {
    return [x](vtkPolyData* mesh) { MovePoint(mesh, 12, { x, 2.0, 0.0 }); };
  };
  const auto collapse = [](vtkPolyData* mesh) { MovePoint(mesh, 12, PointOf(mesh, 13)); };
  const auto foldOver = [](vtkPolyData* mesh) { MovePoint(mesh, 12, { 3.6, 2.2, 0.0 }); };
  const auto ghosts = [](vtkPolyData* mesh, bool ofCells, vtkIdType tuples) {
    vtkNew<vtkUnsignedCharArray> array;
    array->SetName(vtkDataSetAttributes::GhostArrayName());
    array->SetNumberOfTuples(tuples);
    array->FillValue(0);
    if (tuples > 20)
    {
      const int hidden = ofCells ? static_cast<int>(vtkDataSetAttributes::HIDDENCELL)
                                 : static_cast<int>(vtkDataSetAttributes::HIDDENPOINT);
      array->SetValue(20, static_cast<unsigned char>(hidden));
    }
    (ofCells ? static_cast<vtkDataSetAttributes*>(mesh->GetCellData()) : mesh->GetPointData())
      ->AddArray(array);
  };

  std::vector<BadInput> rows;
  const auto add = [&](const char* group, const char* kind, std::vector<std::string> said,
                     const char* consequence, std::function<Outcome()> provoke) {
    rows.push_back({ group, kind, std::move(said), consequence, std::move(provoke) });
  };

  // --- Files
  add(files, "A mesh's file does not exist", { "Error opening file", "(the file)" },
    "The reader tells; nothing comes out. Give the right name.",
    []() { return RunWithFile(TemporaryFile("missing.vtp")); });
  add(files, "A mesh's file is cut off", { "Error parsing" },
    "The reader tells; nothing comes out. Write or copy the file again.", []() {
      const std::string name = TemporaryFile("truncated.vtp");
      const std::string content = GoodFile();
      WriteFile(name, content.substr(0, content.size() / 2));
      return RunWithFile(name);
    });
  add(files, "A mesh's file is of another type (an image)",
    { "Cannot find PolyData element in file." },
    "The reader tells; nothing comes out. Use the file's own reader.", []() {
      const std::string name = TemporaryFile("image.vti");
      vtkNew<vtkImageData> image;
      image->SetDimensions(2, 2, 1);
      vtkNew<vtkXMLImageDataWriter> writer;
      writer->SetFileName(name.c_str());
      writer->SetDataModeToBinary();
      writer->SetInputData(image);
      writer->Write();
      return RunWithFile(name);
    });
  add(files, "A mesh's file is empty", { "Error parsing" },
    "The reader tells; nothing comes out. Write or copy the file again.", []() {
      const std::string name = TemporaryFile("empty.vtp");
      WriteFile(name, "");
      return RunWithFile(name);
    });

  // --- Two meshes that are not the same
  add(pairs, "Numbers of points differ", { "25", "26", sameMesh }, "Refused.",
    Spoilt(Which::Target, [](vtkPolyData* mesh) { mesh->GetPoints()->InsertNextPoint(9, 9, 0); }));
  add(pairs, "Numbers of triangles differ", { "32", "33", sameMesh }, "Refused.",
    Spoilt(Which::Target, [](vtkPolyData* mesh) {
      AddTriangle(mesh, { 0, 1, 6 });
    }));
  add(pairs, "Triangles have other points",
    { "2 triangles of the pair (cells 0, 1)",
      "have different points in the source and in the target",
      "Give the target the source's cells, with its own point coordinates in the same order." },
    "Refused.", Spoilt(Which::Target, [](vtkPolyData* mesh) {
      std::vector<Triangle> triangles = GridTriangles(4);
      std::swap(triangles[0], triangles[1]);
      SetTriangles(mesh, triangles);
    }));
  add(pairs, "The target's points are in another order",
    { "4 triangles of the pair (cells 10, 11, 20, 21)",
      "are flipped between source and target relative to the rest" },
    "Refused: triangles turn over or overlap. Give both meshes their points in the same order.",
    Spoilt(Which::Target, [](vtkPolyData* mesh) {
      // As if one exporter went by columns and the other by rows, from the middle on.
      const Point first = PointOf(mesh, 6);
      const Point second = PointOf(mesh, 18);
      MovePoint(mesh, 6, second);
      MovePoint(mesh, 18, first);
    }));

  // --- Cells
  add(cells, "Quadrilaterals",
    { "is not a triangle", "Triangulate the source (vtkTriangleFilter)" }, "Refused.",
    Spoilt(Which::Both, quads));
  add(cells, "Triangle strips",
    { "of the source (cell 32) is a triangle strip", "vtkTriangleFilter" }, "Refused.",
    Spoilt(Which::Both, strips));
  add(cells, "A polygon with two corners", { "is not a triangle" }, "Refused.",
    Spoilt(Which::Both, [](vtkPolyData* mesh) {
      vtkNew<vtkCellArray> polygons;
      polygons->InsertNextCell({ 0, 1 });
      mesh->SetPolys(polygons);
    }));
  add(cells, "A point id beyond the last point",
    { "1 triangle of the source (cell 32) refers to points that do not exist",
      "The mesh is corrupt: read or make it again." },
    "Refused.", Spoilt(Which::Both, badId(25)));
  add(cells, "A negative point id", { "refers to points that do not exist" }, "Refused.",
    Spoilt(Which::Both, badId(-1)));
  add(cells, "Triangles without any points",
    { "32 triangles of the source", "refer to points that do not exist" }, "Refused.",
    Spoilt(Which::Both, [](vtkPolyData* mesh) { mesh->SetPoints(nullptr); }));
  add(cells, "Offsets of cells that do not fit their points", { "cell" }, "Refused.",
    Spoilt(Which::Both, [](vtkPolyData* mesh) {
      vtkNew<vtkTypeInt64Array> offsets;
      vtkNew<vtkTypeInt64Array> connectivity;
      for (const int offset : { 0, 3, 9 })
      {
        offsets->InsertNextValue(offset);
      }
      for (const int id : { 0, 1, 6, 0, 6, 5 })
      {
        connectivity->InsertNextValue(id);
      }
      vtkNew<vtkCellArray> polygons;
      polygons->SetData(offsets, connectivity);
      mesh->SetPolys(polygons);
    }));

  // --- Points and triangles
  add(points, "A triangle uses a point twice",
    { "1 triangle of the source (cell 32) uses the same point twice", repair }, "Refused.",
    Spoilt(Which::Both, [](vtkPolyData* mesh) {
      AddTriangle(mesh, { 3, 3, 4 });
    }));
  add(points, "A coordinate is NaN",
    { "6 triangles of the source (cells ", "have coordinates that are not finite", repair },
    "Refused.", Spoilt(Which::Source, coordinate(NotANumber)));
  add(points, "A coordinate is infinite",
    { "6 triangles of the target (cells ", "have coordinates that are not finite", repair },
    "Refused.", Spoilt(Which::Target, coordinate(-Infinity)));
  add(points, "No coordinate is finite", { "32 triangles of the source", "not finite" }, "Refused.",
    Spoilt(Which::Source, [](vtkPolyData* mesh) {
      for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
      {
        MovePoint(mesh, i, { NotANumber, NotANumber, NotANumber });
      }
    }));
  add(points, "Triangles without area: two points coincide",
    { "2 triangles of the source (cells ", "are degenerate", repair }, "Refused.",
    Spoilt(Which::Source, collapse));
  add(points, "All points are on a line", { "32 triangles of the target", "are degenerate" },
    "Refused.", Spoilt(Which::Target, [](vtkPolyData* mesh) {
      for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
      {
        MovePoint(mesh, i, { static_cast<double>(i), 0.0, 0.0 });
      }
    }));
  add(points, "A triangle is turned over in one of the meshes",
    { "flipped between source and target relative to the rest",
      "Move their points so that all triangles keep their orientation (or all are mirrored)" },
    "Refused.", Spoilt(Which::Target, foldOver));
  add(points, "The same, with MaskInvalidTriangles", { "masked (MaskInvalidTriangles)" },
    "A warning; the rest is mapped.", Spoilt(Which::Target, foldOver, true, Smooth, true));
  add(points, "Discordant triangles in the Contour system",
    { "discordant", "Use the Smooth system, which takes any triangle", "DiscordantTriangles" },
    "Refused, unless the Linear system may map them.",
    Spoilt(
      Which::Target,
      [](vtkPolyData* mesh) {
        for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
        {
          const Point p = PointOf(mesh, i);
          MovePoint(mesh, i, { p[0] + 2.0 * p[1], p[1], 0.0 });
        }
      },
      false, Contour));

  // --- Triangles among each other
  add(surfaces, "Triangles overlap in both meshes", { "overlap other triangles", repair },
    "Refused.", Spoilt(Which::Both, [](vtkPolyData* mesh) {
      for (const Point& p : { Point{ 0.2, 0.2, 0.0 }, { 1.2, 0.2, 0.0 }, { 0.2, 1.2, 0.0 } })
      {
        mesh->GetPoints()->InsertNextPoint(p.data());
      }
      AddTriangle(mesh, { 25, 26, 27 });
    }));
  add(surfaces, "The same triangle twice", { "of the source (cells ", "are at non-manifold edges" },
    "Refused.", Spoilt(Which::Both, [](vtkPolyData* mesh) {
      AddTriangle(mesh, { 6, 7, 12 });
    }));
  add(surfaces, "An edge with three triangles", { "are at non-manifold edges", repair }, "Refused.",
    []() {
      const auto fins = [](double height) {
        return MakeMesh(
          { { 0, 0, 0 }, { 1, 0, 0 }, { 0.5, 1, 0 }, { 0.5, -1, 0 }, { 0.5, 0, height } },
          { { 0, 1, 2 }, { 1, 0, 3 }, { 0, 1, 4 } });
      };
      return Run({ fins(1.0), fins(2.0) }, false);
    });
  add(surfaces, "A Moebius strip",
    { "cannot be wound consistently", "the surface is non-orientable", "Cut the surface open" },
    "Refused.", []() {
      return Run({ Ring(12, true, 2.0), Ring(12, true, 3.0) }, false);
    });

  // --- Looks wrong and is taken
  add(harmless, "64-bit ids, and 32-bit ones in the other mesh", {}, "Taken.",
    Spoilt(
      Which::Target, [](vtkPolyData* mesh) { mesh->GetPolys()->ConvertTo32BitStorage(); }, true));
  add(harmless, "Two points at the same place", {},
    "Taken: the ids count. Triangles that meet there without sharing points have a boundary "
    "between "
    "them; use vtkCleanPolyData on both meshes, before they are made different, to join them.",
    Spoilt(
      Which::Both,
      [](vtkPolyData* mesh) {
        // The last triangle gets a corner of its own at the place of point 24.
        std::vector<Triangle> triangles = GridTriangles(4);
        mesh->GetPoints()->InsertNextPoint(PointOf(mesh, 24).data());
        for (vtkIdType& id : triangles.back())
        {
          id = id == 24 ? 25 : id;
        }
        SetTriangles(mesh, triangles);
      },
      true));
  add(harmless, "A point that no triangle uses, even NaN", {},
    "Taken: it is no part of the domain.",
    Spoilt(
      Which::Both, [](vtkPolyData* mesh) { mesh->GetPoints()->InsertNextPoint(NotANumber, 0, 0); },
      true));
  add(harmless, "Triangles wound in different directions", {},
    "Taken: the map does not depend on it.",
    Spoilt(
      Which::Both,
      [](vtkPolyData* mesh) {
        std::vector<Triangle> triangles = GridTriangles(4);
        for (std::size_t i = 0; i < triangles.size(); i += 3)
        {
          std::swap(triangles[i][0], triangles[i][1]);
        }
        SetTriangles(mesh, triangles);
      },
      true));
  add(harmless, "Lines and vertices beside the triangles", {},
    "Taken: they are no part of the domain. Cell ids in messages count them, as VTK does.",
    Spoilt(
      Which::Both,
      [](vtkPolyData* mesh) {
        vtkNew<vtkCellArray> lines;
        lines->InsertNextCell({ 0, 24 });
        mesh->SetLines(lines);
        vtkNew<vtkCellArray> vertices;
        vertices->InsertNextCell({ 3 });
        mesh->SetVerts(vertices);
      },
      true));
  add(harmless, "One triangle only", {}, "Taken.", []() {
    return Run({ MakeMesh({ { 0, 0, 0 }, { 3, 0, 0 }, { 0, 4, 0 } }, { { 0, 1, 2 } }),
                 MakeMesh({ { 1, 0, 0 }, { 3, 0, 0 }, { 0, 2, 0 } }, { { 0, 1, 2 } }) },
      true);
  });
  add(harmless, "Pieces that are not connected", {}, "Taken.",
    Spoilt(
      Which::Both,
      [](vtkPolyData* mesh) {
        for (const Point& p : { Point{ 20.0, 0.0, 0.0 }, { 21.0, 0.0, 0.0 }, { 20.0, 1.0, 0.0 } })
        {
          mesh->GetPoints()->InsertNextPoint(p.data());
        }
        AddTriangle(mesh, { 25, 26, 27 });
      },
      true));
  add(harmless, "Holes", {}, "Taken: a point in a hole is outside.",
    Spoilt(
      Which::Both,
      [](vtkPolyData* mesh) {
        std::vector<Triangle> triangles = GridTriangles(4);
        triangles.erase(triangles.begin() + 10, triangles.begin() + 14);
        SetTriangles(mesh, triangles);
      },
      true));
  add(harmless, "Blanked cells (vtkGhostType)", {}, "Taken: they are holes.",
    Spoilt(
      Which::Source, [ghosts](vtkPolyData* mesh) { ghosts(mesh, true, 32); }, true));
  add(harmless, "Blanked points (vtkGhostType)", {}, "Taken: the cells that use them are holes.",
    Spoilt(
      Which::Target, [ghosts](vtkPolyData* mesh) { ghosts(mesh, false, 25); }, true));
  add(harmless, "A vtkGhostType array of another length", {}, "Taken: it hides nothing.",
    Spoilt(
      Which::Both, [ghosts](vtkPolyData* mesh) { ghosts(mesh, true, 7); }, true));
  add(harmless, "All triangles mirrored in the target", {}, "Taken: the map reverses orientation.",
    Spoilt(
      Which::Target,
      [](vtkPolyData* mesh) {
        for (vtkIdType i = 0; i < mesh->GetNumberOfPoints(); ++i)
        {
          const Point p = PointOf(mesh, i);
          MovePoint(mesh, i, { -p[0], p[1], p[2] });
        }
      },
      true));
  add(harmless, "Meshes without any cell", {}, "Taken: every point is outside.", []() {
    const auto empty = [](vtkPolyData* mesh) {
      mesh->SetPolys(nullptr);
      mesh->SetPoints(nullptr);
    };
    return Spoilt(Which::Both, empty, true)();
  });
  add(harmless, "The same object on both ports", {}, "Taken: the map is the identity.", []() {
    const MeshPair pair = GoodPair();
    Outcome outcome = Run({ pair.Source, pair.Source }, true);
    const auto data = MakeCloud(pair.Source, RandomSamples(pair.Source, 100, 3));
    const auto filter = MakeFilter(Smooth, { pair.Source, pair.Source }, data);
    vtkPointSet* output = Output(filter);
    for (vtkIdType i = 0; i < 100; ++i)
    {
      outcome.AsItShouldBe =
        outcome.AsItShouldBe && Distance(PointOf(output, i), PointOf(data, i)) < 1e-14;
    }
    return outcome;
  });
  add(harmless, "A mesh is changed in place after the first update, and Modified is called", {},
    "Taken: it is read again.", []() {
      const MeshPair pair = GoodPair();
      const auto data = MakeCloud({ { 1.9, 2.1, 0.0 } });
      const auto filter = MakeFilter(Smooth, pair, data);
      const Point before = PointOf(Output(filter), 0);
      Point p = PointOf(pair.Target, 12);
      p[0] += 0.05;
      MovePoint(pair.Target, 12, p);
      pair.Target->GetPoints()->Modified();
      const Point after = PointOf(Output(filter), 0);
      const auto fresh = MakeFilter(Smooth, pair, data);
      return Outcome{ "",
        Distance(before, after) > 0.01 && Distance(after, PointOf(Output(fresh), 0)) == 0.0 };
    });

  // --- Data
  add(dataToMap, "A point that is NaN or infinite", {}, "It is outside, marked and counted.", []() {
    return RunWithData(
      MakeCloud({ { NotANumber, 1.0, 0.0 }, { 1.0, Infinity, 0.0 }, { 1.0, 1.0, 0.0 } }),
      [](vtkPointSet* output) {
        vtkDataArray* mask = PointArray(output, "vtkValidPointMask");
        return mask && mask->GetComponent(0, 0) == 0.0 && mask->GetComponent(1, 0) == 0.0 &&
          mask->GetComponent(2, 0) == 1.0 && std::isnan(PointOf(output, 0)[0]);
      },
      2);
  });
  add(dataToMap, "A vector that is NaN", {}, "It becomes NaN; other vectors do not.", []() {
    const auto cloud = MakeCloud({ { 1.0, 1.0, 0.0 }, { 1.5, 1.2, 0.0 } });
    vtkNew<vtkDoubleArray> vectors;
    vectors->SetName("Velocity");
    vectors->SetNumberOfComponents(3);
    vectors->InsertNextTuple3(NotANumber, 0.0, 0.0);
    vectors->InsertNextTuple3(1.0, 0.0, 0.0);
    cloud->GetPointData()->SetVectors(vectors);
    return RunWithData(
      cloud,
      [](vtkPointSet* output) {
        vtkDataArray* carried = PointArray(output, "Velocity");
        return carried && std::isnan(carried->GetComponent(0, 0)) &&
          std::isfinite(carried->GetComponent(1, 0));
      },
      0);
  });
  add(dataToMap, "An array with another number of tuples than points", {}, "It passes untouched.",
    []() {
      const auto cloud = MakeCloud({ { 1.0, 1.0, 0.0 }, { 1.5, 1.2, 0.0 } });
      const auto vectors = RandomArray("Velocity", 3, 7, 1);
      cloud->GetPointData()->SetVectors(vectors);
      return RunWithData(
        cloud,
        [&](vtkPointSet* output) {
          return CountDifferentValues(PointArray(output, "Velocity"), vectors) == 0;
        },
        0);
    });
  add(dataToMap, "Cells with points that do not exist", {}, "The cells pass untouched.", []() {
    const auto mesh = MakeMesh({ { 1.0, 1.0, 0.0 }, { 1.5, 1.2, 0.0 } }, { { 0, 1, 77 } });
    return RunWithData(
      mesh,
      [](vtkPointSet* output) {
        return output->GetNumberOfPoints() == 2 && output->GetNumberOfCells() == 1;
      },
      0);
  });
  add(dataToMap, "Polygons with fewer than three points, lines with one", {},
    "The cells pass untouched.", []() {
      const auto mesh = MakeMesh({ { 1.0, 1.0, 0.0 }, { 1.5, 1.2, 0.0 }, { 50.0, 0.0, 0.0 } }, {});
      vtkNew<vtkCellArray> polygons;
      polygons->InsertNextCell({ 0, 1 });
      polygons->InsertNextCell({ 2 });
      polygons->InsertNextCell({ 0, 1, 2 });
      mesh->SetPolys(polygons);
      vtkNew<vtkCellArray> lines;
      lines->InsertNextCell({ 1 });
      mesh->SetLines(lines);
      mesh->GetCellData()->SetVectors(RandomArray("Flux", 3, 4, 2));
      return RunWithData(
        mesh,
        [](vtkPointSet* output) {
          vtkDataArray* hidden =
            output->GetCellData()->GetArray(vtkDataSetAttributes::GhostArrayName());
          vtkDataArray* flux = output->GetCellData()->GetArray("Flux");
          return output->GetNumberOfCells() == 4 && hidden && hidden->GetComponent(0, 0) == 0.0 &&
            hidden->GetComponent(2, 0) != 0.0 && flux && std::isfinite(flux->GetComponent(0, 0)) &&
            std::isnan(flux->GetComponent(2, 0));
        },
        1);
    });
  add(dataToMap, "Lines with one point beside the triangles of a mesh that is its own data", {},
    "The cells pass untouched.", []() {
      const MeshPair pair = GoodPair();
      for (vtkPolyData* mesh : { pair.Source.Get(), pair.Target.Get() })
      {
        vtkNew<vtkCellArray> lines;
        lines->InsertNextCell({ 3 });
        mesh->SetLines(lines);
        mesh->GetPoints()->InsertNextPoint(90.0, 0.0, 0.0);
      }
      const auto filter = MakeFilter(Smooth, pair);
      Listener listener;
      listener.ListenTo(filter.Get());
      vtkPointSet* output = Output(filter);
      return Outcome{ listener.GetText(),
        output->GetNumberOfCells() == 33 && filter->GetNumberOfOutsidePoints() == 1 };
    });
  const auto resampled = [](vtkDataObject* probed) {
    const MeshPair pair = GoodPair();
    vtkNew<vtkResampleThroughHomeomorphism> resample;
    Listener listener;
    listener.ListenTo(resample);
    resample->SetInputDataObject(0, pair.Source);
    resample->SetInputDataObject(1, pair.Target);
    resample->SetInputDataObject(2, probed);
    resample->SetSamplingDimensions(5, 5);
    resample->Update();
    auto* output = vtkDataSet::SafeDownCast(resample->GetOutputDataObject(0));
    return Outcome{ listener.GetText(),
      output && output->GetNumberOfPoints() == 0 && resample->GetErrorCode() != 0 };
  };
  add(dataToMap, "Values wanted of data whose cells have points that do not exist",
    { "1 cell of the data (cell 1) has points that do not exist." },
    "vtkResampleThroughHomeomorphism refuses.", [resampled]() {
      return resampled(
        MakeMesh({ { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 } }, { { 0, 1, 2 }, { 0, 1, 9 } }));
    });
  add(dataToMap, "Values wanted of data whose polygons have too few points",
    { "1 cell of the data (cell 0) has fewer points than a line or polygon needs." },
    "vtkResampleThroughHomeomorphism refuses.", [resampled]() {
      const auto mesh = MakeMesh({ { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 } }, {});
      mesh->GetPolys()->InsertNextCell({ 0, 1 });
      mesh->GetPolys()->InsertNextCell({ 0, 1, 2 });
      return resampled(mesh);
    });
  add(dataToMap, "Values wanted of data with a point that is NaN",
    { "1 point of the data (point 2) has coordinates that are not finite" },
    "vtkResampleThroughHomeomorphism refuses.", [resampled]() {
      return resampled(
        MakeMesh({ { 0, 0, 0 }, { 4, 0, 0 }, { 0, NotANumber, 0 } }, { { 0, 1, 2 } }));
    });
  add(dataToMap, "Values wanted of data whose offsets do not fit",
    { "The offsets of the data's cells do not fit their points." },
    "vtkResampleThroughHomeomorphism refuses.", [resampled]() {
      const auto mesh = MakeMesh({ { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 } }, {});
      vtkNew<vtkTypeInt64Array> offsets;
      vtkNew<vtkTypeInt64Array> connectivity;
      for (const int offset : { 0, 3, 700 })
      {
        offsets->InsertNextValue(offset);
      }
      for (const int id : { 0, 1, 2 })
      {
        connectivity->InsertNextValue(id);
      }
      vtkNew<vtkCellArray> polygons;
      polygons->SetData(offsets, connectivity);
      mesh->SetPolys(polygons);
      return resampled(mesh);
    });
  add(dataToMap, "Values wanted of data with an array of another length",
    { "The point array Velocity of the data has 2 values for 3 points." },
    "vtkResampleThroughHomeomorphism refuses.", [resampled]() {
      const auto mesh = MakeMesh({ { 0, 0, 0 }, { 4, 0, 0 }, { 0, 4, 0 } }, { { 0, 1, 2 } });
      mesh->GetPointData()->AddArray(RandomArray("Velocity", 3, 2, 5));
      return resampled(mesh);
    });
  add(dataToMap, "No points", {}, "Nothing comes out.", []() {
    return RunWithData(
      MakeCloud(std::vector<Point>{}),
      [](vtkPointSet* output) { return output->GetNumberOfPoints() == 0; }, 0);
  });
  add(dataToMap, "A table", { "Input for connection index 0 on input port index 2", "vtkTable" },
    "Refused. Give a data set or a tree of them.", []() {
      vtkNew<vtkTable> table;
      return RunWithData(
        table, [](vtkPointSet* output) { return !output || output->GetNumberOfPoints() == 0; }, -1);
    });

  // --- Use
  add(use, "No source", { "Input port 0 of algorithm", "has 0 connections but is not optional" },
    "Refused.", []() { return AskFilterWithoutInput(0); });
  add(use, "No target", { "Input port 1 of algorithm", "has 0 connections but is not optional" },
    "Refused.", []() { return AskFilterWithoutInput(1); });
  add(use, "An image where a mesh is wanted",
    { "Input for connection index 0 on input port index 0", "vtkImageData", "vtkPolyData" },
    "Refused.", []() {
      vtkNew<vtkImageData> image;
      image->SetDimensions(2, 2, 1);
      vtkNew<vtkDifferentiableHomeomorphism> filter;
      Listener listener;
      listener.ListenTo(filter);
      filter->SetInputDataObject(0, image);
      filter->SetTargetData(GoodPair().Target);
      filter->Update();
      return Outcome{ listener.GetText() };
    });
  add(use, "Setters with values out of range", {}, "The value is taken to the nearest allowed one.",
    []() {
      vtkNew<vtkDifferentiableHomeomorphism> filter;
      vtkNew<vtkTriangularCoordinates> coordinates;
      vtkNew<vtkJacobianContinuity> continuity;
      Listener listener;
      listener.ListenTo(filter);
      filter->SetCoordinateSystem(77);
      filter->SetCenterPoint(-5);
      filter->SetDiscordantTriangles(9);
      filter->SetTolerance(-1.0);
      coordinates->SetNumberOfContours(0);
      coordinates->SetLineResolution(1000000);
      continuity->SetSamplesPerEdge(-3);
      continuity->SetResolution(7.0);
      return Outcome{ listener.GetText(),
        filter->GetCoordinateSystem() == vtkDifferentiableHomeomorphism::CUBIC &&
          filter->GetCenterPoint() == vtkDifferentiableHomeomorphism::CENTROID &&
          filter->GetDiscordantTriangles() == vtkDifferentiableHomeomorphism::USE_LINEAR &&
          filter->GetTolerance() == 0.0 && coordinates->GetNumberOfContours() == 1 &&
          coordinates->GetLineResolution() == 1000 && continuity->GetSamplesPerEdge() == 1 &&
          continuity->GetResolution() == 1.0 };
    });
  add(use, "A tolerance that is NaN", {}, "As 0.", []() {
    const MeshPair pair = GoodPair();
    const auto filter =
      MakeFilter(Smooth, pair, MakeCloud({ { 1.0, 1.0, 0.0 }, { -0.1, 1.0, 0.0 } }));
    Listener listener;
    listener.ListenTo(filter.Get());
    filter->SetTolerance(NotANumber);
    filter->Update();
    return Outcome{ listener.GetText(), filter->GetNumberOfOutsidePoints() == 1 };
  });
  add(use, "SetAttributeTransformation without a name, or with an unknown transformation",
    { "SetAttributeTransformation takes an array's name and a transformation from" }, "Ignored.",
    []() {
      vtkNew<vtkDifferentiableHomeomorphism> filter;
      Listener listener;
      listener.ListenTo(filter);
      filter->SetAttributeTransformation(nullptr, 0);
      filter->SetAttributeTransformation("Velocity", 99);
      return Outcome{ listener.GetText() };
    });
  add(use, "A transform is used before its meshes are set",
    { "The source mesh is not set (SetSource, SetTarget): every point counts as outside." },
    "Every image is 1e30.", []() {
      vtkNew<vtkHomeomorphismTransform> transform;
      return AskTransform(transform, false);
    });
  add(use, "A deep copy of a transform with one mesh, which gets the other later",
    { "The target mesh is not set (SetSource, SetTarget): every point counts as outside." },
    "Every image is 1e30 until it has both.", []() {
      const MeshPair pair = GoodPair();
      vtkNew<vtkHomeomorphismTransform> half;
      half->SetSource(pair.Source);
      vtkNew<vtkHomeomorphismTransform> copy;
      copy->DeepCopy(half);
      Outcome outcome = AskTransform(copy, false);
      copy->SetTarget(pair.Target);
      const Outcome later = AskTransform(copy, true);
      outcome.AsItShouldBe = outcome.AsItShouldBe && later.AsItShouldBe && later.Message.empty();
      return outcome;
    });
  add(use, "A transform between surfaces",
    { "do not lie in a plane", "Use vtkDifferentiableHomeomorphism for surfaces." },
    "Every image is 1e30.", []() {
      vtkNew<vtkHomeomorphismTransform> transform;
      transform->SetSource(MakeSheet(4, 2, 0.5));
      transform->SetTarget(MakeSheet(4, 3, 0.5));
      return AskTransform(transform, false);
    });
  add(use, "Several threads ask one transform at the same time", {},
    "Each gets the same answers as alone.", []() {
      const MeshPair pair = GoodPair();
      vtkNew<vtkHomeomorphismTransform> transform;
      transform->SetSource(pair.Source);
      transform->SetTarget(pair.Target);
      transform->Update();
      const std::vector<MeshPoint> places = RandomSamples(pair.Source, 2000, 17);
      const auto run = [&](std::vector<Point>& images) {
        for (std::size_t i = 0; i < places.size(); ++i)
        {
          const Point p = PositionOf(pair.Source, places[i]);
          transform->InternalTransformPoint(p.data(), images[i].data());
        }
      };
      std::vector<Point> alone(places.size());
      run(alone);
      std::array<std::vector<Point>, 4> together;
      std::vector<std::thread> threads;
      for (auto& images : together)
      {
        images.resize(places.size());
        threads.emplace_back([&]() { run(images); });
      }
      for (std::thread& thread : threads)
      {
        thread.join();
      }
      bool same = true;
      for (const auto& images : together)
      {
        same = same && images == alone;
      }
      return Outcome{ "", same };
    });
  add(use, "vtkJacobianContinuity without a transform and without a target",
    { "There is no map to measure: set a transform (SetTransform) or a target mesh (input port "
      "1)." },
    "Nothing comes out.", []() {
      vtkNew<vtkJacobianContinuity> continuity;
      Listener listener;
      listener.ListenTo(continuity);
      continuity->SetInputData(GoodPair().Source);
      continuity->Update();
      return Outcome{ listener.GetText(), continuity->GetOutput()->GetNumberOfPoints() == 0 };
    });
  add(use, "vtkJacobianContinuity of a transform, on a surface",
    { "A transform is measured on a planar triangulation only.", "give the target mesh" },
    "Nothing comes out.", []() {
      vtkNew<vtkTransform> transform;
      vtkNew<vtkJacobianContinuity> continuity;
      Listener listener;
      listener.ListenTo(continuity);
      continuity->SetInputData(MakeSheet(4, 2, 0.5));
      continuity->SetTransform(transform);
      continuity->Update();
      return Outcome{ listener.GetText(), continuity->GetOutput()->GetNumberOfPoints() == 0 };
    });
  add(use, "vtkResampleThroughHomeomorphism lays an image over a surface",
    { "An image can be laid over a mesh that is parallel to the xy plane only", "(input port 3)" },
    "Nothing comes out.", []() {
      const MeshPair pair{ MakeSheet(4, 2, 0.5), MakeSheet(4, 3, 0.5) };
      vtkNew<vtkResampleThroughHomeomorphism> resample;
      Listener listener;
      listener.ListenTo(resample);
      resample->SetInputDataObject(0, pair.Source);
      resample->SetInputDataObject(1, pair.Target);
      resample->SetInputDataObject(2, pair.Source);
      resample->Update();
      auto* output = vtkDataSet::SafeDownCast(resample->GetOutputDataObject(0));
      return Outcome{ listener.GetText(),
        output && output->GetPointData()->GetNumberOfArrays() == 0 };
    });
  return rows;
}

/// For a cell of a table in Markdown.
TEST(BadInput, SaysWhatIsWrongWhereAndWhatToDo)
{
  const std::vector<BadInput> table = Table();
  EXPECT_GE(table.size(), 40u);
  for (const BadInput& row : table)
  {
    SCOPED_TRACE(row.Kind);
    const Outcome outcome = row.Provoke();
    EXPECT_TRUE(outcome.AsItShouldBe) << outcome.Message;
    if (row.Said.empty())
    {
      EXPECT_EQ(outcome.Message, "");
    }
    for (const std::string& text : row.Said)
    {
      EXPECT_NE(outcome.Message.find(text), std::string::npos)
        << "\"" << text << "\" is not in \"" << outcome.Message << "\"";
    }
  }
}

// Documentation/diagnostics.md has an entry for every kind of diagnostic and every remedy.
TEST(BadInput, EveryKindIsDocumented)
{
  using homeomorphism::GetName;
  using homeomorphism::MeshDiagnostic;
  std::ifstream file(DIAGNOSTICS_DOCUMENT);
  const std::string document{ std::istreambuf_iterator<char>(file),
    std::istreambuf_iterator<char>() };
  ASSERT_FALSE(document.empty()) << DIAGNOSTICS_DOCUMENT;
  for (int kind = 0; kind < MeshDiagnostic::NumberOfKinds; ++kind)
  {
    MeshDiagnostic diagnostic;
    diagnostic.What = static_cast<MeshDiagnostic::Kind>(kind);
    const std::string entry = std::string("| `") + GetName(diagnostic.What) + "` |";
    EXPECT_NE(document.find(entry), std::string::npos) << entry;
    const std::string remedy = std::string("`") + GetName(diagnostic.GetRemedy()) + "` |";
    EXPECT_NE(document.find(remedy, document.find(entry)), std::string::npos) << remedy;
  }
}

} // namespace
