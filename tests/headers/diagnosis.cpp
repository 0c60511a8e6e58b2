// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/diagnosis.hpp>

namespace iksel_headers {

void use_diagnosis(const iksel::Robot& robot) {
  const iksel::Diagnosis diagnosis;
  static_cast<void>(to_string(diagnosis.cause));
  static_cast<void>(diagnosis.contacts.size() + iksel::task_hint(robot, iksel::Task()).size());
}

}  // namespace iksel_headers
