// SPDX-License-Identifier: BSD-3-Clause
// Methods whose types are known at run time only: the docstring says what pybind11 reads from the
// types of C++ otherwise.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <utility>

namespace iksel::python {

namespace py = pybind11;

/// `signature` begins after the name.
template <class Function, class... Extra>
void def(py::object& cls, const char* name, const std::string& signature, const std::string& text,
         Function&& function, const Extra&... extra) {
  std::string doc = name + signature + "\n";
  if (!text.empty()) doc += "\n" + text + "\n";
  py::options options;
  options.disable_function_signatures();
  const py::cpp_function method(std::forward<Function>(function), py::name(name),
                                py::is_method(cls), py::sibling(py::getattr(cls, name, py::none())),
                                extra..., doc.c_str());
  py::detail::add_class_method(cls, name, method);
}

}  // namespace iksel::python
