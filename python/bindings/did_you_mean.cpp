// SPDX-License-Identifier: BSD-3-Clause
#include "did_you_mean.hpp"

#include <pybind11/stl.h>

namespace iksel::python {

namespace py = pybind11;

std::string did_you_mean(const std::string& name, const std::vector<std::string>& known) {
  std::vector<std::string> close;
  // Of tip_link the word tip; two letters are too few to tell.
  for (const std::string& one : name.size() > 2 ? known : std::vector<std::string>()) {
    if (("_" + one).find("_" + name) != std::string::npos) close.push_back(one);
  }
  if (close.empty()) {
    close = py::cast<std::vector<std::string>>(
        py::module_::import("difflib").attr("get_close_matches")(name, py::cast(known), 1));
  }
  std::string text;
  for (const std::string& one : close) text += (text.empty() ? "'" : " or '") + one + "'";
  return text.empty() ? "" : "; did you mean " + text + "?";
}

}  // namespace iksel::python
