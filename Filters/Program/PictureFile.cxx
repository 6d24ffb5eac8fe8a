// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "PictureFile.h"

#include "Failure.h"
#include "InputFile.h"
#include "Numbers.h"
#include "OutputFile.h"

#include "vtkDataArray.h"
#include "vtkPointData.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <png.h>
#include <tiffio.h>

namespace dhm
{
namespace
{

constexpr std::uint64_t maximumSide = 1000000;

[[noreturn]] void Fail(const InputFile& file, const std::string& why)
{
  throw Failure(FILE_TROUBLE,
    "Cannot read " + file.GetName() + " as a picture (." + file.GetFormat() + "): " + why +
      ". It is damaged, or something else than its name says.");
}

vtkSmartPointer<vtkImageData> MakeImage(
  std::uint64_t width, std::uint64_t height, int components, int type)
{
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(static_cast<int>(width), static_cast<int>(height), 1);
  image->AllocateScalars(type, components);
  image->GetPointData()->GetScalars()->SetName("Pixels");
  return image;
}

int UnsignedType(int bits)
{
  return bits == 16 ? VTK_UNSIGNED_SHORT : VTK_UNSIGNED_CHAR;
}

unsigned char* RowFromTop(vtkImageData* image, int row)
{
  return static_cast<unsigned char*>(
    image->GetScalarPointer(0, image->GetDimensions()[1] - 1 - row, 0));
}

bool IsLittleEndian()
{
  const std::uint16_t one = 1;
  unsigned char first;
  std::memcpy(&first, &one, 1);
  return first == 1;
}

// --- PNG: libpng leaves by longjmp, over C++ objects of no frame but its own.

struct PngReader
{
  png_structp Png = nullptr;
  png_infop Info = nullptr;
  char Error[200] = "";

  PngReader()
  {
    this->Png = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &OnError, &OnWarning);
    this->Info = this->Png ? png_create_info_struct(this->Png) : nullptr;
  }
  ~PngReader() { png_destroy_read_struct(&this->Png, &this->Info, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  static void OnError(png_structp png, png_const_charp message)
  {
    auto* self = static_cast<PngReader*>(png_get_error_ptr(png));
    std::snprintf(self->Error, sizeof self->Error, "%s", message);
    longjmp(png_jmpbuf(png), 1);
  }

  static void OnWarning(png_structp, png_const_charp) {}
};

/// Reads all before the pixels, and asks for them as whole bytes of gray or colors.
bool ReadPngHeader(PngReader& reader, std::FILE* file)
{
  if (setjmp(png_jmpbuf(reader.Png)))
  {
    return false;
  }
  png_init_io(reader.Png, file);
  png_read_info(reader.Png, reader.Info);
  png_set_expand(reader.Png);
  if (IsLittleEndian())
  {
    png_set_swap(reader.Png);
  }
  png_set_interlace_handling(reader.Png);
  png_read_update_info(reader.Png, reader.Info);
  return true;
}

bool ReadPngRows(PngReader& reader, png_bytepp rows)
{
  if (setjmp(png_jmpbuf(reader.Png)))
  {
    return false;
  }
  png_read_image(reader.Png, rows);
  png_read_end(reader.Png, nullptr);
  return true;
}

// --- PNM

/// The next number of a header or a text picture, behind blanks and comments.
std::uint64_t NextNumber(std::istream& text, const InputFile& file)
{
  int c = text.get();
  for (; c == '#' || c == ' ' || (c >= '\t' && c <= '\r'); c = text.get())
  {
    if (c == '#')
    {
      std::string comment;
      std::getline(text, comment);
    }
  }
  std::string digits;
  for (; c >= '0' && c <= '9'; c = text.get())
  {
    digits += static_cast<char>(c);
  }
  const auto number = ToNumber<std::uint64_t>(digits);
  if (!number)
  {
    Fail(file, c < 0 ? "it ends where a number is expected" : "a number is expected");
  }
  return *number;
}

// --- TIFF

std::string tiffError;

void KeepTiffError(const char*, const char* format, va_list arguments)
{
  char text[300];
  std::vsnprintf(text, sizeof text, format, arguments);
  tiffError = text;
}

/// Keeps libtiff's messages from the terminal; the last error is in tiffError.
void KeepTiffMessages()
{
  TIFFSetErrorHandler(KeepTiffError);
  // Cameras and scanners put fields into their files that libtiff does not know.
  TIFFSetWarningHandler(nullptr);
  tiffError = "it is cut off";
}

/// The type of a TIFF's numbers; 0 if they have none of VTK's.
int TypeOfSamples(int bits, int format)
{
  if (format == SAMPLEFORMAT_IEEEFP)
  {
    return bits == 32 ? VTK_FLOAT : bits == 64 ? VTK_DOUBLE : 0;
  }
  if (format == SAMPLEFORMAT_INT)
  {
    return bits == 8 ? VTK_SIGNED_CHAR : bits == 16 ? VTK_SHORT : bits == 32 ? VTK_INT : 0;
  }
  return bits == 8 ? VTK_UNSIGNED_CHAR
    : bits == 16   ? VTK_UNSIGNED_SHORT
    : bits == 32   ? VTK_UNSIGNED_INT
                   : 0;
}

int Get(TIFF* tiff, std::uint32_t tag)
{
  std::uint16_t value = 0;
  TIFFGetFieldDefaulted(tiff, tag, &value);
  return value;
}

/// Palettes, compressed colors, bits, tiles: as libtiff shows them, 8 bits of four components.
bool ReadShownTiff(TIFF* tiff, vtkImageData* image)
{
  const int* size = image->GetDimensions();
  std::vector<std::uint32_t> shown(
    static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]));
  if (TIFFReadRGBAImageOriented(tiff, static_cast<std::uint32_t>(size[0]),
        static_cast<std::uint32_t>(size[1]), shown.data(), ORIENTATION_BOTLEFT, 1) == 0)
  {
    return false;
  }
  auto* to = static_cast<unsigned char*>(image->GetScalarPointer());
  for (const std::uint32_t pixel : shown)
  {
    const auto opacity = static_cast<unsigned int>(TIFFGetA(pixel));
    for (const auto value : { TIFFGetR(pixel), TIFFGetG(pixel), TIFFGetB(pixel) })
    {
      // Colors come multiplied by the opacity.
      const unsigned int color = opacity > 0 ? (value * 255u + opacity / 2) / opacity : 0;
      *to++ = static_cast<unsigned char>(std::min(color, 255u));
    }
    *to++ = static_cast<unsigned char>(opacity);
  }
  return true;
}

} // namespace

