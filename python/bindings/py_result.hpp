// SPDX-License-Identifier: BSD-3-Clause
// A Result as Python sees it.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <string>
#include <utility>

#include "array_checks.hpp"
#include "def.hpp"
#include "enums.hpp"
#include "iksel/result.hpp"

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
  switch (proof) {
    case Proof::reach:
    case Proof::target:
    case Proof::closed_form:
      return true;
    case Proof::sweep:
    case Proof::none:
    case Proof::answer:
      return false;
  }
  return false;
}

/// "not_converged, proven: closed_form".
inline std::string status_text(Status status, Proof proof) {
  std::string text = enum_name(status);
  if (status != Status::solved && is_proven(proof)) {
    text += std::string(", proven: ") + enum_name(proof);
  }
  return text;
}

/// (rows, dof) of joint values.
template <class Rows, class Get>
py::array_t<double> stack_joints(const Rows& rows, int dof, const Get& get) {
  py::array_t<double> array({static_cast<py::ssize_t>(rows.size()), py::ssize_t{dof}});
  double* out = array.mutable_data();
  for (const auto& row : rows) out = std::copy_n(get(row).data(), dof, out);
  return array;
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

}  // namespace iksel::python
