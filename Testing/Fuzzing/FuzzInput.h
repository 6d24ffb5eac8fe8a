// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file FuzzInput.h
/// Converts the bytes of a fuzzer to decisions and numbers.

#ifndef FuzzInput_h
#define FuzzInput_h

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>

namespace fuzz
{

/// Bytes, read in sequence; zeros after the last.
class Input
{
public:
  Input(const std::uint8_t* bytes, std::size_t size)
    : Next(bytes)
    , End(bytes + size)
  {
  }

  std::uint8_t Byte() { return this->Next < this->End ? *this->Next++ : 0; }
  int Below(int count) { return this->Byte() % count; }
  /// True once in @a count on average, and false after the end of the bytes.
  bool Chance(int count) { return this->Byte() % count == count - 1; }

  /// A coordinate: usually of a coarse grid, where triangles meet and coincide, sometimes any
  /// double.
  double Number()
  {
    const std::uint8_t code = this->Byte();
    if (code < 240)
    {
      return (code - 120) / 16.0;
    }
    if (code < 252)
    {
      // A neighbor of a number of the grid, or a far smaller or larger number.
      const double grid = (this->Byte() - 120) / 16.0;
      const int unsignedExponent = this->Byte();
      const int exponent = unsignedExponent < 128 ? unsignedExponent : unsignedExponent - 256;
      double power = 1.0;
      for (int i = 0; i < (exponent < 0 ? -exponent : exponent); ++i)
      {
        power *= exponent < 0 ? 0.5 : 2.0;
      }
      return code < 246 ? grid + power : grid * power;
    }
    switch (code)
    {
      case 252:
        return std::numeric_limits<double>::quiet_NaN();
      case 253:
        return std::numeric_limits<double>::infinity();
      default:
      {
        std::uint8_t bytes[8];
        for (std::uint8_t& byte : bytes)
        {
          byte = this->Byte();
        }
        double number;
        std::memcpy(&number, bytes, sizeof(number));
        return number;
      }
    }
  }

private:
  const std::uint8_t* Next;
  const std::uint8_t* End;
};

} // namespace fuzz

#endif
