// SPDX-License-Identifier: BSD-3-Clause
// One seed at a time brought to its goal, by the scheme that the options choose.
#pragma once

#include <memory>

#include "base/random.hpp"
#include "refine/iterate.hpp"

namespace iksel {

class SchemeRefiner {
 public:
  SchemeRefiner(const ChainModel& model, const Paper& scheme, int max_iterations);

  /// Before a search; all must outlive it.
  void begin(const Goal& goal, Random& random);

  [[nodiscard]] int width() const { return 1; }
  /// As the reference does, also from outside the limits.
  void load_seed(int /*lane*/, const double* q) {
    q_ = Eigen::Map<const Eigen::VectorXd>(q, model_.dof);
  }
  void load_answer(int lane, const double* q) { load_seed(lane, q); }

  /// An attempt from beginning to end. Returns the steps.
  int advance(unsigned busy);
  [[nodiscard]] bool has_arrived(int /*lane*/) const { return outcome_ == Outcome::solved; }
  [[nodiscard]] bool is_spent(int /*lane*/) const { return true; }
  [[nodiscard]] bool is_to_be_looked_at(int /*lane*/) const { return false; }
  static bool stays(int /*lane*/) { return false; }
  [[nodiscard]] const JointVector& at(int /*lane*/) const { return q_; }
  [[nodiscard]] const JointVector& q(int /*lane*/) const { return q_; }
  /// Whether an attempt since begin() reached the goal outside the limits.
  [[nodiscard]] bool has_left_limits() const { return left_limits_; }

 private:
  const ChainModel& model_;
  const Paper& scheme_;
  int max_iterations_;
  /// Only if the options iterate by KDL, whose objects are not safe to share: to the tip link for a
  /// full pose, else to the TCP.
  std::unique_ptr<KdlChain> kdl_tip_, kdl_tcp_;
  const Goal* goal_ = nullptr;
  Pose tip_target_ = Pose::Identity();
  Random* random_ = nullptr;
  JointVector q_;
  Outcome outcome_ = Outcome::failed;
  bool left_limits_ = false;
};

}  // namespace iksel
