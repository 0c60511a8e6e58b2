// SPDX-License-Identifier: BSD-3-Clause
// Functions as Python has them. What they take follows from the types of the function of C++ and
// from a line that names its parameters. Calls cost less than pybind11's, which makes a string of
// each keyword; those that do not fit are looked at once more, for a sentence about it.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "python_types.hpp"

namespace iksel::python {

/// An only argument: all that is given by name.
struct Keywords : py::dict {};

struct Parameter {
  std::string name;
  std::string shown;  ///< in errors
  std::string type;
  py::handle by_default;         ///< none: it has to be given
  PyObject* interned = nullptr;  ///< its name as most callers have it
};

/// With a default unless that is null.
Parameter new_parameter(const std::string& name, const std::string& type, py::object by_default);

/// What a function takes, and what errors and docstrings say of it.
struct Function {
  std::string name;   ///< "fk"
  std::string owner;  ///< "Robot"; empty if it is the module's
  std::vector<Parameter> parameters;
  std::size_t positional = 0;  ///< that may be given by position
  std::string doc;
  PyMethodDef definition{};

  /// "Robot.fk"; of a constructor the class.
  [[nodiscard]] std::string full_name() const;
  /// Adds the parameters of a line like "q, *, near=None", where defaults are Python's.
  void add_parameters(const std::string& line, const std::vector<std::string>& types);
  /// Gives each parameter its argument, or what it is by default. Throws SignatureError.
  void bind(PyObject* const* arguments, std::size_t count, PyObject* keywords,
            py::handle* values) const;
  /// As bind(), of what __getstate__ gave.
  void bind_state(const py::dict& state, py::handle* values) const;
  /// As bind(), of a function that takes any keyword.
  [[nodiscard]] Keywords bind_keywords(PyObject* const* arguments, std::size_t count,
                                       PyObject* keywords) const;
  /// Throws SignatureError if the first is none of the class.
  void check_self(PyObject* const* arguments, std::size_t count, PyTypeObject* type) const;
  /// Throws SignatureError that says why the arguments do not fit.
  [[noreturn]] void refuse(std::size_t count, PyObject* keywords) const;
};

/// A METH_FASTCALL | METH_KEYWORDS function.
using FastCall = PyObject* (*)(PyObject*, PyObject* const*, Py_ssize_t, PyObject*);

/// "q, near" of "q, *, near=None".
std::string without_defaults(const std::string& line);

/// Puts the function, of which the name, the parameters and the docstring are known, into a module.
void add_function(py::module_& m, Function& function, FastCall call);
void add_static_method(const py::object& cls, Function& function, FastCall call);
void add_method(const py::object& cls, Function& function, FastCall call);

/// "fk(self: iksel_cpp.Robot, q: numpy.typing.ArrayLike) -> bool", and the text.
std::string docstring(const Function& function, const std::string& self, const std::string& result,
                      const std::string& text);

/// A function or const method of C++ as a type.
template <auto F>
struct Fn;
template <class R, class... A, R (*F)(A...)>
struct Fn<F> {
  R operator()(A... arguments) const { return F(std::forward<A>(arguments)...); }
};
template <class C, class R, class... A, R (C::*F)(A...) const>
struct Fn<F> {
  R operator()(const C& self, A... arguments) const {
    return (self.*F)(std::forward<A>(arguments)...);
  }
};
template <auto F>
inline constexpr Fn<F> fn{};

template <class F>
struct CallType : CallType<decltype(&F::operator())> {};
template <class C, class R, class... A>
struct CallType<R (C::*)(A...) const> {
  using Result = R;
  using Arguments = std::tuple<Plain<A>...>;
};

/// What a callable of C++, which holds nothing, is in Python; its arguments from number `kFirst`
/// on are those that Python gives. `Use` tells two of the same callable apart.
template <class F, std::size_t kFirst, class Use = void>
struct Bound {
  static inline Function function;
  static inline std::optional<F> body;  ///< lambdas cannot be made from nothing

  using Result = typename CallType<F>::Result;
  using Arguments = typename CallType<F>::Arguments;
  static constexpr std::size_t kCount = std::tuple_size_v<Arguments> - kFirst;
  using Numbers = std::make_index_sequence<kCount>;
  template <std::size_t I>
  using Argument = std::tuple_element_t<kFirst + I, Arguments>;

