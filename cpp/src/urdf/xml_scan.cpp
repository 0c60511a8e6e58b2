// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/xml_scan.hpp"

namespace iksel {
namespace {

constexpr std::string_view kSpaces = " \t\r\n";
constexpr std::size_t kNowhere = std::string_view::npos;

bool starts_with(std::string_view text, std::size_t at, std::string_view start) {
  return text.compare(at, start.size(), start) == 0;
}

}  // namespace

std::optional<std::string_view> XmlTag::attribute(std::string_view key) const {
  std::size_t at = 0;
  while ((at = attributes.find_first_not_of(kSpaces, at)) != kNowhere) {
    const std::size_t equals = attributes.find('=', at);
    if (equals == kNowhere) break;
    std::string_view found = attributes.substr(at, equals - at);
    found = found.substr(0, found.find_last_not_of(kSpaces) + 1);
    const std::size_t quote = attributes.find_first_not_of(kSpaces, equals + 1);
    if (quote == kNowhere) break;
    const std::size_t close = attributes.find(attributes[quote], quote + 1);
    if (close == kNowhere) break;
    if (found == key) return attributes.substr(quote + 1, close - quote - 1);
    at = close + 1;
  }
  return std::nullopt;
}

bool XmlScanner::next(XmlTag& tag) {
  while ((at_ = xml_.find('<', at_)) != kNowhere) {
    if (starts_with(xml_, at_, "<!--") || starts_with(xml_, at_, "<![CDATA[")) {
      at_ = xml_.find(xml_[at_ + 2] == '-' ? "-->" : "]]>", at_);
    } else if (starts_with(xml_, at_, "<!") || starts_with(xml_, at_, "<?")) {
      ++at_;
    } else {
      break;
    }
  }
  if (at_ == kNowhere) return false;
  const bool only_closes = starts_with(xml_, at_, "</");
  tag.begin = at_ + (only_closes ? 2 : 1);
  const std::size_t last = end_of_tag(tag.begin);
  at_ = last == kNowhere ? last : last + 1;
  std::string_view inside = xml_.substr(tag.begin, last == kNowhere ? last : last - tag.begin);
  tag.opens = !only_closes;
  tag.closes = only_closes || (!inside.empty() && inside.back() == '/');
  if (tag.opens && tag.closes) inside.remove_suffix(1);
  tag.name = inside.substr(0, inside.find_first_of(kSpaces));
  tag.attributes = inside.substr(tag.name.size());
  tag.depth = only_closes ? depth_ : depth_ + 1;
  depth_ = tag.closes ? tag.depth - 1 : tag.depth;
  return true;
}

/// The '>' that ends a tag, which may also stand inside the quotes of an attribute.
std::size_t XmlScanner::end_of_tag(std::size_t from) const {
  for (std::size_t i = from; (i = xml_.find_first_of("\"'>", i)) != kNowhere; ++i) {
    if (xml_[i] == '>') return i;
    i = xml_.find(xml_[i], i + 1);
    if (i == kNowhere) break;
  }
  return kNowhere;
}

}  // namespace iksel
