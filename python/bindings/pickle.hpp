// SPDX-License-Identifier: BSD-3-Clause
// The state in a pickle is checked as a file is: a pickle may be cut short, or made by hand.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cmath>
#include <string>

#include "array_checks.hpp"
#include "iksel/error.hpp"
#include "iksel/types.hpp"
#include "python_types.hpp"

namespace iksel::python {

/// The tuple that __getstate__ gave, read item by item; throws InvalidArgumentError that names the
/// class and the item.
class PickleState {
 public:
  PickleState(const py::object& state, const char* class_name, std::size_t size)
      : class_name_(class_name) {
    const std::string expected = "a tuple of " + std::to_string(size);
    if (!py::isinstance<py::tuple>(state)) {
      throw_wrong_type(name("state").c_str(), expected, state);
    }
    state_ = py::reinterpret_borrow<py::tuple>(state);
    if (state_.size() != size) refuse("state", expected, "one of " + std::to_string(state_.size()));
  }

  /// What messages call an item.
  [[nodiscard]] std::string name(const char* item) const {
    return "pickled " + std::string(class_name_) + ", " + item;
  }

  py::object object() { return state_[next_++]; }

  template <class T>
  T value(const char* item) {
    return from_python<T>(object(), name(item).c_str());
  }

  py::list list(const char* item) {
    const py::object value = object();
    if (!py::isinstance<py::list>(value)) throw_wrong_type(name(item).c_str(), "a list", value);
    return value;
  }

  /// What is -1 if there is none; else below `end`.
  template <class T>
  T index(const char* item, T end) {
    const T i = value<T>(item);
    if (i < -1 || i >= end) refuse(item, "-1 to " + std::to_string(end - 1), std::to_string(i));
    return i;
  }

  int count(const char* item) {
    const int n = value<int>(item);
    if (n < 0) refuse(item, "a count", std::to_string(n));
    return n;
  }

  /// A length or an error: at least 0, and NaN only where that is allowed.
  double length(const char* item, bool may_be_nan) {
    const double x = value<double>(item);
    if (!(x >= 0) && !(may_be_nan && std::isnan(x))) refuse(item, "0 or more", std::to_string(x));
    return x;
  }

  /// (n,) finite joint values, n up to kMaxDof.
  JointVector joints(const char* item) {
    const py::object value = object();
    const DoubleArray array = as_doubles(value, name(item).c_str());
    if (array.ndim() != 1 || array.shape(0) > kMaxDof) {
      throw_wrong_shape(name(item).c_str(), "a (dof,) array", array);
    }
    return as_joints(array, static_cast<int>(array.shape(0)), name(item).c_str());
  }

  /// An (n,) array of just this type.
  template <class T>
  py::array_t<T> column(const char* item, py::ssize_t n) {
    const std::string expected = "a (" + std::to_string(n) + ",) array of " +
                                 py::cast<std::string>(py::str(py::dtype::of<T>()));
    const auto array = exact_array<T>(item, expected);
    if (array.ndim() != 1 || array.shape(0) != n) {
      throw_wrong_shape(name(item).c_str(), expected, array);
    }
    return array;
  }

  /// An (n, dof) array of doubles.
  py::array_t<double> rows(const char* item) {
    const std::string expected = "an (n, dof) array of float64";
    const auto array = exact_array<double>(item, expected);
    if (array.ndim() != 2 || array.shape(1) > kMaxDof) {
      throw_wrong_shape(name(item).c_str(), expected, array);
    }
    return array;
  }

  [[noreturn]] void refuse(const char* item, const std::string& expected,
                           const std::string& got) const {
    throw InvalidArgumentError(name(item) + ": expected " + expected + ", got " + got);
  }

 private:
  /// In C order, but not converted from another type.
  template <class T>
  py::array_t<T> exact_array(const char* item, const std::string& expected) {
    const py::object value = object();
    if (!py::isinstance<py::array_t<T>>(value)) {
      throw_wrong_type(name(item).c_str(), expected, value);
    }
    return py::array_t<T, py::array::c_style | py::array::forcecast>(value);
  }

  const char* class_name_;
  py::tuple state_;
  std::size_t next_ = 0;
};

}  // namespace iksel::python
