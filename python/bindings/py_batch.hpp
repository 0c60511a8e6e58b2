// SPDX-License-Identifier: BSD-3-Clause
// The answers of a batch as Python sees them.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "iksel/result.hpp"
#include "py_result.hpp"
#include "python_types.hpp"

namespace iksel::python {

inline bool is_row_index(PyObject* object) {
  const bool is_array = py::detail::npy_api::get().PyArray_Check_(object);
  return PyIndex_Check(object) != 0 && !(is_array && py::detail::array_proxy(object)->nd != 0);
}

/// The number of a row.
class RowIndex : public py::object {
  PYBIND11_OBJECT_DEFAULT(RowIndex, object, is_row_index)
};

/// Which rows: a slice, or an array of row numbers or truth values.
class RowsLike : public py::object {
  PYBIND11_OBJECT_DEFAULT(RowsLike, object, is_any_object)
};

/// Row `index` of `size`, counted from the end if negative.
inline py::ssize_t as_row(const RowIndex& index, py::ssize_t size, const char* noun) {
  auto i = from_python<py::ssize_t>(index, "i");
  if (i < 0) i += size;
  if (i < 0 || i >= size) {
    throw py::index_error(std::string(noun) + " " + std::to_string(i) + " of " +
                          std::to_string(size));
  }
  return i;
}

/// The arrays of a batch.
struct PyBatchResult {
  py::array_t<double> q;
  py::array_t<bool> success;
  py::array_t<std::uint8_t> status;
  py::array_t<double> position_error;
  py::array_t<double> rotation_error;
  py::array_t<std::int32_t> attempts;
  py::array_t<std::int32_t> iterations;
  py::array_t<double> move;
  py::array_t<std::uint8_t> proof;

  [[nodiscard]] py::ssize_t size() const { return status.shape(0); }

  [[nodiscard]] py::ssize_t solved() const {
    const bool* first = success.data();
    return std::count(first, first + success.size(), true);
  }

  [[nodiscard]] PyResult row(const RowIndex& index) const {
    const py::ssize_t i = as_row(index, size(), "row");
    PyResult out;
    out.result.status = static_cast<Status>(status.at(i));
    out.result.proof = static_cast<Proof>(proof.at(i));
    if (has_joints(out.result.status)) {
      out.result.q = Eigen::Map<const Eigen::VectorXd>(q.data(i), q.shape(1));
    }
    out.result.position_error = position_error.at(i);
    out.result.rotation_error = rotation_error.at(i);
    out.result.attempts = attempts.at(i);
    out.result.iterations = iterations.at(i);
    out.result.move = move.at(i);
    return out;
  }

  /// Copies of the rows that numpy's indexing takes.
  [[nodiscard]] PyBatchResult rows(const RowsLike& index) const;
};

}  // namespace iksel::python

// NOLINTBEGIN(readability-identifier-naming): pybind11 looks for `name`.
namespace pybind11::detail {
template <>
struct handle_type_name<iksel::python::RowIndex> {
  static constexpr auto name = const_name("int");
};

template <>
struct handle_type_name<iksel::python::RowsLike> {
  static constexpr auto name = const_name(
      "slice | collections.abc.Sequence[int] | "
      "numpy.typing.NDArray[numpy.integer[typing.Any] | numpy.bool_]");
};
}  // namespace pybind11::detail
// NOLINTEND(readability-identifier-naming)
