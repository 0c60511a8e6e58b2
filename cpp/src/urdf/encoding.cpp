// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "urdf/xml.hpp"

namespace iksel {
namespace {

using namespace std::string_view_literals;

struct Encoding {
  std::string_view start;  ///< of a file
  std::size_t mark;        ///< bytes of the start that are no text
  std::size_t width;       ///< bytes of a unit
  bool big_endian;
};

/// By the byte order mark, or else by how the first character is written, which a '<' stands for.
/// The longer ones come first.
constexpr Encoding kEncodings[] = {
    {"\xFF\xFE\0\0"sv, 4, 4, false}, {"\0\0\xFE\xFF"sv, 4, 4, true},
    {"\xFF\xFE"sv, 2, 2, false},     {"\xFE\xFF"sv, 2, 2, true},
    {"<\0\0\0"sv, 0, 4, false},      {"\0\0\0<"sv, 0, 4, true},
    {"<\0"sv, 0, 2, false},          {"\0<"sv, 0, 2, true},
    {"\xEF\xBB\xBF"sv, 3, 1, true},  {""sv, 0, 1, true},
};

bool starts_as(const std::string& bytes, std::string_view start) {
  const auto is_like = [](char c, char byte) {
    return c == byte || (c == '<' && static_cast<signed char>(byte) > 0);
  };
  return bytes.size() >= start.size() &&
         std::equal(start.begin(), start.end(), bytes.begin(), is_like);
}

std::uint8_t byte_at(const std::string& text, std::size_t at) {
  return at < text.size() ? static_cast<std::uint8_t>(text[at]) : 0;
}

/// The character whose UTF-8 sequence begins at `at`, which is moved behind it. A byte that begins
/// none is a character of Latin-1.
char32_t next_character(const std::string& text, std::size_t& at) {
  const std::uint8_t lead = byte_at(text, at++);
  if (lead < 0xC2 || lead > 0xF4) return lead;
  const std::size_t more = lead < 0xE0 ? 1 : lead < 0xF0 ? 2 : 3;
  char32_t c = lead & (0x3FU >> more);
  for (std::size_t i = 0; i < more; ++i) {
    const std::uint8_t byte = byte_at(text, at + i);
    if (byte < 0x80 || byte > 0xBF) return lead;
    c = c << 6U | (byte & 0x3FU);
  }
  constexpr char32_t kLeast[] = {0x80, 0x800, 0x10000};  // shorter ones have one spelling
  if (c < kLeast[more - 1] || !is_xml_character(c)) return lead;
  at += more;
  return c;
}

char32_t next_unit(const std::string& bytes, const Encoding& encoding, std::size_t& at) {
  char32_t unit = 0;
  for (std::size_t i = 0; i < encoding.width; ++i) {
    const std::size_t place = encoding.big_endian ? i : encoding.width - 1 - i;
    unit = unit << 8U | byte_at(bytes, at + place);
  }
  at += encoding.width;
  return unit;
}

/// Two halves of a surrogate pair are one character.
char32_t next_wide_character(const std::string& bytes, const Encoding& encoding, std::size_t& at) {
  const char32_t unit = next_unit(bytes, encoding, at);
  if (encoding.width != 2 || unit < 0xD800 || unit > 0xDBFF) return unit;
  std::size_t behind = at;
  const char32_t low = next_unit(bytes, encoding, behind);
  if (low < 0xDC00 || low > 0xDFFF) return unit;
  at = behind;
  return 0x10000 + ((unit - 0xD800) << 10U) + (low - 0xDC00);
}

}  // namespace

bool is_xml_character(char32_t c) {
  if (c < 0x20) return c == '\t' || c == '\n' || c == '\r';
  return c < 0xD800 || (c > 0xDFFF && c < 0xFFFE) || (c > 0xFFFF && c <= 0x10FFFF);
}

void append_utf8(std::string& text, char32_t c) {
  const unsigned more = c < 0x80 ? 0 : c < 0x800 ? 1 : c < 0x10000 ? 2 : 3;
  // The first byte begins with as many ones as there are bytes, but for a single one.
  const unsigned ones = more == 0 ? 0 : 0xFF00U >> (more + 1);
  text += static_cast<char>(ones | c >> 6 * more);
  for (unsigned i = more; i-- > 0;) text += static_cast<char>(0x80U | (c >> 6 * i & 0x3FU));
}

std::string to_utf8(const std::string& bytes) {
  const Encoding& encoding =
      *std::find_if(std::begin(kEncodings), std::end(kEncodings),
                    [&](const Encoding& e) { return starts_as(bytes, e.start); });
  std::string text;
  text.reserve(bytes.size() / encoding.width);
  for (std::size_t at = encoding.mark; at < bytes.size();) {
    const char32_t c =
        encoding.width == 1 ? next_character(bytes, at) : next_wide_character(bytes, encoding, at);
    append_utf8(text, is_xml_character(c) ? c : U'?');
  }
  return text;
}

}  // namespace iksel
