// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <cmath>

#include "base/angle.hpp"
#include "simd/kernels.hpp"
#include "structure/closed_form.hpp"

namespace iksel {
namespace {

/// Of a self-motion's direction, the least that a swept joint has of it: where it has less, the
/// others turn so fast beside it that samples see little of them (python -m bench laws).
constexpr double kLeastPart = 0.02;

/// Whether a lane's branch is q; joints that may have any angle, and whole turns, do not count.
bool is_same(const ClosedFormChain& chain, const lanes::BranchPack& pack, int lane,
             const JointVector& q, double most) {
  for (int i = 0; i < 6; ++i) {
    const int joint = chain.joints[i];
    if (joint >= chain.dof || chain.turns_freely(joint)) continue;
    // Written so that NaN is not the same.
    if (!(std::abs(without_turns(pack.q[i][lane] - q[joint])) <= most)) return false;
  }
  return true;
}

/// How much of the direction in which all seven joints move without the tip is a joint's; 0 where
/// there are several.
double part_of_self_motion(const Jacobian& J, int joint) {
  const Eigen::MatrixXd directions = Eigen::MatrixXd(J).fullPivLu().kernel();
  return directions.cols() == 1 ? std::abs(directions(joint, 0)) / directions.norm() : 0;
}

}  // namespace

bool takes_part_in_self_motion(const ChainModel& model, int joint) {
  bool takes_part = false;
  model.visit_configurations([&](const JointVector&, const Pose&, const Jacobian& J) {
    takes_part = takes_part || part_of_self_motion(J, joint) > 1e-6;  // rounding
  });
  return takes_part;
}

bool finds_known_solutions(const ChainModel& model, ClosedFormChain chain) {
  chain.use_limits(model);
  const lanes::LaneKernels& kernels = lanes::choose_kernels();
  const Pose base_inverse = to_pose(model.kernel.base).inverse();
  const Pose tip_inverse = to_pose(model.kernel.tip).inverse();
  // How far a branch may be from the configuration that it is [rad]: near singularities rounding
  // counts more, and what the axes lie off many times.
  const double most = 1e-4 + 30 * chain.deviation;
  lanes::BranchPack pack = all_branches();
  int found = 0;
  model.visit_configurations([&](const JointVector& q, const Pose& pose, const Jacobian& J) {
    chain.set_target(base_inverse * pose * tip_inverse, pack);
    if (chain.held >= 0) {
      const double offset = model.kernel.joints[static_cast<std::size_t>(chain.held)].offset;
      for (double& held : pack.held) held = q[chain.held] + offset;
    }
    kernels.find_branches(chain.form, pack);
    int lane = 0;
    while (lane < lanes::kWidth && !is_same(chain, pack, lane, q, most)) ++lane;
    const bool moves = model.dof <= 6 || part_of_self_motion(J, chain.held) > kLeastPart;
    if (lane < lanes::kWidth && moves) ++found;
  });
  return found >= ChainModel::kConfigurations * 3 / 4;
}

}  // namespace iksel
