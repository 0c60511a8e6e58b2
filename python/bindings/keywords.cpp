// SPDX-License-Identifier: BSD-3-Clause
#include "keywords.hpp"

#include <algorithm>
#include <cstring>
#include <sstream>
#include <stdexcept>

namespace iksel::python {

namespace {

const void* default_of(const Keyword& keyword) {
  return static_cast<const char*>(keyword.defaults) + keyword.offset;
}

/// "    name: text", in lines of at most 100 columns.
std::string argument_doc(const char* name, const char* text) {
  constexpr std::size_t kWidth = 100;
  std::string lines;
  std::string line = std::string("    ") + name + ":";
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    if (line.size() + 1 + word.size() > kWidth) {
      lines += line + "\n";
      line = std::string(7, ' ');
    }
    line += " " + word;
  }
  return lines + line + "\n";
}

}  // namespace

py::handle Given::operator[](const char* name) const {
  for (std::size_t i = 0; i < keywords_.size(); ++i) {
    if (std::strcmp(keywords_[i].name, name) == 0) return values_[i];
  }
  throw std::logic_error(std::string("no keyword ") + name);
}

void Given::read_into(void* out, const std::type_info& type, int dof, const char* except) const {
  for (std::size_t i = 0; i < keywords_.size(); ++i) {
    const Keyword& keyword = keywords_[i];
    if (values_[i].ptr() == parameters_[i + 1].by_default.ptr() || *keyword.of != type) continue;
    if (std::strcmp(keyword.name, except) == 0) continue;
    keyword.type->set(static_cast<char*>(out) + keyword.offset, values_[i], keyword.name, dof);
  }
}

void KeywordMethod::describe(const MethodText& text, const std::string& result,
                             const std::vector<Keyword>& known,
                             const std::vector<const char*>& names, std::size_t positional) {
  function.name = text.name;
  function.owner = "Solver";
  function.positional = 1 + positional;
  function.parameters.push_back(new_parameter(text.pose, "numpy.typing.ArrayLike | object", {}));
  std::string doc = std::string(text.summary) + "\n\nArgs:\n";
  doc += argument_doc(text.pose, text.pose_doc);
  for (const char* name : names) {
    const auto keyword = std::find_if(known.begin(), known.end(), [&](const Keyword& each) {
      return std::strcmp(each.name, name) == 0;
    });
    if (keyword == known.end()) throw std::logic_error(std::string("no keyword ") + name);
    const py::object value = keyword->type->shown(default_of(*keyword));
    const std::string type = keyword->type->text + (value.is_none() ? " | None" : "");
    function.parameters.push_back(new_parameter(name, type, value));
    keywords.push_back(*keyword);
    doc += argument_doc(name, keyword->doc);
  }
  if (function.parameters.size() > kMostArguments) throw std::logic_error("too many keywords");
  function.doc = docstring(function, "Solver", result, doc + "\n" + text.rest);
}

}  // namespace iksel::python
