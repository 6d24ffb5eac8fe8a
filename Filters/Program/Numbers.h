// SPDX-FileCopyrightText: Copyright (c) The Differentiable Homeomorphism authors
// SPDX-License-Identifier: BSD-3-Clause

/// @file Numbers.h
/// Numbers as text, whatever the locale is, and back without loss.

#ifndef dhm_Numbers_h
#define dhm_Numbers_h

#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

namespace dhm
{

/// The shortest text that is read as the same number: whole numbers up to 2^53 as such, "nan" for
/// what is none.
inline std::string ToText(double value)
{
  if (std::isnan(value))
  {
    return "nan";
  }
  std::array<char, 400> text;
  // Plain notation where people expect it.
  const double size = std::abs(value);
  const auto format = size == 0.0 || (size >= 1e-5 && size < 1e16) ? std::chars_format::fixed
                                                                   : std::chars_format::general;
  const auto result = std::to_chars(text.data(), text.data() + text.size(), value, format);
  return { text.data(), result.ptr };
}

/// The number that a text says, blanks around it and a leading plus sign allowed; nothing if it
/// says none.
template <typename Number = double>
std::optional<Number> ToNumber(std::string_view text)
{
  constexpr std::string_view blanks = " \t\r";
  const std::size_t begin = text.find_first_not_of(blanks);
  if (begin == std::string_view::npos)
  {
    return {};
  }
  text = text.substr(begin, text.find_last_not_of(blanks) - begin + 1);
  if (text.front() == '+')
  {
    text.remove_prefix(1);
  }
  Number value{};
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc() || result.ptr != text.data() + text.size())
  {
    return {};
  }
  return value;
}

} // namespace dhm

#endif
