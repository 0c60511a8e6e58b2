// SPDX-License-Identifier: BSD-3-Clause
// The fields of a Task, as iksel/task.hpp declares them.
#pragma once

#include "fields.hpp"
#include "iksel/task.hpp"

namespace iksel::python {

template <>
struct FieldTable<Task> {
  using T = Task;
  static constexpr const char* kName = "Task";
  static constexpr const char* kDoc =
      "What of a pose has to be reached: a box around the target for the deviation of the TCP, "
      "along the axes of `frame`. Zero width asks for an axis exactly, infinite width leaves it "
      "free. The rotation's deviation is a rotation vector where its three widths are equal, else "
      "swing and twist about the axis whose width is unlike the other two's. An answer lies at "
      "most the solver's tolerances outside of the box. Immutable.";
  static std::vector<Field> fields() {
    return {
        field("frame", &T::frame, "Whose axes the bounds lie along."),
        field("position_lower", &T::position_lower,
              "Lower bounds of the position's deviation along x, y, z [m]; -inf: none."),
        field("position_upper", &T::position_upper,
              "Upper bounds of the position's deviation along x, y, z [m]; inf: none."),
        field("rotation_lower", &T::rotation_lower,
              "Lower bounds of the rotation's deviation about x, y, z [rad], from -pi, or -inf."),
        field("rotation_upper", &T::rotation_upper,
              "Upper bounds of the rotation's deviation about x, y, z [rad], up to pi, or inf.")};
  }
};

}  // namespace iksel::python
