// SPDX-License-Identifier: BSD-3-Clause
#include "keywords.hpp"

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
  for (std::size_t i = 0; i < count_; ++i) {
    if (std::strcmp(keywords_[i].keyword.name, name) == 0) return values_[i];
  }
  throw std::logic_error(std::string("no keyword ") + name);
}

void Given::read_into(void* out, const std::type_info& type, int dof, const char* except) const {
  for (std::size_t i = 0; i < count_; ++i) {
    const Keyword& keyword = keywords_[i].keyword;
    if (values_[i].ptr() == keywords_[i].by_default || *keyword.of != type) continue;
    if (std::strcmp(keyword.name, except) == 0) continue;
    keyword.type->set(static_cast<char*>(out) + keyword.offset, values_[i], keyword.name, dof);
  }
}

PyObject* intern(const char* name) { return PyUnicode_InternFromString(name); }

py::handle find_given(const py::args& poses, PyObject* pose_name, const py::kwargs& given,
                      const std::vector<MethodKeyword>& keywords, py::handle* values) {
  if (poses.size() > 1) throw py::reference_cast_error();
  py::handle pose = poses.empty() ? py::handle() : PyTuple_GET_ITEM(poses.ptr(), 0);
  const auto is = [](py::handle name, PyObject* other) {
    return name.ptr() == other || PyUnicode_Compare(name.ptr(), other) == 0;
  };
  for (const auto& [name, value] : given) {
    std::size_t i = 0;
    while (i < keywords.size() && name.ptr() != keywords[i].name) ++i;
    if (i == keywords.size()) {  // the pose, not interned, or unknown
      if (!pose && is(name, pose_name)) {
        pose = value;
        continue;
      }
      i = 0;
      while (i < keywords.size() && !is(name, keywords[i].name)) ++i;
    }
    if (i == keywords.size()) throw py::reference_cast_error();
    values[i] = value;
  }
  if (!pose) throw py::reference_cast_error();
  return pose;
}

std::vector<MethodKeyword> choose_keywords(const std::vector<Keyword>& known,
                                           const char* const* names, std::size_t count,
                                           std::vector<py::arg_v>& arguments) {
  std::vector<MethodKeyword> chosen;
  for (std::size_t i = 0; i < count; ++i) {
    for (const Keyword& keyword : known) {
      if (std::strcmp(keyword.name, names[i]) != 0) continue;
      const py::object value = keyword.type->shown(default_of(keyword));
      chosen.push_back({keyword, intern(keyword.name), value.ptr()});
      arguments.emplace_back(keyword.name, value);
    }
  }
  if (chosen.size() != count) throw std::logic_error("a keyword that no table, or two, have");
  return chosen;
}

std::string method_signature(const MethodText& text, const std::vector<MethodKeyword>& keywords,
                             std::size_t positional) {
  std::string signature =
      std::string("(self: iksel_cpp.Solver, ") + text.pose + ": numpy.typing.ArrayLike | object";
  for (std::size_t i = 0; i < keywords.size(); ++i) {
    if (i == positional) signature += ", *";
    const Keyword& keyword = keywords[i].keyword;
    const py::object value = keyword.type->shown(default_of(keyword));
    signature += std::string(", ") + keyword.name + ": " + keyword.type->text +
                 (value.is_none() ? " | None" : "") + " = " + repr_text(value);
  }
  return signature + ") -> iksel_cpp." + text.result;
}

std::string method_doc(const MethodText& text, const std::vector<MethodKeyword>& keywords) {
  std::string doc = std::string(text.summary) + "\n\nArgs:\n";
  doc += argument_doc(text.pose, text.pose_doc);
  for (const MethodKeyword& each : keywords) {
    doc += argument_doc(each.keyword.name, each.keyword.doc);
  }
  return doc + "\n" + text.rest;
}

}  // namespace iksel::python
