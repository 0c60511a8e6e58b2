// SPDX-License-Identifier: BSD-3-Clause
// MoveIt's joint values of a group, and IKSel's of a robot.
#pragma once

#include <cstddef>
#include <iksel/iksel.hpp>
#include <string>
#include <vector>

namespace moveit::core {
class JointModelGroup;
}

namespace iksel_moveit {

/// The group's joints that move, as MoveIt counts them: mimic joints too, each of one variable.
class JointMap {
 public:
  JointMap() = default;
  explicit JointMap(const moveit::core::JointModelGroup& group);

  [[nodiscard]] const std::vector<std::string>& names() const { return names_; }
  [[nodiscard]] std::size_t size() const { return names_.size(); }

  /// Those of `values`, in the order of names(), that are the robot's degrees of freedom. Throws
  /// UnknownNameError if the group has not all of these.
  [[nodiscard]] iksel::JointVector pick(const iksel::Robot& robot,
                                        const std::vector<double>& values) const;
  /// The other way round: overwrites the robot's joints in `values`, and those that mimic some.
  void spread(const iksel::Robot& robot, const double* q, std::vector<double>& values) const;

 private:
  struct Mimic {
    std::size_t joint;
    std::size_t followed;
    double factor;
    double offset;
  };

  /// Throws UnknownNameError.
  [[nodiscard]] std::size_t index(const std::string& name) const;

  std::vector<std::string> names_;
  std::vector<Mimic> mimics_;
};

}  // namespace iksel_moveit
