// SPDX-License-Identifier: BSD-3-Clause
#include "keywords.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

namespace iksel::python {

namespace {

/// "    name: text", in lines of at most 100 columns; a sentence's first word begins small.
std::string argument_doc(const char* name, std::string text) {
  constexpr std::size_t kWidth = 100;
  std::string lines;
  std::string line = std::string("    ") + name + ":";
  if (std::islower(text[1]) != 0 || text[1] == ' ')
    text[0] = static_cast<char>(std::tolower(text[0]));
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
    const auto& [field, by_default, of] = keywords_[i];
    if (std::strcmp(field.name, name) == 0) return is_empty() ? py::handle(by_default) : values_[i];
  }
  throw std::logic_error(std::string("no keyword ") + name);
}

void Given::read_into(void* out, const std::type_info& type, int dof, const char* except) const {
  for (std::size_t i = 0; i < keywords_.size() && !is_empty(); ++i) {
    const auto& [field, by_default, of] = keywords_[i];
    if (values_[i].ptr() == by_default.ptr() || *of != type) continue;
    if (std::strcmp(field.name, except) == 0) continue;
    field.type->set(field.of(out), values_[i], field.name, dof);
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
      return std::strcmp(each.field.name, name) == 0;
    });
    if (keyword == known.end()) throw std::logic_error(std::string("no keyword ") + name);
    const py::object& value = keyword->by_default;
    const std::string& type = keyword->field.type->argument;
    function.parameters.push_back(
        new_parameter(name, value.is_none() ? or_none(type) : type, value));
    keywords.push_back(*keyword);
    doc += argument_doc(name, keyword->field.doc);
  }
  if (function.parameters.size() > kMostArguments) throw std::logic_error("too many keywords");
  function.doc = docstring(function, "Solver", result, doc + "\n" + text.rest);
}

}  // namespace iksel::python
