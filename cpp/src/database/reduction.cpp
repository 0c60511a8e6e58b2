// SPDX-License-Identifier: BSD-3-Clause
#include "database/reduction.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"

namespace iksel {
namespace {

using lanes::Side;

/// Of the first joint or the last, if a variable moves it and no other.
Side side_of(const ChainModel& model, const KernelJoint& joint, int variable) {
  const auto& joints = model.kernel.joints;
  const bool is_alone = std::count_if(joints.begin(), joints.end(), [&](const KernelJoint& each) {
                          return each.variable == variable;
                        }) == 1;
  if (joint.variable != variable || !is_alone || joint.multiplier != 1 || joint.curve) {
    return Side::none;
  }
  return joint.prismatic ? Side::translation : Side::rotation;
}

}  // namespace

lanes::SeedChain make_seed_chain(const ChainModel& model, const Reduction& reduction) {
  const lanes::LaneChain chain = make_lane_chain(model);
  lanes::SeedChain seeds{};
  seeds.n = chain.n;
  seeds.left = reduction.left;
  seeds.right = reduction.right;
  seeds.weight2 = static_cast<float>(reduction.weight * reduction.weight);
  seeds.offset_first = static_cast<float>(chain.joint[0].offset);
  seeds.offset_last = static_cast<float>(chain.joint[chain.joints - 1].offset);
  for (int j = 0; j < chain.n; ++j) {
    const lanes::LaneVariable& variable = chain.variable[j];
    seeds.lower[j] = static_cast<float>(variable.lower);
    seeds.upper[j] = static_cast<float>(variable.upper);
    seeds.middle[j] = static_cast<float>(0.5 * (variable.lower + variable.upper));
    seeds.wraps[j] = model.joints.repeats[static_cast<std::size_t>(j)];
  }
  return seeds;
}

lanes::SeedTarget make_seed_target(const Pose& Y) {
  lanes::SeedTarget target{};
  visit_rows(Y, 1,
             [&](int row, double number) { target.target[row] = static_cast<float>(number); });
  return target;
}

Reduction Reduction::of(const ChainModel& model, double weight) {
  Reduction out;
  out.dof = model.dof;
  out.weight = weight;
  out.base_inverse = to_pose(model.kernel.base).inverse();
  out.flange_inverse = to_pose(model.kernel.flange).inverse();
  // At least one joint must be left to sample.
  if (model.dof >= 3) {
    out.left = side_of(model, model.kernel.joints.front(), 0);
    out.right = side_of(model, model.kernel.joints.back(), model.dof - 1);
    // Two slides mix: the foot moves along neither coordinate then.
    if (out.left == Side::translation && out.right == Side::translation) out.right = Side::none;
  }
  return out;
}

int Reduction::key_dimension() const {
  return (left == Side::none ? 3 : 2) + (right == Side::rotation ? 3 : 6);
}

bool Reduction::leaves_out(int joint) const {
  return (joint == 0 && left != Side::none) || (joint == dof - 1 && right != Side::none);
}

Pose Reduction::reduce(const Pose& T_base_tip) const {
  return Pose(base_inverse) * T_base_tip * Pose(flange_inverse);
}

Pose Reduction::without_outer_joints(const Pose& Y, const lanes::LaneChain& chain,
                                     const double* q) const {
  const auto undo = [](Side side, double motion) -> Pose {
    Pose T = Pose::Identity();
    if (side == Side::rotation) T.rotate(Eigen::AngleAxisd(-motion, Eigen::Vector3d::UnitZ()));
    if (side == Side::translation) T.translation().z() = -motion;
    return T;
  };
  const int last = dof - 1;
  return undo(left, q[0] + chain.joint[0].offset) * Y *
         undo(right, q[last] + chain.joint[chain.joints - 1].offset);
}

void Reduction::make_key(const Pose& Y, double* key) const {
  const Eigen::Matrix3d R = Y.linear();
  const Eigen::Vector3d axis = R.col(2);
  Eigen::Vector3d point = Y.translation();
  if (right == Side::translation) point -= point.dot(axis) * axis;
  double c = 1;
  double s = 0;
  const auto off_axis = [](const Eigen::Vector3d& v) {
    return std::sqrt(v[0] * v[0] + v[1] * v[1]);
  };
  const double rho = off_axis(point);
  // A point on the first axis has no direction about it: then that of the last axis, so that poses
  // that differ by the first joint only have one key still.
  const bool is_on_axis = rho <= kRounding * weight;
  const Eigen::Vector3d& about = is_on_axis ? axis : point;
  const double length = is_on_axis ? off_axis(axis) : rho;
  if (left == Side::rotation && length > 0) {
    c = about[0] / length;
    s = about[1] / length;
  }
  int k = 0;
  const auto push_axis = [&](const Eigen::Vector3d& v) {
    key[k++] = weight * (c * v[0] + s * v[1]);
    key[k++] = weight * (c * v[1] - s * v[0]);
    key[k++] = weight * v[2];
  };
  if (left == Side::rotation) {
    key[k++] = rho;
    key[k++] = point[2];
  } else {
    key[k++] = point[0];
    key[k++] = point[1];
    if (left == Side::none) key[k++] = point[2];
  }
  push_axis(axis);
  if (right != Side::rotation) push_axis(R.col(0));
}

}  // namespace iksel