  static constexpr bool takes_any_keyword() {
    if constexpr (kCount == 1) return std::is_same_v<Argument<0>, Keywords>;
    return false;
  }

  /// use(arguments ...), read in their order, so that of two bad ones the first is named.
  template <class With, std::size_t... I>
  static auto read(const py::handle* values, const With& use, std::index_sequence<I...> /*all*/) {
    (void)values;
    std::tuple<decltype(from_python<Argument<I>>(values[I], ""))...> all{
        from_python<Argument<I>>(values[I], function.parameters[I].shown.c_str())...};
    return std::apply(use, all);
  }

  template <class With>
  static auto bind(PyObject* const* arguments, std::size_t count, PyObject* keywords,
                   const With& use) {
    if constexpr (takes_any_keyword()) {
      const Keywords all = function.bind_keywords(arguments, count, keywords);
      return use(all);
    } else {
      std::array<py::handle, kCount + 1> values;
      function.bind(arguments, count, keywords, values.data());
      return read(values.data(), use, Numbers());
    }
  }

  /// What F gives, to Python.
  template <class... A>
  static PyObject* call(py::handle owner, A&... arguments) {
    if constexpr (std::is_void_v<Result>) {
      (*body)(arguments...);
      return py::none().release().ptr();
    } else {
      return to_python<Result>((*body)(arguments...), owner).release().ptr();
    }
  }

  static PyObject* call_function(PyObject* /*scope*/, PyObject* const* arguments, Py_ssize_t count,
                                 PyObject* keywords) {
    return or_error([&] {
      return bind(arguments, static_cast<std::size_t>(count), keywords,
                  [](auto&... each) { return call(py::handle(), each...); });
    });
  }

  template <class Class>
  static PyObject* call_method(PyObject* /*scope*/, PyObject* const* arguments, Py_ssize_t count,
                               PyObject* keywords) {
    return or_error([&] {
      const auto given = static_cast<std::size_t>(count);
      function.check_self(arguments, given, ClassOf<Class>::type);
      auto& self = made<Class>(arguments[0]);
      return bind(arguments + 1, given - 1, keywords,
                  [&](auto&... each) { return call(arguments[0], self, each...); });
    });
  }

  template <class Class>
  static PyObject* call_constructor(PyObject* /*scope*/, PyObject* const* arguments,
                                    Py_ssize_t count, PyObject* keywords) {
    return or_error([&] {
      const auto given = static_cast<std::size_t>(count);
      function.check_self(arguments, given, ClassOf<Class>::type);
      bind(arguments + 1, given - 1, keywords, [&](auto&... each) {
        construct<Class>(arguments[0], (*body)(each...));
        return 0;
      });
      return py::none().release().ptr();
    });
  }

  template <class Class>
  static PyObject* call_setstate(PyObject* /*scope*/, PyObject* const* arguments, Py_ssize_t count,
                                 PyObject* /*keywords*/) {
    return or_error([&] {
      function.check_self(arguments, static_cast<std::size_t>(count), ClassOf<Class>::type);
      std::array<py::handle, kCount> values;
      const py::object given =
          count == 2 ? py::reinterpret_borrow<py::object>(arguments[1]) : py::object(py::none());
      const py::dict state = copy_of_dict(given, "pickled " + function.owner);
      function.bind_state(state, values.data());
      const auto place = [&](auto&... each) { construct<Class>(arguments[0], (*body)(each...)); };
      read(values.data(), place, Numbers());
      return py::none().release().ptr();
    });
  }

  template <std::size_t... I>
  static std::vector<std::string> types(std::index_sequence<I...> /*all*/) {
    return {FromPython<Argument<I>>::text()...};
  }

  /// The text of one that takes any keyword has its signature.
  static Function& describe(const F& of, const char* name, const std::string& owner,
                            const std::string& line, const std::string& self,
                            const std::string& result, const std::string& text) {
    body.emplace(of);
    if (!function.name.empty()) throw std::logic_error(function.name + " is bound already");
    function.name = name;
    function.owner = owner;
    const std::string scope = owner.empty() ? "" : owner + ".";
    if constexpr (takes_any_keyword()) {
      function.doc = text;
    } else {
      function.add_parameters(line, types(Numbers()));
      const bool says_header = text.empty() && name[0] != '_';
      function.doc =
          docstring(function, self, result, says_header ? header_text(scope + name) : text);
    }
    return function;
  }
};

}  // namespace iksel::python
