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
#include <utility>
#include <vector>

#include "iksel/solver.hpp"
#include "method.hpp"
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

/// Specialised for what is no plain value: text(), read(), shown().
template <class T, class Enable = void>
struct ArgumentOf {
  static std::string text() { return ValueOf<T>::argument(); }
  static T read(py::handle given, const char* name, int /*dof*/) {
    return from_python<T>(given, name);
  }
  static py::object shown(const T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      if (std::isinf(value)) return py::none();
    }
    return ValueOf<T>::to_plain(value);
  }
};

template <class T>
const ArgumentType& argument_type() {
  using A = ArgumentOf<T>;
  static const ArgumentType type{
      A::text(),
      [](void* value, py::handle given, const char* name, int dof) {
        *static_cast<T*>(value) = A::read(given, name, dof);
      },
      [](const void* value) { return A::shown(as<T>(value)); },
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

template <class Struct, class T>
Keyword keyword(const char* name, T Struct::*member, const char* doc) {
  return {
      name, doc, offset_of(member), &argument_type<T>(), &typeid(Struct), &defaults_of<Struct>()};
}

/// A keyword of a method, and the object that stands for it where it is not given.
struct MethodKeyword {
  Keyword keyword;
  PyObject* name;        ///< interned, as most callers' are
  PyObject* by_default;  ///< kept alive by the method
};

/// The keyword arguments of one call.
class Given {
 public:
  Given(const MethodKeyword* keywords, const py::handle* values, std::size_t count)
      : keywords_(keywords), values_(values), count_(count) {}

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

  const MethodKeyword* keywords_;
  const py::handle* values_;
  std::size_t count_;
};

/// What a docstring says besides the keywords.
struct MethodText {
  const char* name;
  const char* summary;
  const char* pose;  ///< name of the first argument
  const char* pose_doc;
  const char* result;  ///< its class
  const char* rest;    ///< what comes back and what is raised
};

/// Those of `known` that are named, with their defaults.
std::vector<MethodKeyword> choose_keywords(const std::vector<Keyword>& known,
                                           const char* const* names, std::size_t count,
                                           std::vector<py::arg_v>& arguments);
std::string method_signature(const MethodText& text, const std::vector<MethodKeyword>& keywords,
                             std::size_t positional);
std::string method_doc(const MethodText& text, const std::vector<MethodKeyword>& keywords);

/// A name as Python has it in the calls of most callers; it lives as long as Python.
PyObject* intern(const char* name);

/// Returns the pose, which is `poses`' only item or has its name among the given, and writes what
/// else is given into `values`, which hold the defaults. Throws what makes pybind11 try the next
/// overload where this does not fit, or a name is none of the keywords'.
py::handle find_given(const py::args& poses, PyObject* pose_name, const py::kwargs& given,
                      const std::vector<MethodKeyword>& keywords, py::handle* values);

using MethodBody = py::object (*)(const Solver& self, py::handle pose, const Given& given);

namespace detail {

template <std::size_t /*I*/>
using Value = py::handle;

template <std::size_t... P, std::size_t... K>
void def_method(py::class_<Solver>& cls, const MethodText& text, const std::vector<Keyword>& known,
                const char* const* names, MethodBody body, std::index_sequence<P...> /*positional*/,
                std::index_sequence<K...> /*keyword_only*/) {
  constexpr std::size_t kPositional = sizeof...(P);
  constexpr std::size_t kCount = kPositional + sizeof...(K);
  std::vector<py::arg_v> arguments;
  const auto keywords = choose_keywords(known, names, kCount, arguments);
  const auto call = [keywords, body](const Solver& self, py::handle pose,
                                     const std::array<py::handle, kCount>& values) {
    return body(self, pose, Given(keywords.data(), values.data(), kCount));
  };
  {
    // pybind11 makes a string of each argument's name at each call, which takes as long as a solve
    // does. So this overload takes what fits; the other says what the arguments are, also where
    // they do not fit.
    py::options options;
    options.disable_function_signatures();
    cls.def(text.name, [keywords, call, name = intern(text.pose)](
                           const Solver& self, const py::args& poses, const py::kwargs& given) {
      std::array<py::handle, kCount> values;
      for (std::size_t i = 0; i < kCount; ++i) values[i] = keywords[i].by_default;
      const py::handle pose = find_given(poses, name, given, keywords, values.data());
      return call(self, pose, values);
    });
  }
  def(
      cls, text.name, method_signature(text, keywords, kPositional), method_doc(text, keywords),
      [call](const Solver& self, py::handle pose, Value<P>... positional, Value<K>... others) {
        return call(self, pose, {positional..., others...});
      },
      py::arg(text.pose), arguments[P]..., py::kw_only(), arguments[kPositional + K]...);
}

}  // namespace detail

/// A method of a pose, or of poses, and the keywords named, the first few by position too.
template <std::size_t kPositional, std::size_t kCount>
void def_method(py::class_<Solver>& cls, const MethodText& text, const std::vector<Keyword>& known,
                const char* const (&names)[kCount], MethodBody body) {
  detail::def_method(cls, text, known, names, body, std::make_index_sequence<kPositional>(),
                     std::make_index_sequence<kCount - kPositional>());
}

}  // namespace iksel::python
