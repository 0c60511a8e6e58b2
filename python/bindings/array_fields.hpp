// SPDX-License-Identifier: BSD-3-Clause
// Arrays and containers as fields and arguments, and what a pickle may have in numbers.
#pragma once

#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "array_checks.hpp"
#include "fields.hpp"
#include "pose_arguments.hpp"
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

/// (dof,) joint values, of any arm if that is not known; none of them are None.
template <>
struct FromPython<JointVector> {
  static std::string text() { return "numpy.typing.ArrayLike | None"; }
  static JointVector convert(py::handle value, const char* name, int dof) {
    if (value.is_none()) return {};
    return dof < 0 ? as_any_joints(value, name) : as_joints(value, dof, name);
  }
  static OptionalArray show(const JointVector& value) {
    return OptionalArray(value.size() == 0 ? py::object(py::none()) : to_array(value));
  }
};

/// (N,) numbers.
template <>
struct FromPython<std::vector<double>> {
  static std::string text() { return ArrayLike::kText; }
  static std::vector<double> convert(py::handle value, const char* name) {
    const DoubleArray array = as_shaped(value, name, {-1}, "an (N,) array");
    return {array.data(), array.data() + array.size()};
  }
  static py::array_t<double> show(const std::vector<double>& value) { return to_array(value); }
};

/// (n, dof) joint values; where the arm is known (dof,) too, those of one configuration.
template <>
struct FromPython<std::vector<JointVector>> {
  static std::string text() { return ArrayLike::kText; }
  static std::vector<JointVector> convert(py::handle value, const char* name, int dof) {
    const DoubleArray array = as_doubles(value, name);
    if (array.ndim() == 1 && array.shape(0) == dof) return {as_joints(array, dof, name)};
    const bool fits =
        array.ndim() == 2 && (dof < 0 ? array.shape(1) <= kMaxDof : array.shape(1) == dof);
    if (!fits) {
      const std::string n = std::to_string(dof);
      throw_wrong_shape(
          name, dof < 0 ? "an (n, dof) array" : "a (" + n + ",) or (N, " + n + ") array", array);
    }
    const auto joints = static_cast<int>(array.shape(1));
    std::vector<JointVector> rows;
    rows.reserve(static_cast<std::size_t>(array.shape(0)));
    for (py::ssize_t i = 0; i < array.shape(0); ++i) {
      check_row(array.data(i), i, joints, name);
      rows.emplace_back(Eigen::Map<const Eigen::VectorXd>(array.data(i), joints));
    }
    return rows;
  }
  static py::array_t<double> show(const std::vector<JointVector>& rows) {
    return stack_joints(rows, rows.empty() ? 0 : static_cast<int>(rows.front().size()));
  }
};

template <>
struct FromPython<Eigen::Vector3d> {
  static std::string text() { return ArrayLike::kText; }
  static Eigen::Vector3d convert(py::handle value, const char* name) {
    const DoubleArray array = as_shaped(value, name, {3}, "a (3,) array");
    return {array.at(0), array.at(1), array.at(2)};
  }
  static py::array_t<double> show(const Eigen::Vector3d& value) {
    return to_array(JointVector(value));
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
