// SPDX-License-Identifier: BSD-3-Clause
// numpy arrays to poses and joint values and back. A double array in C order is read in place;
// other layouts and real types are converted once; anything else is an InvalidArgumentError that
// says which argument it was, what it got and what it expected.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "gil.hpp"

namespace iksel::python {

/// NPY_ARRAY_ALIGNED of numpy's interface in C.
constexpr int kAligned = 0x0100;

/// Aligned doubles in C order, made by conversion if need be.
using DoubleArray = py::array_t<double, py::array::c_style | py::array::forcecast | kAligned>;

using RowMajorPose = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// "(3, 4)", as numpy writes a shape.
inline std::string shape_text(const py::array& array) {
  return py::cast<std::string>(py::str(array.attr("shape")));
}

[[noreturn]] inline void throw_wrong_shape(const char* name, const std::string& expected,
                                           const py::array& got, const char* hint = "") {
  throw InvalidArgumentError(std::string(name) + ": expected " + expected + ", got shape " +
                             shape_text(got) + hint);
}

/// Throws InvalidArgumentError about a tensor, or a sequence with one, that has to be detached from
/// its gradients before numpy takes it.
inline void refuse_gradients(py::handle value, const char* name) {
  // A list may hold itself, or lists to any depth.
  std::set<PyObject*> seen;
  std::vector<py::object> rest{py::reinterpret_borrow<py::object>(value)};
  while (!rest.empty()) {
    const py::object item = std::move(rest.back());
    rest.pop_back();
    if (py::isinstance<py::array>(item) || py::isinstance<py::str>(item)) continue;
    if (py::isinstance<py::list>(item) || py::isinstance<py::tuple>(item)) {
      if (!seen.insert(item.ptr()).second) continue;
      for (const py::handle each : item) rest.push_back(py::reinterpret_borrow<py::object>(each));
      continue;
    }
    if (!py::hasattr(item, "detach") || !py::hasattr(item, "requires_grad")) continue;
    if (PyObject_IsTrue(item.attr("requires_grad").ptr()) != 1) continue;
    throw InvalidArgumentError(
        std::string(name) + ": a tensor that requires gradients, which end here: call .detach()");
  }
}

/// Throws InvalidArgumentError about an array that says of some numbers that they are none.
inline void refuse_masked(py::handle value, const char* name) {
  if (!py::isinstance<py::array>(value) || !py::hasattr(value, "mask")) return;
  if (!py::cast<bool>(py::module_::import("numpy.ma").attr("is_masked")(value))) return;
  throw InvalidArgumentError(std::string(name) +
                             ": expected numbers, got a masked array with masked entries");
}

inline DoubleArray convert_to_doubles(py::handle value, const char* name) {
  refuse_masked(value, name);
  const auto array = py::array::ensure(value);
  if (!array) {
    refuse_gradients(value, name);
    throw_wrong_type(name, "an array of real numbers", value);
  }
  const char kind = array.dtype().kind();
  if (kind != 'f' && kind != 'i' && kind != 'u') {
    if (!py::isinstance<py::array>(value)) {
      refuse_gradients(value, name);
      throw_wrong_type(name, "an array of real numbers", value);
    }
    throw InvalidArgumentError(std::string(name) + ": expected real numbers, got dtype " +
                               py::cast<std::string>(py::str(array.dtype())));
  }
  auto doubles = DoubleArray::ensure(array);
  if (!doubles) throw_wrong_type(name, "an array of real numbers", value);
  return doubles;
}

/// Whether it is an array of aligned doubles in C order, which is read in place. Of a class derived
/// from numpy's, as that of masked arrays, it is looked at first.
inline bool is_doubles(py::handle value) {
  constexpr int kInPlace = py::array::c_style | kAligned;
  static const py::handle plain = of_package("numpy", "ndarray").release();
  if (!py::type::handle_of(value).is(plain)) return false;
  const int flags = py::reinterpret_borrow<py::array>(value).flags();
  return (flags & kInPlace) == kInPlace && py::isinstance<DoubleArray>(value);
}

/// The array itself if it is read in place, a converted one otherwise.
inline DoubleArray as_doubles(py::handle value, const char* name) {
  if (is_doubles(value)) return py::reinterpret_borrow<DoubleArray>(value);
  return convert_to_doubles(value, name);
}

/// An array of that shape, where -1 is any extent. Throws InvalidArgumentError.
inline DoubleArray as_shaped(py::handle value, const char* name,
                             std::initializer_list<py::ssize_t> shape, const char* expected) {
  DoubleArray array = as_doubles(value, name);
  const auto fits = [](py::ssize_t wanted, py::ssize_t got) { return wanted < 0 || wanted == got; };
  const py::ssize_t* got = array.shape();
  if (!std::equal(shape.begin(), shape.end(), got, got + array.ndim(), fits)) {
    throw_wrong_shape(name, expected, array);
  }
  return array;
}

inline void check_finite(const double* values, int dof, const std::string& name) {
  for (int i = 0; i < dof; ++i) {
    if (!std::isfinite(values[i])) {
      throw InvalidArgumentError(name + ": expected finite numbers, got " +
                                 std::to_string(values[i]) + " at joint " + std::to_string(i));
    }
  }
}

/// A (dof,) array of finite numbers as joint values.
inline JointVector as_joints(py::handle value, int dof, const char* name) {
  const DoubleArray array = as_doubles(value, name);
  if (array.ndim() != 1 || array.shape(0) != dof) {
    throw_wrong_shape(name, "a (" + std::to_string(dof) + ",) array", array);
  }
  check_finite(array.data(), dof, name);
  return Eigen::Map<const Eigen::VectorXd>(array.data(), dof);
}

/// A (dof,) or (N, dof) array of numbers.
inline DoubleArray as_joint_rows(py::handle value, int dof, const char* name) {
  DoubleArray array = as_doubles(value, name);
  const py::ssize_t n = array.ndim();
  if ((n != 1 && n != 2) || array.shape(n - 1) != dof) {
    const std::string text = std::to_string(dof);
    throw_wrong_shape(name, "a (" + text + ",) or (N, " + text + ") array", array);
  }
  return array;
}

inline void check_row(const double* row, py::ssize_t index, int dof, const char* name) {
  if (Eigen::Map<const Eigen::VectorXd>(row, dof).allFinite()) return;
  check_finite(row, dof, std::string(name) + "[" + std::to_string(index) + "]");
}

/// Shape of what is computed of `q`: `item` for each row, if there are rows.
inline std::vector<py::ssize_t> shape_for(const DoubleArray& q, std::vector<py::ssize_t> item) {
  if (q.ndim() == 2) item.insert(item.begin(), q.shape(0));
  return item;
}

/// Applies `function(const double* q, std::size_t count, T* out)` to a (dof,) array, giving an
/// array of shape `item`, or to the rows of an (N, dof) array, many at a time, giving (N, *item)
/// with the GIL released; Ctrl-C ends it.
template <class T, class Function>
py::array_t<T> map_joint_blocks(py::handle value, int dof, const char* name,
                                std::vector<py::ssize_t> item, const Function& function) {
  const DoubleArray array = as_joint_rows(value, dof, name);
  const double* in = array.data();
  py::array_t<T> out(shape_for(array, std::move(item)));
  T* to = out.mutable_data();
  if (array.ndim() == 1) {
    check_finite(in, dof, name);
    function(in, 1, to);
    return out;
  }
  const py::ssize_t rows = array.shape(0);
  constexpr py::ssize_t kBlock = 256;
  for (py::ssize_t first = 0; first < rows; first += kBlock) {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    const py::ssize_t end = std::min(first + kBlock, rows);
    const GilRelease release;
    for (py::ssize_t i = first; i < end; ++i) check_row(in + i * dof, i, dof, name);
    function(in + first * dof, static_cast<std::size_t>(end - first),
             to + first * (out.size() / rows));
  }
  return out;
}

/// The same with `function(const JointVector&, T* out)` for each configuration.
template <class T = double, class Function>
py::array_t<T> map_joints(py::handle value, int dof, const char* name,
                          std::vector<py::ssize_t> item, const Function& function) {
  py::ssize_t size = 1;
  for (const py::ssize_t each : item) size *= each;
  return map_joint_blocks<T>(value, dof, name, std::move(item),
                             [&function, dof, size](const double* q, std::size_t count, T* out) {
                               JointVector joints(dof);
                               for (std::size_t i = 0; i < count; ++i, q += dof, out += size) {
                                 joints = Eigen::Map<const Eigen::VectorXd>(q, dof);
                                 function(joints, out);
                               }
                             });
}

/// What map_joints gives for a truth value.
inline BoolOrArray to_bool_or_array(const py::array_t<bool>& values) {
  return BoolOrArray(values.ndim() == 0 ? py::object(py::bool_(*values.data()))
                                        : py::object(values));
}

/// A (4, 4) array of its own.
inline py::array_t<double> to_array(const Pose& pose) {
  py::array_t<double> array({4, 4});
  Eigen::Map<RowMajorPose>(array.mutable_data()) = pose.matrix();
  return array;
}

/// A (size,) array of its own.
inline py::array_t<double> to_array(const JointVector& values) {
  return py::array_t<double>(values.size(), values.data());
}

inline py::array_t<double> to_array(const std::vector<double>& values) {
  return py::array_t<double>(static_cast<py::ssize_t>(values.size()), values.data());
}

/// A C-ordered array of its own. Ctrl-C ends the copying of many rows.
inline py::array_t<double> to_array(const Matrix& matrix) {
  constexpr Eigen::Index kBlock = 1 << 16;
  py::array_t<double> array({matrix.rows(), matrix.cols()});
  Eigen::Map<RowMajorMatrix> rows(array.mutable_data(), matrix.rows(), matrix.cols());
  for (Eigen::Index first = 0; first < matrix.rows(); first += kBlock) {
    if (first > 0 && PyErr_CheckSignals() != 0) throw py::error_already_set();
    const Eigen::Index count = std::min(kBlock, matrix.rows() - first);
    rows.middleRows(first, count) = matrix.middleRows(first, count);
  }
  return array;
}

/// (rows, dof) of joint values.
inline py::array_t<double> stack_joints(const std::vector<JointVector>& rows, int dof) {
  py::array_t<double> array({static_cast<py::ssize_t>(rows.size()), py::ssize_t{dof}});
  double* out = array.mutable_data();
  for (const JointVector& row : rows) out = std::copy_n(row.data(), dof, out);
  return array;
}

/// The array, which from now on nobody may write to.
inline py::array_t<double> read_only(py::array_t<double> array) {
  static PyObject* const name = PyUnicode_InternFromString("setflags");
  PyObject* arguments[] = {array.ptr(), Py_False};
  PyObject* none = PyObject_VectorcallMethod(name, arguments, 2, nullptr);
  if (none == nullptr) throw py::error_already_set();
  Py_DECREF(none);
  return array;
}

/// A read-only array over values that live as long as `owner`.
inline py::array_t<double> read_only_view(const JointVector& values, py::handle owner) {
  return read_only(py::array_t<double>(values.size(), values.data(), owner));
}

}  // namespace iksel::python
