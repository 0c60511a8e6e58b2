// SPDX-License-Identifier: BSD-3-Clause
// Arrays and containers as fields, and what a pickle may have in numbers.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "array_checks.hpp"
#include "fields.hpp"
#include "sequence_of.hpp"

namespace iksel::python {

[[noreturn]] inline void refuse_state(const std::string& name, const std::string& expected,
                                      const std::string& got) {
  throw InvalidArgumentError(name + ": expected " + expected + ", got " + got);
}

inline void is_count(int value, const std::string& name) {
  if (value < 0) refuse_state(name, "a count", std::to_string(value));
}

/// A length or an error: at least 0.
inline void is_length(double value, const std::string& name) {
  if (!(value >= 0)) refuse_state(name, "0 or more", std::to_string(value));
}

/// Or NaN.
inline void may_be_length(double value, const std::string& name) {
  if (!std::isnan(value)) is_length(value, name);
}

/// -1 if there is none; else below kEnd.
template <int kEnd>
void is_index(int value, const std::string& name) {
  if (value >= -1 && value < kEnd) return;
  refuse_state(name, "-1 to " + std::to_string(kEnd - 1), std::to_string(value));
}

/// Joint values of an arm that is not known.
inline JointVector as_any_joints(py::handle value, const char* name) {
  const DoubleArray array = as_doubles(value, name);
  if (array.ndim() != 1 || array.shape(0) > kMaxDof) {
    throw_wrong_shape(name, "a (dof,) array", array);
  }
  return as_joints(array, static_cast<int>(array.shape(0)), name);
}

/// (n,) joint values; none of them are None.
template <>
struct FromPython<JointVector> {
  static std::string text() { return "numpy.typing.ArrayLike | None"; }
  static JointVector convert(py::handle value, const char* name) {
    return value.is_none() ? JointVector() : as_any_joints(value, name);
  }
};
template <>
struct ResultType<JointVector> : ResultType<OptionalArray> {};
template <>
struct ValueOf<JointVector> : PlainValue<JointVector, ValueOf<JointVector>> {
  static py::object to_plain(const JointVector& value) {
    return value.size() == 0 ? py::object(py::none()) : to_array(value);
  }
};

/// (n,) numbers.
template <>
struct FromPython<std::vector<double>> {
  static std::string text() { return ArrayLike::kText; }
  static std::vector<double> convert(py::handle value, const char* name) {
    const DoubleArray array = as_doubles(value, name);
    if (array.ndim() != 1) throw_wrong_shape(name, "an (N,) array", array);
    return {array.data(), array.data() + array.size()};
  }
};
template <>
struct ResultType<std::vector<double>> : ResultType<py::array_t<double>> {};
template <>
struct ValueOf<std::vector<double>>
    : PlainValue<std::vector<double>, ValueOf<std::vector<double>>> {
  static py::object to_plain(const std::vector<double>& value) { return to_array(value); }
};

/// (n, dof) joint values.
template <>
struct FromPython<std::vector<JointVector>> {
  static std::string text() { return ArrayLike::kText; }
  static std::vector<JointVector> convert(py::handle value, const char* name) {
    const DoubleArray array = as_doubles(value, name);
    if (array.ndim() != 2 || array.shape(1) > kMaxDof) {
      throw_wrong_shape(name, "an (n, dof) array", array);
    }
    const auto dof = static_cast<int>(array.shape(1));
    std::vector<JointVector> rows;
    for (py::ssize_t i = 0; i < array.shape(0); ++i) {
      check_row(array.data(i), i, dof, name);
      rows.emplace_back(Eigen::Map<const Eigen::VectorXd>(array.data(i), dof));
    }
    return rows;
  }
};
template <>
struct ResultType<std::vector<JointVector>> : ResultType<py::array_t<double>> {};
template <>
struct ValueOf<std::vector<JointVector>>
    : PlainValue<std::vector<JointVector>, ValueOf<std::vector<JointVector>>> {
  static py::object to_plain(const std::vector<JointVector>& value) {
    const auto dof = static_cast<py::ssize_t>(value.empty() ? 0 : value.front().size());
    py::array_t<double> array({static_cast<py::ssize_t>(value.size()), dof});
    double* out = array.mutable_data();
    for (const JointVector& q : value) out = std::copy_n(q.data(), dof, out);
    return array;
  }
};

/// An array of just this type.
template <class T>
struct FromPython<py::array_t<T>> {
  static std::string text() { return type_text<py::array_t<T>>(); }
  static py::array_t<T> convert(py::handle value, const char* name) {
    if (!py::isinstance<py::array_t<T>>(value)) {
      throw_wrong_type(name, "an array of " + py::cast<std::string>(py::str(py::dtype::of<T>())),
                       value);
    }
    return py::array_t<T, py::array::c_style | py::array::forcecast>(
        py::reinterpret_borrow<py::object>(value));
  }
};
/// Objects of a class with fields.
template <class T>
struct FromPython<std::vector<T>, std::enable_if_t<HasFields<T>::value>> : FromSequence<T> {};
template <class T>
struct ValueOf<std::vector<T>, std::enable_if_t<HasFields<T>::value>> {
  static py::object get(std::vector<T>& value, py::handle owner) {
    return py::cast(value, py::return_value_policy::reference_internal, owner);
  }
  static py::object to_plain(const std::vector<T>& value) {
    py::list all;
    for (const T& each : value) all.append(py::cast(each));
    return all;
  }
};

}  // namespace iksel::python
