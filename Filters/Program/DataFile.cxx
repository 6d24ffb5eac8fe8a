// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "DataFile.h"

#include "Console.h"
#include "Failure.h"
#include "InputFile.h"
#include "OutputFile.h"

#include "vtkErrorCode.h"
#include "vtkGenericDataObjectReader.h"
#include "vtkGenericDataObjectWriter.h"
#include "vtkImageReader2.h"
#include "vtkImageReader2Factory.h"
#include "vtkJPEGWriter.h"
#include "vtkNew.h"
#include "vtkPNGWriter.h"
#include "vtkPNMWriter.h"
#include "vtkTIFFWriter.h"
#include "vtkXMLDataObjectWriter.h"
#include "vtkXMLGenericDataObjectReader.h"
#include "vtkXMLWriter.h"

#include <algorithm>
#include <array>

namespace dhm
{
namespace
{

constexpr std::array<const char*, 8> pictureFormats{ "png", "jpg", "jpeg", "tif", "tiff", "pnm",
  "ppm", "pgm" };
constexpr std::array<const char*, 5> xmlFormats{ "vtp", "vtu", "vts", "vti", "vtr" };
constexpr std::array<const char*, 4> xmlTreeFormats{ "vtm", "vtmb", "vtpd", "vtpc" };

template <typename Formats>
bool IsOneOf(const std::string& format, const Formats& formats)
{
  return std::find(formats.begin(), formats.end(), format) != formats.end();
}

[[noreturn]] void FailToRead(const InputFile& file, const std::string& why)
{
  throw Failure(FILE_TROUBLE,
    "Cannot read " + file.GetName() +
      (why.empty() ? " as what its name says (." + file.GetFormat() + ")." : ": " + why));
}

template <typename Reader>
vtkSmartPointer<vtkDataObject> ReadWith(Reader* reader, const InputFile& file)
{
  reader->SetFileName(file.GetPath().c_str());
  ProgressBar bar("Reading " + file.GetName());
  bar.Follow(reader);
  reader->Update();
  const std::string errors = TakeErrors();
  vtkDataObject* output = reader->GetOutputDataObject(0);
  if (!errors.empty() || !output)
  {
    FailToRead(file, errors);
  }
  return output;
}

template <typename Writer>
void WriteWith(Writer* writer, vtkDataObject* data, const OutputFile& file)
{
  writer->SetInputDataObject(data);
  writer->SetFileName(file.GetTemporaryName().c_str());
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

void WritePicture(vtkDataObject* data, const OutputFile& file)
{
  const std::string& format = file.GetFormat();
  if (!vtkImageData::SafeDownCast(data))
  {
    throw Failure(WRONG_USAGE,
      "A picture (." + format + ") cannot hold a " + data->GetClassName() +
        ": only images are pictures.");
  }
  if (format == "png")
  {
    WriteWith(vtkNew<vtkPNGWriter>().Get(), data, file);
  }
  else if (format == "tif" || format == "tiff")
  {
    WriteWith(vtkNew<vtkTIFFWriter>().Get(), data, file);
  }
  else if (format == "jpg" || format == "jpeg")
  {
    vtkNew<vtkJPEGWriter> writer;
    writer->SetQuality(95);
    WriteWith(writer.Get(), data, file);
  }
  else
  {
    WriteWith(vtkNew<vtkPNMWriter>().Get(), data, file);
  }
}

} // namespace

bool IsPicture(const std::string& format)
{
  return IsOneOf(format, pictureFormats);
}

vtkSmartPointer<vtkDataObject> ReadData(const InputFile& file)
{
  const std::string& format = file.GetFormat();
  if (IsOneOf(format, xmlFormats) || IsOneOf(format, xmlTreeFormats))
  {
    vtkNew<vtkXMLGenericDataObjectReader> reader;
    return ReadWith(reader.Get(), file);
  }
  if (format == "vtk")
  {
    vtkNew<vtkGenericDataObjectReader> reader;
    reader->ReadAllScalarsOn();
    reader->ReadAllVectorsOn();
    reader->ReadAllNormalsOn();
    reader->ReadAllTensorsOn();
    reader->ReadAllColorScalarsOn();
    reader->ReadAllTCoordsOn();
    reader->ReadAllFieldsOn();
    return ReadWith(reader.Get(), file);
  }
  if (IsPicture(format))
  {
    return ReadImage(file);
  }
  throw Failure(WRONG_USAGE,
    "Cannot read " + file.GetName() +
      ": the formats of data are .csv, .txt and .xyz (points), .vtp, .vtu, .vts, .vtr, .vti, .vtm, "
      ".vtk, and "
      "pictures (.png, .jpg, .tif, .ppm).");
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
  const auto reader =
    vtk::TakeSmartPointer(vtkImageReader2Factory::CreateImageReader2(file.GetPath().c_str()));
  if (!reader)
  {
    FailToRead(file, "");
  }
  // The readers of pictures report no errors of damaged data through the pipeline, but here.
  const vtkSmartPointer<vtkDataObject> output = ReadWith(reader.Get(), file);
  auto image = vtkSmartPointer<vtkImageData>(vtkImageData::SafeDownCast(output));
  if (!image || image->GetNumberOfPoints() == 0 || reader->GetErrorCode() != 0)
  {
    FailToRead(file, "");
  }
  image->SetSpacing(1.0, 1.0, 1.0);
  image->SetOrigin(0.0, 0.0, 0.0);
  return image;
}

void CheckOutputFormat(const std::string& format)
{
  if (!IsOneOf(format, xmlFormats) && !IsPicture(format) && format != "vtk")
  {
    throw Failure(WRONG_USAGE,
      (format.empty() ? std::string("The output's name has no extension")
                      : "Cannot write ." + format) +
        ": the formats are .csv and .txt (if the data came from such a file), .vtp, .vtu, .vts, "
        ".vtr, "
        ".vti, .vtk, and pictures (.png, .jpg, .tif, .ppm).");
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
    WriteWith(writer.Get(), data, file);
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
  WriteWith(writer.Get(), data, file);
}

} // namespace dhm
