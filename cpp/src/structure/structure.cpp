// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/structure.hpp"

#include "structure/closed_form.hpp"

namespace iksel {

const char* to_string(StructureKind kind) {
  switch (kind) {
    case StructureKind::closed_form:
      return "closed_form";
    case StructureKind::swept:
      return "swept";
    case StructureKind::searched:
      return "searched";
  }
  return "unknown";
}

Structure find_structure(const Robot& robot) {
  const auto form = find_closed_form(robot.model());
  if (form) {
    if (form->held < 0) {
      return {StructureKind::closed_form, form->description + ": solved in closed form"};
    }
    return {StructureKind::swept, form->description + ": in closed form for each angle of joint " +
                                      std::to_string(form->held + 1) + ", which is swept"};
  }
  return {StructureKind::searched, "no axes lie so that it would help: solved by search"};
}

}  // namespace iksel
