// SPDX-License-Identifier: BSD-3-Clause
// A Result, and what results have in common, as Python sees them.
#pragma once

#include <algorithm>
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

}  // namespace iksel::python
