// SPDX-License-Identifier: BSD-3-Clause
// Answers SolveIK requests.
#pragma once

#include <iksel/iksel.hpp>
#include <map>
#include <optional>
#include <string>

#include "messages.hpp"  // of ros1 or ros2

namespace iksel_ros {

/// Status of a request that makes no sense.
inline constexpr char kInvalidRequest[] = "invalid_request";

/// The solver of one arm, in the words of ROS.
class IkServer {
 public:
  explicit IkServer(const iksel::Robot& robot) : solver_(robot) {}

  [[nodiscard]] const iksel::Robot& robot() const { return solver_.robot(); }

  /// Solves; a request that makes no sense is answered by kInvalidRequest and why. `shown`
  /// becomes what there is to draw: the answer, or else the best effort; empty if nothing was
  /// tried.
  void solve(const messages::SolveIK::Request& request, messages::SolveIK::Response& response,
             iksel::JointVector& shown) const;

  /// Takes note of the positions of those joints that are the arm's.
  void update(const messages::JointState& state);

 private:
  [[nodiscard]] iksel::Pose read_target(const messages::SolveIK::Request& request) const;
  [[nodiscard]] iksel::SolveRequest read_request(const messages::SolveIK::Request& request) const;

  iksel::Solver solver_;
  std::map<std::string, double> positions_;
};

}  // namespace iksel_ros
