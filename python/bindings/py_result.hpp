// SPDX-License-Identifier: BSD-3-Clause
// A Result, the answers of a batch, and what results have in common, as Python sees them.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <utility>

#include "array_fields.hpp"

namespace iksel::python {

/// A Result whose q becomes an array, which nobody may write to, when it is first asked for.
struct PyResult : Result {
  PyResult() = default;
  explicit PyResult(Result result) : Result(std::move(result)) {}

  OptionalArray joints() {
    if (!array_) {
      array_ = has_joints(status) ? py::object(read_only(to_array(q))) : py::none();
    }
    return OptionalArray(array_);
  }

 private:
  py::object array_;
};

/// Whether it leaves no doubt that there is no answer, or no other.
inline bool is_proven(Proof proof) {
  return proof == Proof::reach || proof == Proof::target || proof == Proof::closed_form ||
         proof == Proof::intervals;
}

/// What is asked of all that may be proven.
template <class Class>
void def_proven(py::class_<Class>& cls, const std::string& what = "there is certainly no answer") {
  const std::string doc =
      "Whether " + what + ": `proof` is `reach`, `closed_form`, `intervals` or `target`.";
  add_property(
      cls, "proven", [](const Class& self) { return is_proven(self.proof); }, doc.c_str());
}

/// What is asked of all that may be solved.
template <class Class>
void def_success(py::class_<Class>& cls) {
  add_property(cls, "success", [](const Class& self) { return self.success(); });
  def(cls, "__bool__", "", [](const Class& self) { return self.success(); });
}

/// What __iter__ gives of that which has __getitem__ of an int.
template <class Item>
struct RowIterator : RawResult {
  using RawResult::RawResult;
};
template <class Item>
struct ResultType<RowIterator<Item>> {
  static std::string text() { return "collections.abc.Iterator[" + type_text<Item>() + "]"; }
};
template <class Item, class Class>
void def_iter(py::class_<Class>& cls) {
  def(cls, "__iter__", "", [](const Class& self) {
    const py::object object = py::cast(self, py::return_value_policy::reference);
    return RowIterator<Item>(py::reinterpret_steal<py::object>(PySeqIter_New(object.ptr())));
  });
}

template <>
struct FieldTable<PyResult> : HeaderTable<PyResult, Result> {
  static std::vector<Field> fields() {
    return HeaderFields<PyResult, Result>()
        .hide({"q", "unreachable_tip"})
        .check<&may_be_length>({"position_error", "rotation_error", "move"})
        .check<&is_count>({"attempts", "iterations"})
        .check<&is_index<kMaxTips>>({"unreachable_tip"})
        .all();
  }
  static void check(const PyResult& self) {
    const std::string of = "pickled Result, ";
    const bool has_q = has_joints(self.status);
    if (has_q != (self.q.size() > 0)) {
      refuse_state(of + "q", has_q ? "joint values" : "None, as it is not solved", "another");
    }
    if (has_q && !(self.position_error >= 0 && self.rotation_error >= 0)) {
      refuse_state(of + "errors", "0 or more where there is a q", "NaN");
    }
    if (self.success() != (self.proof == Proof::answer)) {
      refuse_state(of + "proof", "answer where solved, and only there", enum_name(self.proof));
    }
  }
};

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
