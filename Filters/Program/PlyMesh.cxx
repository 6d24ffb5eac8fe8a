// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

#include "PlyMesh.h"

#include "Failure.h"
#include "LineReader.h"
#include "WordReader.h"

#include "vtkCellArray.h"
#include "vtkNew.h"
#include "vtkPoints.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <istream>
#include <memory>
#include <optional>
#include <vector>

namespace dhm
{
namespace
{

enum class Type
{
  Int8,
  UInt8,
  Int16,
  UInt16,
  Int32,
  UInt32,
  Float32,
  Float64
};

struct TypeName
{
  const char* Name;
  Type What;
};

constexpr std::array<TypeName, 16> typeNames{ { { "char", Type::Int8 }, { "int8", Type::Int8 },
  { "uchar", Type::UInt8 }, { "uint8", Type::UInt8 }, { "short", Type::Int16 },
  { "int16", Type::Int16 }, { "ushort", Type::UInt16 }, { "uint16", Type::UInt16 },
  { "int", Type::Int32 }, { "int32", Type::Int32 }, { "uint", Type::UInt32 },
  { "uint32", Type::UInt32 }, { "float", Type::Float32 }, { "float32", Type::Float32 },
  { "double", Type::Float64 }, { "float64", Type::Float64 } } };

struct Property
{
  std::string Name;
  Type What = Type::Float32;
  /// Of lists, the type of their length.
  std::optional<Type> Length;
};

struct Element
{
  std::string Name;
  std::int64_t Count = 0;
  std::vector<Property> Properties;
};

/// The values after the header, one after the other.
class Values
{
public:
  virtual ~Values() = default;
  /// Throws Failure, saying that this was to be @a what.
  virtual double Next(Type type, const std::string& what) = 0;
};

class TextValues : public Values
{
public:
  TextValues(std::istream& file, const std::string& fileName, int line)
    : Words(file, fileName, line)
  {
  }

  double Next(Type, const std::string& what) override { return this->Words.RequireNumber(what); }

private:
  WordReader Words;
};

class BinaryValues : public Values
{
public:
  BinaryValues(std::istream& file, std::string fileName, bool bigEndian)
    : File(file)
    , FileName(std::move(fileName))
    , BigEndian(bigEndian)
  {
  }

  double Next(Type type, const std::string& what) override
  {
    switch (type)
    {
      case Type::Int8:
        return static_cast<double>(static_cast<std::int8_t>(this->Bits(1, what)));
      case Type::UInt8:
        return static_cast<double>(this->Bits(1, what));
      case Type::Int16:
        return static_cast<double>(static_cast<std::int16_t>(this->Bits(2, what)));
      case Type::UInt16:
        return static_cast<double>(this->Bits(2, what));
      case Type::Int32:
        return static_cast<double>(static_cast<std::int32_t>(this->Bits(4, what)));
      case Type::UInt32:
        return static_cast<double>(this->Bits(4, what));
      case Type::Float32:
      {
        const auto bits = static_cast<std::uint32_t>(this->Bits(4, what));
        float value;
        std::memcpy(&value, &bits, sizeof value);
        return static_cast<double>(value);
      }
      case Type::Float64:
      {
        const std::uint64_t bits = this->Bits(8, what);
        double value;
        std::memcpy(&value, &bits, sizeof value);
        return value;
      }
    }
    return 0.0;
  }

private:
  std::uint64_t Bits(int size, const std::string& what)
  {
    std::array<char, 8> bytes;
    if (!this->File.read(bytes.data(), size))
    {
      throw Failure(FILE_TROUBLE,
        this->FileName + " ends where " + what + " is expected: it has been cut off.");
    }
    std::uint64_t bits = 0;
    for (int k = 0; k < size; ++k)
    {
      const char byte = bytes[static_cast<std::size_t>(this->BigEndian ? k : size - 1 - k)];
      bits = bits << 8 | static_cast<unsigned char>(byte);
    }
    return bits;
  }

  std::istream& File;
  std::string FileName;
  bool BigEndian;
};

class PlyReader
{
public:
  PlyReader(std::istream& file, std::string fileName)
    : File(file)
    , FileName(std::move(fileName))
    , Header(file, this->FileName, "")
  {
  }

  vtkSmartPointer<vtkPolyData> Read()
  {
    this->ReadHeader();
    this->Points->SetDataTypeToDouble();
    for (const Element& element : this->Elements)
    {
      // What has no properties takes no bytes, however many there are.
      for (std::int64_t i = element.Properties.empty() ? element.Count : 0; i < element.Count; ++i)
      {
        this->ReadElement(element, i);
      }
    }
    if (this->Points->GetNumberOfPoints() == 0)
    {
      throw Failure(FILE_TROUBLE, this->FileName + " has no points.");
    }
    auto mesh = vtkSmartPointer<vtkPolyData>::New();
    mesh->SetPoints(this->Points);
    mesh->SetPolys(this->Faces);
    return mesh;
  }

private:
  Type ToType(const std::string& word) const
  {
    const auto found = std::find_if(typeNames.begin(), typeNames.end(),
      [&word](const TypeName& type) { return type.Name == word; });
    if (found == typeNames.end())
    {
      this->Header.Fail("a type (char to double) instead of \"" + word + "\"");
    }
    return found->What;
  }

