// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"

namespace iksel::python {

void bind_task(py::module_& m) {
  bind_enums<TaskFrame, Axis>(m);
  auto cls = bind_keyword_class<Task>(m, /*writable=*/false);
  def_static(cls, "pose", "", fn<&Task::pose>);
  def_static(cls, "position_only", "", fn<&Task::position_only>);
  def_static(cls, "free_spin", "axis='z'", fn<&Task::free_spin>);
  def_static(cls, "upright", "axis='z'", fn<&Task::upright>);
  def_static(cls, "planar", "normal='z'", fn<&Task::planar>);
  def_static(cls, "box", "position, rotation, frame='tool'", fn<&Task::box>);
  add_properties(cls, "is_full_pose", &Task::is_full_pose, "constrained_axes",
                 &Task::constrained_axes);
  def(cls, "__hash__", "", [](const Task& self) { return py::hash(py::str(to_repr(self))); });
}

}  // namespace iksel::python
