// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/xml.hpp"

#include <algorithm>
#include <cstddef>
#include <map>
#include <optional>
#include <set>

#include "iksel/error.hpp"

namespace iksel {
namespace {

bool begins_name(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_' || c == ':' ||
         static_cast<unsigned char>(c) >= 0x80;
}

bool is_in_name(char c) { return begins_name(c) || (c >= '0' && c <= '9') || c == '-' || c == '.'; }

/// The character that the inside of an entity stands for, as "lt" or "#x41".
std::optional<char32_t> entity(std::string_view inside) {
  constexpr std::pair<std::string_view, char32_t> kEntities[] = {
      {"lt", U'<'}, {"gt", U'>'}, {"amp", U'&'}, {"quot", U'"'}, {"apos", U'\''}};
  for (const auto& [name, c] : kEntities) {
    if (name == inside) return c;
  }
  if (inside.substr(0, 1) != "#") return std::nullopt;
  const bool is_hex = inside.substr(1, 1) == "x";
  const std::string digits(inside.substr(is_hex ? 2 : 1));
  const char* known = is_hex ? "0123456789abcdefABCDEF" : "0123456789";
  if (digits.empty() || digits.find_first_not_of(known) != std::string::npos) return std::nullopt;
  const auto c = static_cast<char32_t>(std::stoul(digits, nullptr, is_hex ? 16 : 10));
  return is_xml_character(c) ? std::optional(c) : std::nullopt;
}

std::string resolve_entities(std::string_view raw) {
  std::string text;
  for (std::size_t at = 0; at < raw.size();) {
    // The longest is as &#x10FFFF;
    const std::size_t end =
        raw[at] == '&' ? raw.substr(0, at + 10).find(';', at) : std::string::npos;
    const auto c =
        end == std::string::npos ? std::nullopt : entity(raw.substr(at + 1, end - at - 1));
    if (c) {
      append_utf8(text, *c);
      at = end + 1;
    } else {
      text += raw[at++];
    }
  }
  return text;
}

/// A robot needs half a dozen levels and some thousand elements; text made to be more, which would
/// end the stack or the memory, is refused.
class XmlReader {
 public:
  XmlReader(const std::string& bytes, std::string* root_name)
      : text_(to_utf8(bytes)), root_name_(root_name) {}

  XmlElement read_document() {
    skip_text();
    if (at_ >= text_.size()) throw UrdfError("there is no XML element in it");
    const std::size_t begin = at_;
    XmlElement root = read_element();
    skip_text();
    if (at_ < text_.size()) {
      fail(at_, "a tag behind the end of <" + root.name + ">, which begins in line " +
                    std::to_string(line_of(begin)));
    }
    bind_prefixes(root);
    return root;
  }

 private:
  [[nodiscard]] std::size_t line_of(std::size_t place) const {
    return 1 + static_cast<std::size_t>(std::count(
                   text_.begin(), text_.begin() + static_cast<std::ptrdiff_t>(place), '\n'));
  }

  [[noreturn]] void fail(std::size_t place, const std::string& what) const {
    throw UrdfError("line " + std::to_string(line_of(place)) + ": " + what);
  }

  [[nodiscard]] bool is_at(char c) const { return at_ < text_.size() && text_[at_] == c; }
  [[nodiscard]] bool is_at(std::string_view start) const {
    return text_.compare(at_, start.size(), start) == 0;
  }

  bool take(std::string_view start) {
    if (!is_at(start)) return false;
    at_ += start.size();
    return true;
  }

  void skip_spaces() { at_ = std::min(text_.find_first_not_of(" \t\r\n", at_), text_.size()); }

  /// Behind the next `end`.
  void skip_behind(std::string_view end, const char* what) {
    const std::size_t found = text_.find(end, at_);
    if (found == std::string::npos) fail(at_, std::string(what) + " that nothing closes");
    at_ = found + end.size();
  }

  /// Behind <!DOCTYPE ...>, whose own declarations stand in brackets.
  void skip_declaration() {
    const std::size_t begin = at_;
    for (int open = 0; at_ < text_.size(); ++at_) {
      const char c = text_[at_];
      if (is_at("<!--")) {
        skip_behind("-->", "a comment");
        --at_;
      } else if (c == '"' || c == '\'') {
        at_ = std::min(text_.find(c, at_ + 1), text_.size());
      } else if (c == '[' || c == ']') {
        open += c == '[' ? 1 : -1;
      } else if (c == '>' && open <= 0) {
        ++at_;
        return;
      }
    }
    fail(begin, "a <!DOCTYPE that nothing closes");
  }

  /// The text up to the next tag, and at the tag, or at the end.
  std::string read_text() {
    std::string text;
    while (at_ < text_.size()) {
      const std::size_t begin = at_;
      at_ = std::min(text_.find('<', at_), text_.size());
      text += resolve_entities(std::string_view(text_).substr(begin, at_ - begin));
      if (is_at("<!--")) {
        skip_behind("-->", "a comment");
      } else if (is_at("<?")) {
        skip_behind("?>", "a <?");
      } else if (is_at("<![CDATA[")) {
        const std::size_t inside = at_ + 9;
        skip_behind("]]>", "a <![CDATA[");
        text.append(text_, inside, at_ - 3 - inside);
      } else if (is_at("<!")) {
        skip_declaration();
      } else if (is_at("</") || (at_ + 1 < text_.size() && begins_name(text_[at_ + 1]))) {
        break;
      } else if (at_ < text_.size()) {
        text += text_[at_++];  // a < that begins no tag
      }
    }
    return text;
  }

  void skip_text() { (void)read_text(); }

