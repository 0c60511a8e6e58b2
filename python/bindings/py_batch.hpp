// SPDX-License-Identifier: BSD-3-Clause
// The answers of a batch as Python sees them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "py_result.hpp"

namespace iksel::python {

/// Whether it is the number of a row, which may be an array of no axes.
inline bool is_row_number(py::handle index) {
  const bool is_array = py::isinstance<py::array>(index);
  return PyIndex_Check(index.ptr()) != 0 &&
         !(is_array && py::reinterpret_borrow<py::array>(index).ndim() != 0);
}

/// Row `i` of `size`, counted from the end if negative.
inline py::ssize_t as_row(py::ssize_t i, py::ssize_t size, const char* noun) {
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
  py::array_t<std::int32_t> unreachable_tip;

  [[nodiscard]] py::ssize_t size() const { return status.shape(0); }

  [[nodiscard]] py::ssize_t solved() const {
    const bool* first = success.data();
    return std::count(first, first + success.size(), true);
  }

  [[nodiscard]] PyResult row(py::ssize_t number) const {
    const py::ssize_t i = as_row(number, size(), "row");
    PyResult out;
    out.status = static_cast<Status>(status.at(i));
    out.proof = static_cast<Proof>(proof.at(i));
    if (has_joints(out.status)) {
      out.q = Eigen::Map<const Eigen::VectorXd>(q.data(i), q.shape(1));
    }
    out.position_error = position_error.at(i);
    out.rotation_error = rotation_error.at(i);
    out.attempts = attempts.at(i);
    out.iterations = iterations.at(i);
    out.move = move.at(i);
    out.unreachable_tip = unreachable_tip.at(i);
    return out;
  }

  /// Copies of the rows that numpy's indexing takes.
  [[nodiscard]] PyBatchResult rows(py::handle index) const;
};

template <>
struct FieldTable<PyBatchResult> {
  using B = PyBatchResult;
  static constexpr const char* kName = "BatchResult";
  static const char* doc() { return header_text("BatchView"); }
  static std::vector<Field> fields();
  /// Statuses and proofs that there are, and numbers where there are answers.
  static void check(const B& self);
};

}  // namespace iksel::python