vtkSmartPointer<vtkImageData> ReadPng(const InputFile& file)
{
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> open(
    std::fopen(file.GetPath().c_str(), "rb"), &std::fclose);
  PngReader reader;
  if (!open || !reader.Info)
  {
    Fail(file, "it cannot be opened");
  }
  if (!ReadPngHeader(reader, open.get()))
  {
    Fail(file, reader.Error);
  }
  const std::uint64_t width = png_get_image_width(reader.Png, reader.Info);
  const std::uint64_t height = png_get_image_height(reader.Png, reader.Info);
  const std::uint64_t rowSize = png_get_rowbytes(reader.Png, reader.Info);
  // Nothing is compressed to less than a thousandth, and a bit can stand for four bytes: no memory
  // is asked for that the file cannot fill.
  if (rowSize * height / 40000 > std::filesystem::file_size(file.GetPath()))
  {
    Fail(file,
      "it is too short for " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  }
  auto image = MakeImage(width, height, png_get_channels(reader.Png, reader.Info),
    UnsignedType(png_get_bit_depth(reader.Png, reader.Info)));
  std::vector<png_bytep> rows(height);
  for (std::size_t row = 0; row < rows.size(); ++row)
  {
    rows[row] = RowFromTop(image, static_cast<int>(row));
  }
  if (!ReadPngRows(reader, rows.data()))
  {
    Fail(file, reader.Error);
  }
  return image;
}

vtkSmartPointer<vtkImageData> ReadPnm(const InputFile& file)
{
  std::ifstream bytes(file.GetPath(), std::ios::binary);
  char magic[2] = "";
  bytes.read(magic, 2);
  const bool known = bytes && magic[0] == 'P' &&
    (magic[1] == '2' || magic[1] == '3' || magic[1] == '5' || magic[1] == '6');
  if (!known)
  {
    Fail(file, "it does not begin with P2, P3, P5 or P6");
  }
  const bool text = magic[1] < '5';
  const int components = magic[1] == '3' || magic[1] == '6' ? 3 : 1;
  const std::uint64_t width = NextNumber(bytes, file);
  const std::uint64_t height = NextNumber(bytes, file);
  const std::uint64_t largest = NextNumber(bytes, file);
  if (width < 1 || height < 1 || width > maximumSide || height > maximumSide || largest < 1 ||
    largest > 65535)
  {
    Fail(file, "its size or its largest value is out of range");
  }
  const int bits = largest > 255 ? 16 : 8;
  const std::uint64_t values = width * height * static_cast<std::uint64_t>(components);
  const std::uint64_t size = std::filesystem::file_size(file.GetPath());
  const auto position = static_cast<std::uint64_t>(bytes.tellg());
  const std::uint64_t needed = values * (text ? 1 : static_cast<std::uint64_t>(bits) / 8);
  if (needed > size - std::min(size, position))
  {
    Fail(file,
      "it is too short for " + std::to_string(width) + " x " + std::to_string(height) + " pixels");
  }
  auto image = MakeImage(width, height, components, UnsignedType(bits));
  const double full = bits == 16 ? 65535.0 : 255.0;
  const auto scale = [&](std::uint64_t value) {
    return largest == static_cast<std::uint64_t>(full)
      ? value
      : static_cast<std::uint64_t>(std::llround(
          full * static_cast<double>(std::min(value, largest)) / static_cast<double>(largest)));
  };
  for (int row = 0; row < static_cast<int>(height); ++row)
  {
    unsigned char* to = RowFromTop(image, row);
    for (std::uint64_t i = 0; i < width * static_cast<std::uint64_t>(components); ++i)
    {
      std::uint64_t value;
      if (text)
      {
        value = NextNumber(bytes, file);
        if (value > largest)
        {
          Fail(file, "a value is larger than the largest");
        }
      }
      else
      {
        // The more significant byte comes first.
        value = static_cast<std::uint64_t>(bytes.get());
        value = bits == 16 ? value << 8 | static_cast<std::uint64_t>(bytes.get()) : value;
      }
      value = scale(value);
      if (bits == 16)
      {
        const auto narrow = static_cast<std::uint16_t>(value);
        std::memcpy(to + 2 * i, &narrow, 2);
      }
      else
      {
        to[i] = static_cast<unsigned char>(value);
      }
    }
  }
  return image;
}

vtkSmartPointer<vtkImageData> ReadTiff(const InputFile& file)
{
  KeepTiffMessages();
  const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(
    TIFFOpen(file.GetPath().c_str(), "r"), &TIFFClose);
  if (!tiff)
  {
    Fail(file, tiffError);
  }
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  TIFFGetField(tiff.get(), TIFFTAG_IMAGEWIDTH, &width);
  TIFFGetField(tiff.get(), TIFFTAG_IMAGELENGTH, &height);
  const int components = Get(tiff.get(), TIFFTAG_SAMPLESPERPIXEL);
  const int photometric = Get(tiff.get(), TIFFTAG_PHOTOMETRIC);
  const int type =
    TypeOfSamples(Get(tiff.get(), TIFFTAG_BITSPERSAMPLE), Get(tiff.get(), TIFFTAG_SAMPLEFORMAT));
  const bool isPlain = type != 0 && TIFFIsTiled(tiff.get()) == 0 && components <= 4 &&
    Get(tiff.get(), TIFFTAG_PLANARCONFIG) == PLANARCONFIG_CONTIG &&
    Get(tiff.get(), TIFFTAG_ORIENTATION) == ORIENTATION_TOPLEFT &&
    (photometric == PHOTOMETRIC_MINISBLACK || photometric == PHOTOMETRIC_RGB);
  if (width < 1 || height < 1 || width > maximumSide || height > maximumSide || components < 1 ||
    static_cast<std::uint64_t>(width) * height / 40000 > std::filesystem::file_size(file.GetPath()))
  {
    Fail(file, "its size is out of range");
  }
  if (!isPlain)
  {
    auto image = MakeImage(width, height, 4, VTK_UNSIGNED_CHAR);
    if (!ReadShownTiff(tiff.get(), image))
    {
      Fail(file, tiffError);
    }
    return image;
  }
  auto image = MakeImage(width, height, components, type);
  if (TIFFScanlineSize64(tiff.get()) !=
    static_cast<std::uint64_t>(image->GetScalarSize()) * width *
      static_cast<std::uint64_t>(components))
  {
    Fail(file, "its rows are of another size than its pixels");
  }
  for (std::uint32_t row = 0; row < height; ++row)
  {
    if (TIFFReadScanline(tiff.get(), RowFromTop(image, static_cast<int>(row)), row, 0) != 1)
    {
      Fail(file, tiffError);
    }
  }
  return image;
}

void WritePnm(vtkImageData* image, const OutputFile& file)
{
  vtkDataArray* pixels = image->GetPointData()->GetScalars();
  const int components = pixels ? pixels->GetNumberOfComponents() : 0;
  if (!pixels || pixels->GetDataType() != VTK_UNSIGNED_CHAR || (components != 1 && components != 3))
  {
    throw Failure(REFUSED,
      "A ." + file.GetFormat() + " picture has one or three components of 8 bits, not " +
        std::to_string(components) + " of " + (pixels ? pixels->GetDataTypeAsString() : "none") +
        ": write a .png or .vti.");
  }
  const int* size = image->GetDimensions();
  std::string text = components == 1 ? "P5\n" : "P6\n";
  text += std::to_string(size[0]) + " " + std::to_string(size[1]) + "\n255\n";
  const auto rowSize = static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(components);
  const auto* bytes = static_cast<const char*>(pixels->GetVoidPointer(0));
  for (int row = size[1] - 1; row >= 0; --row)
  {
    text.append(bytes + rowSize * static_cast<std::size_t>(row), rowSize);
  }
  file.Write(text);
}

void WriteTiff(vtkImageData* image, const OutputFile& file)
{
  vtkDataArray* pixels = image->GetPointData()->GetScalars();
  const int components = pixels ? pixels->GetNumberOfComponents() : 0;
  const int type = pixels ? pixels->GetDataType() : 0;
  const bool isFloating = type == VTK_FLOAT || type == VTK_DOUBLE;
  const bool isSigned = type == VTK_SHORT || type == VTK_INT || type == VTK_SIGNED_CHAR;
  if (components < 1 || components > 4 ||
    !(isFloating || isSigned || type == VTK_UNSIGNED_CHAR || type == VTK_UNSIGNED_SHORT ||
      type == VTK_UNSIGNED_INT))
  {
    throw Failure(REFUSED,
      "A ." + file.GetFormat() + " picture cannot hold " + std::to_string(components) +
        " components of " + (pixels ? pixels->GetDataTypeAsString() : "none") + ": write a .vti.");
  }
  const int* size = image->GetDimensions();
  const auto width = static_cast<std::size_t>(size[0]);
  const auto height = static_cast<std::size_t>(size[1]);
  const std::size_t rowSize = width * static_cast<std::size_t>(components) *
    static_cast<std::size_t>(pixels->GetDataTypeSize());
  // Room for where the strips are: eight bytes for each, which has four thousand at least.
  constexpr std::size_t room = 16 << 20;
  if (rowSize * height > std::numeric_limits<std::uint32_t>::max() - room)
  {
    throw Failure(REFUSED, "A ." + file.GetFormat() + " picture is at most 4 GiB: write a .vti.");
  }
  KeepTiffMessages();
  const std::unique_ptr<TIFF, void (*)(TIFF*)> tiff(
    TIFFOpen(file.GetTemporaryName().c_str(), "w"), &TIFFClose);
  if (!tiff)
  {
    file.FailForWantOfRoom();
  }
  const auto set = [&tiff](std::uint32_t tag, auto value) { TIFFSetField(tiff.get(), tag, value); };
  set(TIFFTAG_IMAGEWIDTH, static_cast<std::uint32_t>(width));
  set(TIFFTAG_IMAGELENGTH, static_cast<std::uint32_t>(height));
  set(TIFFTAG_BITSPERSAMPLE, 8 * pixels->GetDataTypeSize());
  set(TIFFTAG_SAMPLESPERPIXEL, components);
  set(TIFFTAG_SAMPLEFORMAT,
    isFloating   ? SAMPLEFORMAT_IEEEFP
      : isSigned ? SAMPLEFORMAT_INT
                 : SAMPLEFORMAT_UINT);
  set(TIFFTAG_COMPRESSION, COMPRESSION_NONE);
  set(TIFFTAG_PHOTOMETRIC, components < 3 ? PHOTOMETRIC_MINISBLACK : PHOTOMETRIC_RGB);
  set(TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  if (components == 2 || components == 4)
  {
    const std::uint16_t opacity = EXTRASAMPLE_UNASSALPHA;
    TIFFSetField(tiff.get(), TIFFTAG_EXTRASAMPLES, 1, &opacity);
  }
  set(TIFFTAG_ROWSPERSTRIP, TIFFDefaultStripSize(tiff.get(), 0));
  for (int row = 0; row < size[1]; ++row)
  {
    if (TIFFWriteScanline(tiff.get(), RowFromTop(image, row), static_cast<std::uint32_t>(row), 0) !=
      1)
    {
      file.FailForWantOfRoom();
    }
  }
  // Closing the file would not tell whether all could be written.
  if (TIFFWriteDirectory(tiff.get()) != 1)
  {
    file.FailForWantOfRoom();
  }
}

} // namespace dhm
