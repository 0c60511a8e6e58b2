// SPDX-License-Identifier: BSD-3-Clause
// Encodings of text files, and the characters that XML may hold.
#pragma once

#include <string>

namespace iksel {

/// Whether XML text may hold the character.
bool is_xml_character(char32_t c);

/// Appends the character to UTF-8 text.
void append_utf8(std::string& text, char32_t c);

/// The bytes of a file as UTF-8 text that XML may hold, without a byte order mark. They may be
/// UTF-8, UTF-16 or UTF-32; bytes that are none of these, as in authors' names, are taken for
/// Latin-1. Control characters become question marks.
std::string to_utf8(const std::string& bytes);

}  // namespace iksel
