// SPDX-License-Identifier: BSD-3-Clause
#include "property.hpp"

#include <string>
#include <utility>

namespace iksel::python {

void set_property(const py::object& cls, const char* name, const std::string& type, Getter get,
                  const char* doc, const std::string& given_type, Setter set) {
  py::options options;
  options.disable_function_signatures();
  const std::string self = "(self: iksel_cpp." + py::cast<std::string>(cls.attr("__name__"));
  const std::string getter = self + ") -> " + type + "\n";
  const py::cpp_function read([get = std::move(get)](py::handle object) { return get(object); },
                              py::is_method(cls), getter.c_str());
  py::object write = py::none();
  if (set != nullptr) {
    const std::string setter = self + ", value: " + given_type + ") -> None\n";
    write = py::cpp_function(
        [set = std::move(set)](py::handle object, py::handle value) { set(object, value); },
        py::is_method(cls), py::arg("value"), setter.c_str());
  }
  const py::handle property(reinterpret_cast<PyObject*>(&PyProperty_Type));
  cls.attr(name) = property(read, write, py::none(), doc);
}

}  // namespace iksel::python
