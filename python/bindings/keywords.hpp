// SPDX-License-Identifier: BSD-3-Clause
// Methods of Solver whose keywords are fields of structs: what a keyword means, its type and its
// default stand once, in the header of its struct, and each method lists those that it takes.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>
#include <string>
#include <typeinfo>
#include <vector>

#include "array_fields.hpp"
#include "callables.hpp"
#include "option_fields.hpp"

namespace iksel::python {

struct Keyword {
  Field field;
  py::object by_default;  ///< as Python shows it; None: nothing is asked for
  const std::type_info* of;
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

/// Adds the fields of a struct, as its header has them.
template <class Struct>
void add_keywords(std::vector<Keyword>& all) {
  Members<Struct>::visit([&](const char* key, auto member) {
    using T = Plain<decltype(defaults_of<Struct>().*member)>;
    if constexpr (!std::is_same_v<T, Progress>) {
      const std::size_t offset = offset_of<Struct, T>(member);
      all.push_back({{std::strchr(key, '.') + 1, header_text(key), offset, &value_type<T>()},
                     shown_default(defaults_of<Struct>().*member),
                     &typeid(Struct)});
    }
  });
}

/// The keyword arguments of one call.
class Given {
 public:
  /// `values` are as many as keywords, or null: none is given, so that plain solving pays nothing.
  Given(const std::vector<Keyword>& keywords, const py::handle* values)
      : keywords_(keywords), values_(values) {}

  [[nodiscard]] bool is_empty() const { return values_ == nullptr; }

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
  const py::handle* values_;
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
      if (given == 2 && names == nullptr) {
        return py::cast(F()(self, arguments[1], Given(method.keywords, nullptr))).release().ptr();
      }
      std::array<py::handle, kMostArguments> values;
      method.function.bind(arguments + 1, given - 1, names, values.data());
      const Given all(method.keywords, values.data() + 1);
      return py::cast(F()(self, values[0], all)).release().ptr();
    });
  }
};

/// A method of a pose, or of poses, and the keywords named, which are fields of `Structs`; the
/// first few by position too. Its body is a function of the solver, the pose and what is Given.
template <class... Structs, class F>
void def_method(py::class_<Solver>& cls, const MethodText& text, std::size_t positional,
                const std::vector<const char*>& names, F /*body*/) {
  std::vector<Keyword> known;
  (add_keywords<Structs>(known), ...);
  KeywordMethod& method = BoundKeywords<F>::method;
  method.describe(text, type_text<typename CallType<F>::Result>(), known, names, positional);
  add_method(cls, method.function, &BoundKeywords<F>::call);
}

// What the keywords of Solver's methods take.

/// What `closest` asks for: None, a bool, or six weights.
template <>
struct FromPython<std::optional<PoseWeights>> {
  static std::string text() { return "bool | numpy.typing.ArrayLike | None"; }
  static std::optional<PoseWeights> convert(py::handle value, const char* name);
  static py::object show(const std::optional<PoseWeights>& weights);
};

template <>
struct FromPython<std::vector<Task>> {
  static std::string text() {
    return "collections.abc.Sequence[Task | collections.abc.Mapping[str, object]]";
  }
  static std::vector<Task> convert(py::handle value, const char* name) {
    return read_sequence<Task>(value, name, "a list of Tasks, one for each tip");
  }
};

/// Numbers of tips; None is -1.
template <>
struct FromPython<std::vector<int>> {
  static std::string text() { return "collections.abc.Sequence[int | None]"; }
  static std::vector<int> convert(py::handle value, const char* name) {
    std::vector<int> frames;
    for (const auto& frame : read_sequence<std::optional<int>>(
             value, name, "a list of numbers of tips or None, one for each tip")) {
      frames.push_back(frame.value_or(-1));
    }
    return frames;
  }
};

/// The request that keywords ask for, but for the field `except`; warns of angles that look like
/// degrees.
SolveRequest read_request(const Solver& solver, const Given& given, const char* except = "");

/// The task of a request, or else the solver's.
inline const Task& task_of(const Solver& solver, const TargetCriteria& criteria) {
  return criteria.task ? *criteria.task : solver.options().task;
}

/// The pose of the one tip, or one for each.
std::vector<Pose> as_targets(const Solver& solver, py::handle poses,
                             const TargetCriteria& criteria);
/// Poses of many targets, one after the other: those of all tips at the first, at the second, ...
DoubleArray as_rows(const Solver& solver, py::handle poses, const TargetCriteria& criteria);

}  // namespace iksel::python