  /// The words of the header's next line that is no comment.
  const std::vector<std::string>& NextLine(const std::string& expected)
  {
    do
    {
      this->Header.Require(expected);
    } while (this->Header.Words[0] == "comment" || this->Header.Words[0] == "obj_info");
    return this->Header.Words;
  }

  void ReadHeader()
  {
    const std::string magic = "\"ply\", the first line of a PLY mesh";
    if (this->NextLine(magic)[0] != "ply")
    {
      this->Header.Fail(magic);
    }
    const std::string formats =
      "\"format ascii 1.0\", or binary_little_endian or binary_big_endian";
    const std::vector<std::string>& format = this->NextLine(formats);
    const std::string encoding =
      format.size() == 3 && format[0] == "format" ? format[1] : std::string();
    const bool bigEndian = encoding == "binary_big_endian";
    const bool text = encoding == "ascii";
    if (!bigEndian && !text && encoding != "binary_little_endian")
    {
      this->Header.Fail(formats);
    }
    const std::string more = "an element, a property or end_header";
    for (auto words = this->NextLine(more); words[0] != "end_header"; words = this->NextLine(more))
    {
      if (words[0] == "element" && words.size() == 3)
      {
        const auto count = ToNumber<std::int64_t>(words[2]);
        if (!count || *count < 0)
        {
          this->Header.Fail("a number of elements instead of \"" + words[2] + "\"");
        }
        this->Elements.push_back({ words[1], *count, {} });
      }
      else if (words[0] == "property" && !this->Elements.empty() && words.size() == 3)
      {
        this->Elements.back().Properties.push_back({ words[2], this->ToType(words[1]), {} });
      }
      else if (words[0] == "property" && !this->Elements.empty() && words.size() == 5 &&
        words[1] == "list")
      {
        this->Elements.back().Properties.push_back(
          { words[4], this->ToType(words[3]), this->ToType(words[2]) });
      }
      else
      {
        this->Header.Fail(more);
      }
    }
    if (text)
    {
      this->Content =
        std::make_unique<TextValues>(this->File, this->FileName, this->Header.GetNumber() + 1);
    }
    else
    {
      this->Content = std::make_unique<BinaryValues>(this->File, this->FileName, bigEndian);
    }
  }

  void ReadElement(const Element& element, std::int64_t index)
  {
    const std::string name =
      element.Name + " " + std::to_string(index) + " of " + std::to_string(element.Count);
    const bool isPoint = element.Name == "vertex";
    double point[3] = { 0.0, 0.0, 0.0 };
    int found = 0;
    for (const Property& property : element.Properties)
    {
      const std::string what = "\"" + property.Name + "\" of " + name;
      if (!property.Length)
      {
        const double value = this->Content->Next(property.What, what);
        if (isPoint && property.Name.size() == 1 && property.Name[0] >= 'x' &&
          property.Name[0] <= 'z')
        {
          point[property.Name[0] - 'x'] = value;
          found |= 1 << (property.Name[0] - 'x');
        }
        continue;
      }
      const double length = this->Content->Next(*property.Length, what);
      if (!(length >= 0.0 && length < 1e9) || length != std::floor(length))
      {
        throw Failure(FILE_TROUBLE,
          this->FileName + ": " + what + ": expected a number of values, found " + ToText(length) +
            ".");
      }
      const auto count = static_cast<std::int64_t>(length);
      const bool isFace = element.Name == "face" &&
        (property.Name == "vertex_indices" || property.Name == "vertex_index");
      if (isFace)
      {
        this->Faces->InsertNextCell(0);
      }
      for (std::int64_t k = 0; k < count; ++k)
      {
        const double value = this->Content->Next(property.What, what);
        if (!isFace)
        {
          continue;
        }
        const vtkIdType points = this->Points->GetNumberOfPoints();
        if (!(value >= 0.0 && value < static_cast<double>(points)) || value != std::floor(value))
        {
          throw Failure(FILE_TROUBLE,
            this->FileName + ": " + what + ": expected numbers of points, 0 to " +
              std::to_string(points - 1) + ", found " + ToText(value) + ".");
        }
        this->Faces->InsertCellPoint(static_cast<vtkIdType>(value));
      }
      if (isFace)
      {
        this->Faces->UpdateCellCount(static_cast<int>(count));
      }
    }
    if (isPoint)
    {
      if ((found & 3) != 3)
      {
        throw Failure(FILE_TROUBLE, this->FileName + ": vertices have no properties x and y.");
      }
      this->Points->InsertNextPoint(point);
    }
  }

  std::istream& File;
  std::string FileName;
  LineReader Header;
  std::vector<Element> Elements;
  std::unique_ptr<Values> Content;
  vtkNew<vtkPoints> Points;
  vtkNew<vtkCellArray> Faces;
};

} // namespace

vtkSmartPointer<vtkPolyData> ReadPly(std::istream& file, const std::string& fileName)
{
  return PlyReader(file, fileName).Read();
}

} // namespace dhm
