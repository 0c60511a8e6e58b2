// SPDX-License-Identifier: BSD-3-Clause
#include "function.hpp"

#include <pybind11/eval.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <limits>
#include <regex>
#include <sstream>
#include <stdexcept>

namespace iksel::python {

namespace {

/// The names in scope of a default.
py::dict names_of_defaults() {
  py::dict names = py::module_::import("iksel_cpp").attr("__dict__").attr("copy")();
  names["inf"] = std::numeric_limits<double>::infinity();
  return names;
}

/// The function as an object. `self` is where Python finds it by its name, for pickles.
py::object new_function(Function& function, py::handle self, py::handle module, FastCall call) {
  const auto as_c_function = reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(call));
  function.definition = {function.name.c_str(), as_c_function, METH_FASTCALL | METH_KEYWORDS,
                         function.doc.c_str()};
  PyObject* made = PyCFunction_NewEx(&function.definition, self.ptr(), module.ptr());
  if (made == nullptr) throw py::error_already_set();
  return py::reinterpret_steal<py::object>(made);
}

std::size_t find(const std::vector<Parameter>& parameters, PyObject* name) {
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (parameters[i].interned == name) return i;
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    if (PyUnicode_Compare(parameters[i].interned, name) == 0) return i;
  }
  return parameters.size();
}

}  // namespace

Parameter new_parameter(const std::string& name, const std::string& type, py::object by_default) {
  return {name, name, type, by_default.release(), PyUnicode_InternFromString(name.c_str())};
}

void Function::add_parameters(const std::string& line, const std::vector<std::string>& types) {
  positional = types.size();
  std::istringstream words(line);
  for (std::string word; std::getline(words >> std::ws, word, ',');) {
    if (word == "*") {
      positional = parameters.size();
      continue;
    }
    const std::size_t equals = word.find('=');
    py::object by_default;
    if (equals != std::string::npos) {
      by_default = py::eval(word.substr(equals + 1), names_of_defaults());
    }
    parameters.push_back(
        new_parameter(word.substr(0, equals), types.at(parameters.size()), by_default));
  }
  if (parameters.size() != types.size()) throw std::logic_error(name + ": names and types differ");
}

std::string docstring(const Function& function, const std::string& self, const std::string& result,
                      const std::string& text) {
  std::string line = self.empty() ? "" : "self: iksel_cpp." + self;
  for (std::size_t i = 0; i < function.parameters.size(); ++i) {
    const Parameter& parameter = function.parameters[i];
    if (i == function.positional) line += line.empty() ? "*" : ", *";
    line += (line.empty() ? "" : ", ") + parameter.name + ": " + parameter.type;
    if (parameter.by_default) {
      line += " = " + py::cast<std::string>(py::repr(parameter.by_default));
    }
  }
  const std::string end = text.empty() ? "" : "\n" + text + "\n";
  return function.name + "(" + line + ") -> " + result + "\n" + end;
}

std::string without_defaults(const std::string& line) {
  return std::regex_replace(line, std::regex("=[^,]*|\\*, "), "");
}

void Function::bind(PyObject* const* arguments, std::size_t count, PyObject* keywords,
                    py::handle* values) const {
  const std::size_t size = parameters.size();
  if (count > positional) refuse(count, keywords);
  for (std::size_t i = 0; i < size; ++i) {
    values[i] = i < count ? py::handle(arguments[i]) : parameters[i].by_default;
  }
  const Py_ssize_t named = keywords == nullptr ? 0 : PyTuple_GET_SIZE(keywords);
  for (Py_ssize_t k = 0; k < named; ++k) {
    const std::size_t i = find(parameters, PyTuple_GET_ITEM(keywords, k));
    if (i == size || i < count) refuse(count, keywords);
    values[i] = arguments[count + static_cast<std::size_t>(k)];
  }
  if (std::any_of(values, values + size, [](py::handle value) { return !value; })) {
    refuse(count, keywords);
  }
}

void Function::bind_state(const py::dict& state, py::handle* values) const {
  std::size_t known = 0;
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    values[i] = PyDict_GetItem(state.ptr(), parameters[i].interned);
    if (values[i]) ++known;
  }
  if (known == parameters.size() && known == state.size()) return;
  throw InvalidArgumentError("pickled " + owner + ": expected a dict of " +
                             std::to_string(parameters.size()) + " items, got " +
                             std::to_string(known) + " of them and " +
                             std::to_string(state.size() - known) + " others");
}

Keywords Function::bind_keywords(PyObject* const* arguments, std::size_t count,
                                 PyObject* keywords) const {
  if (count > 0) refuse(count, keywords);
  Keywords all;
  const Py_ssize_t named = keywords == nullptr ? 0 : PyTuple_GET_SIZE(keywords);
  for (Py_ssize_t k = 0; k < named; ++k)
    all[PyTuple_GET_ITEM(keywords, k)] = py::handle(arguments[k]);
  return all;
}

std::string Function::full_name() const {
  if (name == "__init__") return owner;
  return owner.empty() ? name : owner + "." + name;
}

void Function::refuse(std::size_t count, PyObject* keywords) const {
  py::list known;
  py::list needed;
  for (const Parameter& each : parameters) {
    known.append(each.name);
    if (!each.by_default) needed.append(each.name);
  }
  const py::object given =
      keywords == nullptr ? py::tuple() : py::reinterpret_borrow<py::object>(keywords);
  throw SignatureError(py::cast<std::string>(of_package("iksel._base.keywords", "misfit")(
      known, needed, positional, full_name(), count, given)));
}

void Function::check_self(PyObject* const* arguments, std::size_t count, PyTypeObject* type) const {
  if (count > 0 && PyObject_TypeCheck(arguments[0], type) != 0) return;
  if (count == 0) throw SignatureError(full_name() + "() needs 'self', a " + owner);
  throw SignatureError(full_name() + "() is of a " + owner + ", not of " + describe(arguments[0]));
}

void add_function(py::module_& m, Function& function, FastCall call) {
  m.attr(function.name.c_str()) = new_function(function, m, m.attr("__name__"), call);
}

void add_static_method(const py::object& cls, Function& function, FastCall call) {
  const auto made = new_function(function, cls, cls.attr("__module__"), call);
  cls.attr(function.name.c_str()) = py::staticmethod(made);
}

void add_method(const py::object& cls, Function& function, FastCall call) {
  const auto made = new_function(function, cls, cls.attr("__module__"), call);
  cls.attr(function.name.c_str()) =
      py::reinterpret_steal<py::object>(PyInstanceMethod_New(made.ptr()));
  // What is compared by its value is no key.
  if (function.name == "__eq__" && !cls.attr("__dict__").contains("__hash__")) {
    cls.attr("__hash__") = py::none();
  }
}

}  // namespace iksel::python