  /// The name behind a '<' or in the place of an attribute; with letters that are not ASCII, and
  /// colons that part no prefix from a name, as underscores.
  std::string read_name() {
    if (is_at('<')) ++at_;
    const std::size_t begin = at_;
    if (at_ >= text_.size() || !begins_name(text_[at_]))
      fail(at_, "the name of an attribute is expected");
    while (at_ < text_.size() && is_in_name(text_[at_])) ++at_;
    std::string name = text_.substr(begin, at_ - begin);
    const std::size_t colon = name.find(':');
    const bool has_prefix = colon != std::string::npos && colon != 0 && colon + 1 < name.size() &&
                            begins_name(name[colon + 1]) &&
                            name.find(':', colon + 1) == std::string::npos;
    for (std::size_t i = 0; i < name.size(); ++i) {
      const bool is_odd = static_cast<unsigned char>(name[i]) >= 0x80;
      if (is_odd || (name[i] == ':' && !(has_prefix && i == colon))) name[i] = '_';
    }
    if (has_prefix) note_prefix(name.substr(0, colon));
    return name;
  }

  void read_attribute(XmlElement& element) {
    const std::size_t begin = at_;
    const std::string name = read_name();
    const auto refuse = [&](const std::string& what) {
      const bool is_cut = text_.find('<', begin) == std::string::npos &&
                          text_.find('>', begin) == std::string::npos;
      fail(begin, is_cut ? "the text ends, as if it was cut off, in attribute '" + name + "'"
                         : "the value of attribute '" + name + "' " + what);
    };
    skip_spaces();
    if (!take("=")) refuse("is missing: write " + name + "=\"...\"");
    skip_spaces();
    if (!is_at('"') && !is_at('\'')) refuse("has no quotes: write " + name + "=\"...\"");
    const char quote = text_[at_++];
    const std::size_t end = text_.find_first_of(std::string{quote, '<'}, at_);
    if (end == std::string::npos || text_[end] != quote) {
      refuse("has no closing quote (a < in it is written &lt;)");
    }
    const std::string value =
        one_line(resolve_entities(std::string_view(text_).substr(at_, end - at_)));
    at_ = end + 1;
    if (name == "xmlns") return;
    if (name.compare(0, 6, "xmlns:") == 0) return note_prefix(name.substr(6), value);
    if (element.attribute(name) != nullptr) fail(begin, "a second attribute '" + name + "'");
    if (element.attributes.size() == 1000) fail(begin, "more than 1000 attributes");
    element.attributes.emplace_back(name, value);
  }

  /// The element that begins here, and what is in it.
  XmlElement read_element() {
    const std::size_t begin = at_;
    if (is_at("</")) fail(begin, "a closing tag, and nothing is open");
    XmlElement element;
    element.name = read_name();
    if (elements_ == 0 && root_name_ != nullptr) *root_name_ = element.name;
    if (element.name.compare(0, 6, "xmlns:") == 0) element.name[5] = '_';
    if (++elements_ > 1'000'000) fail(begin, "more than a million elements");
    while (true) {
      skip_spaces();
      if (take("/>")) return element;
      if (take(">")) break;
      if (at_ >= text_.size()) fail_at_end(element.name, begin);
      read_attribute(element);
    }
    if (++depth_ > 200) fail(begin, "elements are nested deeper than 200 levels");
    for (element.text = read_text(); !is_at("</"); element.children.back().tail = read_text()) {
      if (at_ >= text_.size()) fail_at_end(element.name, begin);
      element.children.push_back(read_element());
    }
    close(element.name, begin);
    --depth_;
    return element;
  }

  [[noreturn]] void fail_at_end(const std::string& name, std::size_t begin) const {
    fail(at_, "the text ends, as if it was cut off, before <" + name + "> of line " +
                  std::to_string(line_of(begin)) + " does");
  }

  void close(const std::string& name, std::size_t begin) {
    const std::size_t end = at_;
    at_ += 2;
    const std::string closing = at_ < text_.size() && begins_name(text_[at_]) ? read_name() : "";
    skip_spaces();
    if (closing == name && take(">")) return;
    fail(end, "</" + closing + "> where <" + name + "> of line " + std::to_string(line_of(begin)) +
                  " is to be closed");
  }

  /// A prefix is bound by the first name that is given to it anywhere.
  void note_prefix(const std::string& prefix, const std::string& space = "") {
    if (prefix == "xml" || prefix == "xmlns") return;
    std::string& known = prefixes_[prefix];
    if (known.empty()) known = space;
  }

  /// Declares all prefixes at the root: by the name that the text has for them, or by themselves.
  void bind_prefixes(XmlElement& root) const {
    const auto is_plain = [](char c) { return is_in_name(c) || c == '/' || c == '#'; };
    std::set<std::string> taken = {"http://www.w3.org/XML/1998/namespace",
                                   "http://www.w3.org/2000/xmlns/"};
    for (const auto& [prefix, space] : prefixes_) {
      // With a colon it is no other prefix.
      const bool is_kept = space.find(':') != std::string::npos &&
                           std::all_of(space.begin(), space.end(), is_plain) &&
                           taken.insert(space).second;
      root.attributes.emplace_back("xmlns:" + prefix, is_kept ? space : prefix);
    }
  }

  const std::string text_;
  std::string* root_name_;
  std::size_t at_ = 0;
  int depth_ = 0;
  std::size_t elements_ = 0;
  std::map<std::string, std::string> prefixes_;  ///< and the names that they stand for, if any
};

}  // namespace

XmlElement parse_xml(const std::string& bytes, std::string* root_name) {
  return XmlReader(bytes, root_name).read_document();
}

}  // namespace iksel
