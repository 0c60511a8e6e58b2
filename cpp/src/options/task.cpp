// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/task.hpp"

#include <cmath>
#include <cstddef>
#include <string>

#include "base/constants.hpp"
#include "base/message_text.hpp"
#include "iksel/error.hpp"

namespace iksel {
namespace {

std::size_t index(Axis axis) { return static_cast<std::size_t>(axis); }

void set_free(std::array<double, 3>& lower, std::array<double, 3>& upper, std::size_t axis) {
  lower[axis] = -kInfinity;
  upper[axis] = kInfinity;
}

[[noreturn]] void reject(const char* what, std::size_t axis, double lower, double upper,
                         const char* expected) {
  MessageStream text;
  text << "task " << what << " "
       << "xyz"[axis] << ": " << lower << " .. " << upper << " is not " << expected;
  throw InvalidArgumentError(text.str());
}

}  // namespace

Task Task::position_only() {
  Task task;
  for (std::size_t i = 0; i < 3; ++i) set_free(task.rotation_lower, task.rotation_upper, i);
  return task;
}

Task Task::free_spin(Axis axis) {
  Task task;
  set_free(task.rotation_lower, task.rotation_upper, index(axis));
  return task;
}

Task Task::upright(Axis axis) {
  Task task = free_spin(axis);
  task.frame = TaskFrame::base;
  return task;
}

Task Task::planar(Axis normal) {
  Task task;
  task.frame = TaskFrame::base;
  for (std::size_t i = 0; i < 3; ++i) {
    if (i == index(normal)) {
      set_free(task.position_lower, task.position_upper, i);
    } else {
      set_free(task.rotation_lower, task.rotation_upper, i);
    }
  }
  return task;
}

Task Task::box(const std::array<double, 3>& position, const std::array<double, 3>& rotation,
               TaskFrame frame) {
  Task task;
  task.frame = frame;
  task.position_upper = position;
  task.rotation_upper = rotation;
  for (std::size_t i = 0; i < 3; ++i) {
    // Half a turn either way is every angle there is.
    if (rotation[i] >= kPi) task.rotation_upper[i] = kInfinity;
    task.position_lower[i] = -task.position_upper[i];
    task.rotation_lower[i] = -task.rotation_upper[i];
  }
  task.validate();
  return task;
}

bool Task::is_full_pose() const {
  const std::array<double, 3> zero{};
  return position_lower == zero && position_upper == zero && rotation_lower == zero &&
         rotation_upper == zero;
}

int Task::constrained_axes() const {
  int count = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::isfinite(position_lower[i]) || std::isfinite(position_upper[i])) ++count;
    if (std::isfinite(rotation_lower[i])) ++count;
  }
  return count;
}

void Task::validate() const {
  if (frame != TaskFrame::base && frame != TaskFrame::tool) {
    throw InvalidArgumentError("task frame: " + std::to_string(static_cast<int>(frame)) +
                               " is neither base nor tool");
  }
  for (std::size_t i = 0; i < 3; ++i) {
    // Written so that NaN fails.
    if (!(position_lower[i] <= position_upper[i]) || position_lower[i] == kInfinity ||
        position_upper[i] == -kInfinity) {
      reject("position", i, position_lower[i], position_upper[i], "an interval, lower to upper");
    }
    const bool free = rotation_lower[i] == -kInfinity && rotation_upper[i] == kInfinity;
    if (!free && !(rotation_lower[i] <= rotation_upper[i] && rotation_lower[i] >= -kPi &&
                   rotation_upper[i] <= kPi)) {
      reject("rotation", i, rotation_lower[i], rotation_upper[i],
             "an interval within -pi .. pi, nor free (-inf .. inf)");
    }
  }
  if (constrained_axes() == 0) {
    throw InvalidArgumentError("task: all six axes are free, so that there is nothing to reach");
  }
}

}  // namespace iksel
