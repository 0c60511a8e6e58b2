// SPDX-License-Identifier: BSD-3-Clause
// XML of robot files: read in spite of the faults that people and exporters make, and written so
// that every XML reader takes it.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace iksel {

struct XmlElement {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes;  ///< names and values
  std::string text;                                             ///< up to the first child
  std::vector<XmlElement> children;
  std::string tail;  ///< text behind the element, in its parent

  /// Value of an attribute; null where there is none.
  [[nodiscard]] const std::string* attribute(std::string_view key) const;
  /// The same; empty where there is none.
  [[nodiscard]] std::string value(std::string_view key) const;
  /// The first child of a name; null where there is none.
  [[nodiscard]] const XmlElement* child(std::string_view child_name) const;
};

/// Reads the bytes of an XML file, with what mend_xml (iksel/urdf_text.hpp) mends and leaves out.
/// Tabs and line breaks in values are spaces.
///
/// Throws UrdfError, which begins with the line, where tags are not closed, values have no quotes
/// or anything else leaves open what is meant, and for text that would take all memory.
/// The name of the first element is written to `root_name`, also where it throws later.
XmlElement parse_xml(const std::string& bytes, std::string* root_name = nullptr);

/// Spaces in the place of tabs and line breaks.
std::string one_line(std::string text);

/// Text as it stands in an element or an attribute.
std::string escape_xml(const std::string& text);

/// Text of the document, in UTF-8.
std::string write_xml(const XmlElement& root);

/// Whether XML text may hold the character.
bool is_xml_character(char32_t c);

/// Appends the character to UTF-8 text.
void append_utf8(std::string& text, char32_t c);

/// The bytes of a file as UTF-8 text that XML may hold, without a byte order mark. They may be
/// UTF-8, UTF-16 or UTF-32; bytes that are none of these, as in authors' names, are taken for
/// Latin-1. Control characters become question marks.
std::string to_utf8(const std::string& bytes);

}  // namespace iksel
