// SPDX-License-Identifier: BSD-3-Clause
// How far joints move between configurations, whole turns considered.
#pragma once

#include <algorithm>
#include <cmath>

#include "iksel/request.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

/// The norm and weights of a request.
class JointMove {
 public:
  JointMove(int dof, const SolveRequest& request)
      : weights_(request.weights.size() == 0 ? JointVector(JointVector::Ones(dof))
                                             : request.weights),
        norm_(request.norm) {}

  [[nodiscard]] double length(const JointVector& difference) const {
    const auto weighted = weights_.cwiseProduct(difference);
    return norm_ == MoveNorm::two ? weighted.norm() : weighted.cwiseAbs().maxCoeff();
  }
  [[nodiscard]] const JointVector& weights() const { return weights_; }
  [[nodiscard]] MoveNorm norm() const { return norm_; }

 private:
  JointVector weights_;
  MoveNorm norm_;
};

/// Brings each joint with whole turns to the turn nearest to `near` inside the limits; q lies
/// inside them before and after. A turn that lies outside by no more than `slack` [rad] is taken
/// too, and the joint held to the limit. True if one was.
bool take_nearest_turns(const ChainModel& model, const JointVector& near, double slack,
                        JointVector& q);

/// Brings each joint with whole turns to the first turn inside the limits, or to [-pi, pi) if there
/// are none.
void take_first_turns(const ChainModel& model, JointVector& q);

/// Moves to the next combination of whole turns inside the limits; false after the last, which
/// leaves q at the first. Starts from take_first_turns.
bool take_next_turns(const ChainModel& model, JointVector& q);

/// The largest difference of a joint, whole turns counting nothing; or anything not below `bound`
/// if it is not below.
template <typename A, typename B>
double distance_without_turns(const ChainModel& model, const A& a, const B& b, double bound) {
  double largest = 0;
  for (int j = 0; j < model.dof; ++j) {
    double d = std::abs(a[j] - b[j]);
    if (d >= bound && has_whole_turns(model, j)) {
      d = std::abs(d - kTwoPi * static_cast<double>(static_cast<long>(d / kTwoPi + 0.5)));
    }
    largest = std::max(largest, d);
    if (largest >= bound) return largest;
  }
  return largest;
}

/// The middle of the limits; 0 where there are none.
JointVector middle_of_limits(const ChainModel& model);

}  // namespace iksel
