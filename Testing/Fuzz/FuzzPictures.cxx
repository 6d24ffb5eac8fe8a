// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

// Reads any bytes as one of the pictures that the program dhm reads itself. What it also writes is
// written, and what is written must be read as the same.

#include "FuzzRequire.h"

#include "Program/Failure.h"
#include "Program/InputFile.h"
#include "Program/OutputFile.h"
#include "Program/PictureFile.h"
#include "Program/TemporaryFile.h"

#include "vtkDataArray.h"
#include "vtkPointData.h"

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>

namespace
{

using Reader = vtkSmartPointer<vtkImageData> (*)(const dhm::InputFile&);
using Writer = void (*)(vtkImageData*, const dhm::OutputFile&);

using fuzz::Require;

/// Files that are written again and again: in memory, where there is a folder for that.
std::string BeginOfNames()
{
  const std::filesystem::path memory = "/dev/shm";
  return (
    (std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path()) /
    "dhm-fuzz-")
    .string();
}

/// Whether the pixels are the same, bit for bit.
void RequireSamePixels(vtkImageData* a, vtkImageData* b)
{
  vtkDataArray* first = a->GetPointData()->GetScalars();
  vtkDataArray* second = b->GetPointData()->GetScalars();
  Require(a->GetDimensions()[0] == b->GetDimensions()[0]);
  Require(a->GetDimensions()[1] == b->GetDimensions()[1]);
  Require(first->GetDataType() == second->GetDataType());
  Require(first->GetNumberOfValues() == second->GetNumberOfValues());
  Require(std::memcmp(first->GetVoidPointer(0), second->GetVoidPointer(0),
            static_cast<std::size_t>(first->GetNumberOfValues() * first->GetDataTypeSize())) == 0);
}

void ReadAndBack(const std::string& name, Reader read, Writer write)
{
  const auto image = read(dhm::InputFile(name, ""));
  const int* size = image->GetDimensions();
  vtkDataArray* pixels = image->GetPointData()->GetScalars();
  Require(pixels && size[0] >= 1 && size[1] >= 1 && size[2] == 1);
  Require(pixels->GetNumberOfTuples() == static_cast<vtkIdType>(size[0]) * size[1]);
  Require(pixels->GetNumberOfComponents() >= 1 && pixels->GetNumberOfComponents() <= 4);
  if (!write)
  {
    return;
  }
  static const dhm::TemporaryFile written(BeginOfNames(), std::filesystem::path(name).extension());
  dhm::OutputFile output(written.GetName(), "", true);
  try
  {
    write(image, output);
  }
  catch (const dhm::Failure& failure)
  {
    // Not every picture that is read can be written, as one of 16 bits as .ppm.
    Require(failure.GetStatus() == dhm::REFUSED);
    return;
  }
  output.Commit();
  RequireSamePixels(image, read(dhm::InputFile(written.GetName(), "")));
}

void Replace(const std::string& name, const std::uint8_t* begin, std::size_t size)
{
  std::ofstream(name, std::ios::binary)
    .write(reinterpret_cast<const char*>(begin), static_cast<std::streamsize>(size));
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size)
{
  static const dhm::TemporaryFile png(BeginOfNames(), ".png");
  static const dhm::TemporaryFile pnm(BeginOfNames(), ".ppm");
  static const dhm::TemporaryFile tiff(BeginOfNames(), ".tif");
  if (size == 0)
  {
    return 0;
  }
  const std::string& name = (bytes[0] == 'p' ? png : bytes[0] == 'n' ? pnm : tiff).GetName();
  Replace(name, bytes + 1, size - 1);
  try
  {
    switch (bytes[0])
    {
      case 'p':
        ReadAndBack(name, &dhm::ReadPng, nullptr);
        break;
      case 'n':
        ReadAndBack(name, &dhm::ReadPnm, &dhm::WritePnm);
        break;
      default:
        ReadAndBack(name, &dhm::ReadTiff, &dhm::WriteTiff);
    }
  }
  catch (const dhm::Failure&)
  {
  }
  return 0;
}
