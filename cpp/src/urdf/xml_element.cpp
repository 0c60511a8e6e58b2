// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>

#include "urdf/xml.hpp"

namespace iksel {
namespace {

void append_element(std::string& out, const XmlElement& element) {
  out += '<' + element.name;
  for (const auto& [name, value] : element.attributes) {
    out += ' ' + name + "=\"";
    out += escape_xml(value) + '"';
  }
  if (element.text.empty() && element.children.empty()) {
    out += "/>";
    return;
  }
  out += '>';
  out += escape_xml(element.text);
  for (const XmlElement& child : element.children) {
    append_element(out, child);
    out += escape_xml(child.tail);
  }
  out += "</" + element.name + '>';
}

}  // namespace

const std::string* XmlElement::attribute(std::string_view key) const {
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const auto& entry) { return entry.first == key; });
  return found == attributes.end() ? nullptr : &found->second;
}

std::string XmlElement::value(std::string_view key) const {
  const std::string* found = attribute(key);
  return found == nullptr ? "" : *found;
}

const XmlElement* XmlElement::child(std::string_view child_name) const {
  const auto found = std::find_if(children.begin(), children.end(),
                                  [&](const XmlElement& e) { return e.name == child_name; });
  return found == children.end() ? nullptr : &*found;
}

std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r' || c == '\t'; }, ' ');
  return text;
}

std::string escape_xml(const std::string& text) {
  std::string out;
  for (const char c : text) {
    out += c == '&'   ? "&amp;"
           : c == '<' ? "&lt;"
           : c == '>' ? "&gt;"
           : c == '"' ? "&quot;"
                      : std::string(1, c);
  }
  return out;
}

std::string write_xml(const XmlElement& root) {
  std::string text = "<?xml version=\"1.0\"?>\n";
  append_element(text, root);
  return text + "\n";
}

}  // namespace iksel
