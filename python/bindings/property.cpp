// SPDX-License-Identifier: BSD-3-Clause
#include "def.hpp"

#include <memory>
#include <string>
#include <utility>

namespace iksel::python {

namespace {

/// What a property calls; a function of Python's that holds it costs less than pybind11's.
struct GetterFunction {
  Getter get;
  std::string doc;
  PyMethodDef definition;
};

PyObject* call_getter(PyObject* capsule, PyObject* self) {
  return or_error([&] {
    const auto* getter = static_cast<GetterFunction*>(PyCapsule_GetPointer(capsule, nullptr));
    return getter->get(self).release().ptr();
  });
}

py::object new_getter(Getter get, const std::string& doc) {
  auto held = std::make_unique<GetterFunction>(GetterFunction{std::move(get), doc, {}});
  held->definition = {"", &call_getter, METH_O, held->doc.c_str()};
  const py::capsule capsule(held.get(),
                            [](void* getter) { delete static_cast<GetterFunction*>(getter); });
  PyMethodDef* definition = &held.release()->definition;
  PyObject* made = PyCFunction_NewEx(definition, capsule.ptr(), nullptr);
  if (made == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(made);
}

}  // namespace

void set_property(const py::object& cls, const char* name, const std::string& type, Getter get,
                  const char* doc, const std::string& given_type, Setter set) {
  const std::string self = "(self: iksel_cpp." + py::cast<std::string>(cls.attr("__name__"));
  const py::object read = new_getter(std::move(get), self + ") -> " + type + "\n");
  py::object write = py::none();
  if (set != nullptr) {
    py::options options;
    options.disable_function_signatures();
    const std::string setter = self + ", value: " + given_type + ") -> None\n";
    write = py::cpp_function(
        [set = std::move(set)](py::handle object, py::handle value) { set(object, value); },
        py::is_method(cls), py::arg("value"), setter.c_str());
  }
  const py::handle property(reinterpret_cast<PyObject*>(&PyProperty_Type));
  cls.attr(name) = property(read, write, py::none(), doc);
}

}  // namespace iksel::python
