// SPDX-License-Identifier: BSD-3-Clause
// How functions of C++ become functions, methods, constructors and properties of Python. What is
// defined without a text, and does not begin with an underscore, has that of the core's header.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

#include "function.hpp"

namespace iksel::python {

/// A function of the module.
template <class F>
void def(py::module_& m, const char* name, const std::string& line, const F& body,
         const std::string& text = "") {
  using B = Bound<F, 0>;
  const std::string result = type_text<typename B::Result>();
  add_function(m, B::describe(body, name, "", line, "", result, text), &B::call_function);
}

template <class Class, class F>
void def_static(py::class_<Class>& cls, const char* name, const std::string& line, const F& body,
                const std::string& text = "") {
  using B = Bound<F, 0>;
  const std::string result = type_text<typename B::Result>();
  add_static_method(cls, B::describe(body, name, ClassOf<Class>::name, line, "", result, text),
                    &B::call_function);
}

/// A method; the first argument of its body is the object.
template <class Class, class F>
void def(py::class_<Class>& cls, const char* name, const std::string& line, const F& body,
         const std::string& text = "") {
  using B = Bound<F, 1>;
  const std::string& self = ClassOf<Class>::name;
  const std::string result = type_text<typename B::Result>();
  add_method(cls, B::describe(body, name, self, line, self, result, text),
             &B::template call_method<Class>);
}

/// Items by numbers and in other ways, whose signatures are given from the argument on.
template <class Class, class F>
void def_getitem(py::class_<Class>& cls, const F& body,
                 const std::vector<const char*>& signatures) {
  using B = Bound<F, 1>;
  const std::string& self = ClassOf<Class>::name;
  Function& function = B::describe(body, "__getitem__", self, "i", self, "object", "");
  function.doc = "__getitem__(*args, **kwargs)\nOverloaded function.\n";
  for (std::size_t i = 0; i < signatures.size(); ++i) {
    function.doc += "\n" + std::to_string(i + 1) + ". __getitem__(self: iksel_cpp." + self +
                    ", i: " + signatures[i] + "\n";
  }
  add_method(cls, function, &B::template call_method<Class>);
}

/// A constructor; its body returns the object.
template <class Class, class F>
void def_init(py::class_<Class>& cls, const std::string& line, const F& body,
              const std::string& text, const char* name = "__init__") {
  using B = Bound<F, 0>;
  const std::string& self = ClassOf<Class>::name;
  add_method(cls, B::describe(body, name, self, line, self, "None", text),
             &B::template call_constructor<Class>);
}

/// Pickling: a dict that stands for an object, and what makes one of its items.
template <class Class, class Get, class Set>
void def_pickle(py::class_<Class>& cls, const Get& get, const std::string& items, const Set& set) {
  def(cls, "__getstate__", "", get);
  using B = Bound<Set, 0, Function>;
  const std::string& name = ClassOf<Class>::name;
  Function& function = B::describe(set, "__setstate__", name, items, name, "None", "");
  for (Parameter& each : function.parameters) each.shown = "pickled " + name + ", " + each.name;
  add_method(cls, function, &B::template call_setstate<Class>);
}

/// Equality of what is no key.
template <class Class>
void def_equal(py::class_<Class>& cls) {
  def(cls, "__eq__", "other", [](const Class& self, const py::object& other) {
    return is_a<Class>(other) && self == made<Class>(other);
  });
}

using Getter = std::function<py::object(py::handle)>;
using Setter = std::function<void(py::handle, py::handle)>;

/// With the types that stubs show; without `set` nobody may set it.
void set_property(const py::object& cls, const char* name, const std::string& type, Getter get,
                  const char* doc, const std::string& given_type = "", Setter set = nullptr);

/// A read-only property. `get`: a function of the object, a method or a member.
template <class Class, class Get>
void add_property(py::class_<Class>& cls, const char* name, Get get, const char* doc = nullptr) {
  using Result = std::invoke_result_t<Get, Class&>;
  set_property(
      cls, name, type_text<Result>(),
      [get](py::handle self) {
        return to_python<Result>(std::invoke(get, made<Class>(self)), self);
      },
      doc == nullptr ? header_text(ClassOf<Class>::name + "." + name) : doc);
}

/// Several, each by its name and `get`, with the header's texts.
template <class Class, class Get, class... More>
void add_properties(py::class_<Class>& cls, const char* name, Get get, More... more) {
  add_property(cls, name, get);
  if constexpr (sizeof...(More) > 0) add_properties(cls, more...);
}

/// repr(), as iksel._base.show has it for the class.
template <class Class>
void def_repr(py::class_<Class>& cls) {
  def(cls, "__repr__", "", [](const Class& self) {
    const py::object object = py::cast(self, py::return_value_policy::reference);
    return py::str(of_package("iksel._base.show", "text")(ClassOf<Class>::name, object));
  });
}

/// What notebooks show.
template <class Class>
void def_page(py::class_<Class>& cls) {
  def(cls, "_repr_html_", "", [](const Class& self) {
    const py::object object = py::cast(self, py::return_value_policy::reference);
    return py::str(of_package("iksel._base.show", "page")(ClassOf<Class>::name, object));
  });
}

/// What deepcopy hands on.
struct Memo : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText = "dict";
};

/// Copies of what holds values only.
template <class Class>
void def_copies(py::class_<Class>& cls) {
  def(cls, "__copy__", "", [](const Class& self) { return self; });
  def(cls, "__deepcopy__", "memo", [](const Class& self, const Memo& /*memo*/) { return self; });
}

}  // namespace iksel::python
