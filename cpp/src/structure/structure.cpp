// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/structure.hpp"

#include "structure/closed_form.hpp"

namespace iksel {

const char* to_string(StructureKind kind) {
  switch (kind) {
    case StructureKind::closed_form:
      return "closed_form";
    case StructureKind::searched:
      return "searched";
  }
  return "unknown";
}

Structure find_structure(const Robot& robot) {
  const auto form = find_closed_form(robot.model());
  if (form) {
    return {StructureKind::closed_form, form->description + ": solved in closed form"};
  }
  return {StructureKind::searched, "no axes lie so that it would help: solved by search"};
}

}  // namespace iksel
