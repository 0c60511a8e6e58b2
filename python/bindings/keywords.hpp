// SPDX-License-Identifier: BSD-3-Clause
// Methods of Solver whose keywords are fields of structs: what a keyword means, its type and its
// default stand once, in the table of its struct, and each method lists those that it takes.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <typeinfo>
#include <vector>

#include "function.hpp"
#include "iksel/solver.hpp"
#include "value_type.hpp"

namespace iksel::python {

/// What a method does with arguments of one type.
struct ArgumentType {
  std::string text;  ///< in signatures, without None
  /// Throws InvalidArgumentError that names the culprit; `dof` is the arm's.
  void (*set)(void* value, py::handle given, const char* name, int dof);
  /// A default as Python shows it; None where it means that nothing is asked for.
  py::object (*shown)(const void* value);
};

/// Specialised for what has to know the arm, or is read in another way.
template <class T, class Enable = void>
struct ArgumentOf {
  static std::string text() { return FromPython<T>::text(); }
  static T read(py::handle given, const char* name, int /*dof*/) {
    return from_python<T>(given, name);
  }
};

template <class T>
py::object shown_default(const T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    if (std::isinf(value)) return py::none();
  }
  if constexpr (std::is_arithmetic_v<T> || std::is_enum_v<T>) {
    return ValueOf<T>::to_plain(value);
  } else {
    return py::none();
  }
}

template <class T>
const ArgumentType& argument_type() {
  using A = ArgumentOf<T>;
  static const ArgumentType type{
      A::text(),
      [](void* value, py::handle given, const char* name, int dof) {
        *static_cast<T*>(value) = A::read(given, name, dof);
      },
      [](const void* value) { return shown_default(as<T>(value)); },
  };
  return type;
}

struct Keyword {
  const char* name;
  const char* doc;
  std::size_t offset;  ///< of the member in its struct
  const ArgumentType* type;
  const std::type_info* of;
  const void* defaults;
};

/// The member may be one of a base of the struct.
template <class Struct, class Base, class T>
Keyword keyword(const char* name, T Base::*member, const char* doc) {
  const auto own = static_cast<T Struct::*>(member);
  return {name, doc, offset_of(own), &argument_type<T>(), &typeid(Struct), &defaults_of<Struct>()};
}

/// The keyword arguments of one call.
class Given {
 public:
  /// `values` are as many as keywords.
  Given(const std::vector<Keyword>& keywords, const std::vector<Parameter>& parameters,
        const py::handle* values, bool is_empty)
      : keywords_(keywords), parameters_(parameters), values_(values), is_empty_(is_empty) {}

  /// Whether there are none, so that plain solving pays nothing for them.
  [[nodiscard]] bool is_empty() const { return is_empty_; }

  /// The value of one of the method's keywords.
  [[nodiscard]] py::handle operator[](const char* name) const;

  /// The struct with the given of its fields set, but for `except`.
  template <class Struct>
  [[nodiscard]] Struct read(int dof, const char* except = "") const {
    Struct out;
    read_into(&out, typeid(Struct), dof, except);
    return out;
  }

 private:
  void read_into(void* out, const std::type_info& type, int dof, const char* except) const;

  const std::vector<Keyword>& keywords_;
  const std::vector<Parameter>& parameters_;  ///< the pose, then the keywords
  const py::handle* values_;
  bool is_empty_;
};

/// What a docstring says besides the keywords.
struct MethodText {
  const char* name;
  const char* summary;
  const char* pose;  ///< name of the first argument
  const char* pose_doc;
  const char* rest;  ///< what comes back and what is raised
};

/// A method that takes the named of the keywords that are known.
struct KeywordMethod {
  Function function;
  std::vector<Keyword> keywords;

  void describe(const MethodText& text, const std::string& result,
                const std::vector<Keyword>& known, const std::vector<const char*>& names,
                std::size_t positional);
};

/// Arguments that a method has at most.
constexpr std::size_t kMostArguments = 24;

template <class F>
struct BoundKeywords {
  static inline KeywordMethod method;

  static PyObject* call(PyObject* /*scope*/, PyObject* const* arguments, Py_ssize_t count,
                        PyObject* names) {
    return or_error([&] {
      const auto given = static_cast<std::size_t>(count);
      method.function.check_self(arguments, given, ClassOf<Solver>::type);
      const Solver& self = made<Solver>(arguments[0]);
      std::array<py::handle, kMostArguments> values;
      method.function.bind(arguments + 1, given - 1, names, values.data());
      const Given all(method.keywords, method.function.parameters, values.data() + 1,
                      given == 2 && names == nullptr);
      return py::cast(F()(self, values[0], all)).release().ptr();
    });
  }
};

/// A method of a pose, or of poses, and the keywords named, the first few by position too. Its body
/// is a function of the solver, the pose and what is Given.
template <class F>
void def_method(py::class_<Solver>& cls, const MethodText& text, const std::vector<Keyword>& known,
                std::size_t positional, const std::vector<const char*>& names, F /*body*/) {
  using Result = typename CallType<F>::Result;
  KeywordMethod& method = BoundKeywords<F>::method;
  method.describe(text, type_text<Result>(), known, names, positional);
  add_method(cls, method.function, &BoundKeywords<F>::call);
}

}  // namespace iksel::python
