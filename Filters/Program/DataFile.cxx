// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "DataFile.h"

#include "Console.h"
#include "Failure.h"
#include "InputFile.h"
#include "OutputFile.h"
#include "PictureFile.h"
#include "PlyMesh.h"
#include "StlMesh.h"
#include "TextMesh.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkErrorCode.h"
#include "vtkGenericDataObjectReader.h"
#include "vtkGenericDataObjectWriter.h"
#include "vtkJPEGReader.h"
#include "vtkJPEGWriter.h"
#include "vtkNew.h"
#include "vtkPNGWriter.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"
#include "vtkXMLDataObjectWriter.h"
#include "vtkXMLGenericDataObjectReader.h"
#include "vtkXMLWriter.h"

#include <algorithm>
#include <array>
#include <csignal>
#include <fstream>
#include <initializer_list>
#include <new>
#include <vector>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dhm
{
namespace
{

constexpr std::array<const char*, 8> pictureFormats{ "png", "jpg", "jpeg", "tif", "tiff", "pnm",
  "ppm", "pgm" };
constexpr std::array<const char*, 5> xmlFormats{ "vtp", "vtu", "vts", "vti", "vtr" };
constexpr std::array<const char*, 4> xmlTreeFormats{ "vtm", "vtmb", "vtpd", "vtpc" };

using MeshReader = vtkSmartPointer<vtkPolyData> (*)(std::istream& file, const std::string& name);

/// Nothing, if the format is not one of meshes.
MeshReader FindMeshReader(const std::string& format)
{
  return format == "obj" ? &ReadObj
    : format == "off"    ? &ReadOff
    : format == "ply"    ? &ReadPly
    : format == "stl"    ? &ReadStl
                         : nullptr;
}

template <typename Value, typename Values>
bool IsOneOf(const Value& value, const Values& values)
{
  return std::find(values.begin(), values.end(), value) != values.end();
}

[[noreturn]] void FailToRead(const InputFile& file, const std::string& why)
{
  throw Failure(FILE_TROUBLE,
    "Cannot read " + file.GetName() +
      (why.empty() ? " as what its name says (." + file.GetFormat() + ")." : ": " + why));
}

/// Throws Failure if cells' points are not where the mesh says: no reader of VTK looks, and all
/// that go through the cells would read memory of others.
void RequireCells(vtkDataObject* data, const InputFile& file)
{
  std::vector<vtkCellArray*> arrays;
  if (auto* mesh = vtkPolyData::SafeDownCast(data))
  {
    arrays = { mesh->GetVerts(), mesh->GetLines(), mesh->GetPolys(), mesh->GetStrips() };
  }
  else if (auto* grid = vtkUnstructuredGrid::SafeDownCast(data))
  {
    arrays = { grid->GetCells() };
  }
  for (vtkCellArray* cells : arrays)
  {
    if (cells && !cells->IsValid())
    {
      FailToRead(file, "the numbers that say where each cell's points begin are wrong.");
    }
  }
}

/// Warnings are errors: many of VTK's readers only warn of data that is not there.
template <typename Reader>
vtkSmartPointer<vtkDataObject> ReadWith(Reader* reader, const InputFile& file)
{
  reader->SetFileName(file.GetPath().c_str());
  try
  {
    ProgressBar bar("Reading " + file.GetName());
    bar.Follow(reader);
    reader->Update();
  }
  catch (const std::bad_alloc&)
  {
    FailToRead(file, "it says that it needs more memory than there is.");
  }
  std::string errors = TakeErrors();
  const std::string warnings = TakeWarnings();
  errors = errors.empty() ? warnings : errors;
  vtkDataObject* output = reader->GetOutputDataObject(0);
  if (!errors.empty() || !output || reader->GetErrorCode() != 0)
  {
    FailToRead(file, errors);
  }
  RequireCells(output, file);
  return output;
}

/// Of a legacy file. VTK 9.1's reader crashes on some that have been cut off: a child process tries
/// first.
vtkSmartPointer<vtkDataObject> ReadLegacy(const InputFile& file)
{
  vtkNew<vtkGenericDataObjectReader> reader;
  reader->SetFileName(file.GetPath().c_str());
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllNormalsOn();
  reader->ReadAllTensorsOn();
  reader->ReadAllColorScalarsOn();
  reader->ReadAllTCoordsOn();
  reader->ReadAllFieldsOn();
  const pid_t child = fork();
  if (child == 0)
  {
    // A crash is expected, and leaves no memory image behind.
    const rlimit none{ 0, 0 };
    setrlimit(RLIMIT_CORE, &none);
    // It has to be seen as what it is, too, if somebody else watches over crashes.
    for (const int signal : { SIGINT, SIGTERM, SIGHUP, SIGSEGV, SIGBUS, SIGFPE, SIGABRT })
    {
      std::signal(signal, SIG_DFL);
    }
    // Nor may what the C library says of it be seen.
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    dup2(nowhere, STDERR_FILENO);
    try
    {
      reader->Update();
    }
    catch (...)
    {
      // The parent finds out the same.
    }
    _exit(0);
  }
  int status = 0;
  if (child > 0 && waitpid(child, &status, 0) == child && WIFSIGNALED(status) &&
    WTERMSIG(status) != SIGKILL)
  {
    FailToRead(file, "it has been cut off, or is damaged.");
  }
  return ReadWith(reader.Get(), file);
}

/// Lets a writer write. All are asked to do so to memory: of VTK 9.1's, some crash on full disks,
/// and others do not notice.
template <typename Writer>
void WriteWith(Writer* writer, vtkDataObject* data, const OutputFile& file)
{
  writer->SetInputDataObject(data);
  writer->Write();
  const std::string errors = TakeErrors();
  if (!errors.empty() || writer->GetErrorCode() != 0)
  {
    throw Failure(FILE_TROUBLE,
      "Cannot write " + file.GetName() + ": " +
        (errors.empty()
            ? std::string(vtkErrorCode::GetStringFromErrorCode(writer->GetErrorCode())) + "."
            : errors));
  }
}

template <typename Writer>
void WriteBytes(Writer* writer, vtkDataObject* data, const OutputFile& file)
{
  writer->WriteToMemoryOn();
  WriteWith(writer, data, file);
  const vtkUnsignedCharArray* bytes = writer->GetResult();
  file.Write(
    { reinterpret_cast<const char*>(const_cast<vtkUnsignedCharArray*>(bytes)->GetPointer(0)),
      static_cast<std::size_t>(bytes->GetNumberOfValues()) });
}

/// Throws Failure if the pixels are not of these types and numbers of components.
void RequirePixels(vtkImageData* image, const OutputFile& file, std::initializer_list<int> types,
  std::initializer_list<int> numbers)
{
  vtkDataArray* pixels = image->GetPointData()->GetScalars();
  const int components = pixels ? pixels->GetNumberOfComponents() : 0;
  if (!pixels || !IsOneOf(pixels->GetDataType(), types) || !IsOneOf(components, numbers))
  {
    throw Failure(REFUSED,
      "A ." + file.GetFormat() + " picture cannot hold " + std::to_string(components) +
        " components of " + (pixels ? pixels->GetDataTypeAsString() : "none") +
        ": write a .vti or .tif.");
  }
}

void WritePicture(vtkDataObject* data, const OutputFile& file)
{
  const std::string& format = file.GetFormat();
  auto* image = vtkImageData::SafeDownCast(data);
  if (!image)
  {
    throw Failure(WRONG_USAGE,
      "A picture (." + format + ") cannot hold a " + data->GetClassName() +
        ": only images are pictures.");
  }
  if (image->GetDimensions()[2] != 1)
  {
    throw Failure(REFUSED,
      "A picture (." + format + ") has one layer, not " +
        std::to_string(image->GetDimensions()[2]) + ": write a .vti.");
  }
  if (format == "png")
  {
    RequirePixels(image, file, { VTK_UNSIGNED_CHAR, VTK_UNSIGNED_SHORT }, { 1, 2, 3, 4 });
    WriteBytes(vtkNew<vtkPNGWriter>().Get(), data, file);
  }
  else if (format == "tif" || format == "tiff")
  {
    WriteTiff(image, file);
  }
  else if (format == "jpg" || format == "jpeg")
  {
    RequirePixels(image, file, { VTK_UNSIGNED_CHAR }, { 1, 3 });
    vtkNew<vtkJPEGWriter> writer;
    writer->SetQuality(95);
    WriteBytes(writer.Get(), data, file);
  }
  else
  {
    WritePnm(image, file);
  }
}

void WriteTextMesh(vtkPolyData* mesh, const OutputFile& file)
{
  vtkDataArray* mask = mesh->GetPointData()->GetArray("vtkValidPointMask");
  if (mask && mesh->GetNumberOfPoints() > 0 && mask->GetRange()[0] == 0.0)
  {
    throw Failure(REFUSED,
      "Points are outside the domain, which a ." + file.GetFormat() +
        " file cannot say: write a .vtp.");
  }
  std::string lost;
  for (vtkDataSetAttributes* arrays :
    std::initializer_list<vtkDataSetAttributes*>{ mesh->GetPointData(), mesh->GetCellData() })
  {
    for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
    {
      const char* name = arrays->GetAbstractArray(i)->GetName();
      if (name && name != std::string("vtkValidPointMask"))
      {
        lost += (lost.empty() ? "" : ", ") + std::string(name);
      }
    }
  }
  if (!lost.empty())
  {
    Warn(file.GetName() + " holds points and polygons only: it is without " + lost + ".");
  }
  const auto write = file.GetFormat() == "obj" ? &WriteObj : &WriteOff;
  file.Write([mesh, write](std::ostream& text) { write(mesh, text); });
}

vtkSmartPointer<vtkImageData> ReadJpeg(const InputFile& file)
{
  vtkNew<vtkJPEGReader> reader;
  if (reader->CanReadFile(file.GetPath().c_str()) == 0)
  {
    TakeErrors();
    TakeWarnings();
    FailToRead(file, "");
  }
  const auto image =
    vtkSmartPointer<vtkImageData>(vtkImageData::SafeDownCast(ReadWith(reader.Get(), file)));
  if (!image || image->GetNumberOfPoints() == 0)
  {
    FailToRead(file, "");
  }
  return image;
}

} // namespace

bool IsPicture(const std::string& format)
{
  return IsOneOf(format, pictureFormats);
}

bool IsMesh(const std::string& format)
{
  return FindMeshReader(format) != nullptr;
}

vtkSmartPointer<vtkDataObject> ReadData(const InputFile& file, const std::string& others)
{
  const std::string& format = file.GetFormat();
  if (IsOneOf(format, xmlFormats) || IsOneOf(format, xmlTreeFormats))
  {
    vtkNew<vtkXMLGenericDataObjectReader> reader;
    return ReadWith(reader.Get(), file);
  }
  if (format == "vtk")
  {
    return ReadLegacy(file);
  }
  if (IsPicture(format))
  {
    return ReadImage(file);
  }
  if (const MeshReader read = FindMeshReader(format))
  {
    std::ifstream bytes(file.GetPath(), std::ios::binary);
    return read(bytes, file.GetName());
  }
  throw Failure(WRONG_USAGE,
    "Cannot read " + file.GetName() + " as data: the formats are " +
      (others.empty() ? "" : others + ", ") +
      ".vtp, .vtu, .vts, .vtr, .vti, .vtm, .vtk, .obj, .off, .ply, .stl, and pictures (.png, .jpg, "
      ".tif, .ppm).");
}

vtkSmartPointer<vtkImageData> ReadImage(const InputFile& file)
{
  if (!IsPicture(file.GetFormat()))
  {
    auto image = vtkSmartPointer<vtkImageData>(vtkImageData::SafeDownCast(ReadData(file)));
    if (!image)
    {
      throw Failure(FILE_TROUBLE, file.GetName() + " is no image.");
    }
    return image;
  }
  // The one that the name says: a picture of another kind under this name is damaged, or a mistake.
  const std::string& format = file.GetFormat();
  vtkSmartPointer<vtkImageData> image;
  if (format == "png")
  {
    image = ReadPng(file);
  }
  else if (format == "jpg" || format == "jpeg")
  {
    image = ReadJpeg(file);
  }
  else if (format == "tif" || format == "tiff")
  {
    image = ReadTiff(file);
  }
  else
  {
    image = ReadPnm(file);
  }
  image->SetSpacing(1.0, 1.0, 1.0);
  image->SetOrigin(0.0, 0.0, 0.0);
  return image;
}

void CheckOutputFormat(const std::string& format, const std::string& others)
{
  if (!IsOneOf(format, xmlFormats) && !IsPicture(format) && format != "vtk" && format != "obj" &&
    format != "off")
  {
    throw Failure(WRONG_USAGE,
      CannotWrite("data", format) + ": the formats are " + (others.empty() ? "" : others + ", ") +
        ".vtp, .vtu, .vts, .vtr, .vti, .vtk, .obj, .off, and pictures (.png, .jpg, .tif, .ppm).");
  }
}

void WriteData(vtkDataObject* data, const OutputFile& file)
{
  const std::string& format = file.GetFormat();
  CheckOutputFormat(format);
  if (IsPicture(format))
  {
    WritePicture(data, file);
    return;
  }
  if (format == "vtk")
  {
    vtkNew<vtkGenericDataObjectWriter> writer;
    writer->SetFileTypeToBinary();
    writer->WriteToOutputStringOn();
    WriteWith(writer.Get(), data, file);
    file.Write(
      { writer->GetOutputString(), static_cast<std::size_t>(writer->GetOutputStringLength()) });
    return;
  }
  if (auto* mesh = vtkPolyData::SafeDownCast(data); mesh && (format == "obj" || format == "off"))
  {
    WriteTextMesh(mesh, file);
    return;
  }
  const auto writer =
    vtk::TakeSmartPointer(vtkXMLDataObjectWriter::NewWriter(data->GetDataObjectType()));
  const std::string right = writer ? writer->GetDefaultFileExtension() : "vtk";
  if (format != right)
  {
    throw Failure(WRONG_USAGE,
      "A ." + format + " file cannot hold a " + data->GetClassName() +
        ": give the output the extension ." + right + ".");
  }
  // VTK before 9.4 cannot read data at a file's end with every version of expat.
  writer->SetDataModeToBinary();
  writer->WriteToOutputStringOn();
  WriteWith(writer.Get(), data, file);
  file.Write(writer->GetOutputString());
}

} // namespace dhm
