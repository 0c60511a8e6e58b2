// SPDX-License-Identifier: BSD-3-Clause
// How far joints move between configurations, by the norm and weights of a request.
#pragma once

#include "iksel/request.hpp"

namespace iksel {

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

}  // namespace iksel
