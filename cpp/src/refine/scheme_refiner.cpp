// SPDX-License-Identifier: BSD-3-Clause
#include "refine/scheme_refiner.hpp"

namespace iksel {

SchemeRefiner::SchemeRefiner(const ChainModel& model, const Paper& scheme, int max_iterations)
    : model_(model),
      scheme_(scheme),
      max_iterations_(max_iterations),
      q_(JointVector::Zero(model.dof)) {
  if (scheme.kinematics != Kinematics::kdl) return;
  kdl_tip_ = model.make_kdl(Pose::Identity());
  kdl_tcp_ = model.make_kdl();
}

void SchemeRefiner::begin(const Goal& goal, Random& random) {
  goal_ = &goal;
  random_ = &random;
  if (goal.is_full_pose()) tip_target_ = goal.tip_target();
  left_limits_ = false;
}

int SchemeRefiner::advance(unsigned /*busy*/) {
  KdlChain* kdl = goal_->is_full_pose() ? kdl_tip_.get() : kdl_tcp_.get();
  const IterationContext context{model_,      scheme_, max_iterations_, *goal_,
                                 tip_target_, kdl,     *random_};
  int steps = 0;
  outcome_ = iterate(context, q_, steps);
  left_limits_ = left_limits_ || outcome_ == Outcome::outside_limits;
  return steps;
}

}  // namespace iksel
