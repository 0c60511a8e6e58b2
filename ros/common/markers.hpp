// SPDX-License-Identifier: BSD-3-Clause
// What RViz shows of an answer.
#pragma once

#include <iksel/iksel.hpp>
#include <string>

#include "messages.hpp"  // of ros1 or ros2

namespace iksel_ros {

/// Draws one arm in its base link's frame, by lines between the frames of its links.
class Markers {
 public:
  explicit Markers(const iksel::Robot& robot);

  /// The target's axes, the arm at `q` (none if empty) in green or red, and `text` at the target.
  [[nodiscard]] messages::MarkerArray draw(const messages::Pose& target,
                                           const iksel::JointVector& q, bool success,
                                           const std::string& text) const;

 private:
  iksel::Robot robot_;
  iksel::LinkTree tree_;
};

}  // namespace iksel_ros
