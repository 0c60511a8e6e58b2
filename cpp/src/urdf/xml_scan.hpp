// SPDX-License-Identifier: BSD-3-Clause
// The tags of XML text, one after the other, as far as urdfdom's XML parser will get; for what has
// to be known before that parser sees the text.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace iksel {

struct XmlTag {
  std::string_view name;
  std::string_view attributes;  ///< all of them, as written
  std::size_t begin = 0;        ///< of the name
  int depth = 0;                ///< 1: the document's element
  bool opens = false;
  bool closes = false;  ///< with `opens`: an element without content

  /// Value of an attribute as written, entities and all.
  [[nodiscard]] std::optional<std::string_view> attribute(std::string_view key) const;
};

class XmlScanner {
 public:
  explicit XmlScanner(const std::string& xml) : xml_(xml) {}

  /// The next tag; false at the end of the text or of what is well-formed.
  bool next(XmlTag& tag);
  /// How many elements are open after what was read.
  [[nodiscard]] int depth() const { return depth_; }

 private:
  [[nodiscard]] std::size_t end_of_tag(std::size_t from) const;

  std::string_view xml_;
  std::size_t at_ = 0;
  int depth_ = 0;
};

}  // namespace iksel
