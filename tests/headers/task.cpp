// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/task.hpp>

namespace iksel_headers {

void use_task() {
  iksel::Task::pose().validate();
  static_cast<void>(iksel::Task::position_only().constrained_axes());
  static_cast<void>(iksel::Task::free_spin() == iksel::Task::upright());
  static_cast<void>(iksel::Task::planar() != iksel::Task::box({0, 0, 0}, {0, 0, 1}));
  static_cast<void>(iksel::Task().is_full_pose());
}

}  // namespace iksel_headers
