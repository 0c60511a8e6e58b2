// SPDX-License-Identifier: BSD-3-Clause
#include "goal/coaxial_joints.hpp"

#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "simd/lane_chain.hpp"

namespace iksel {

CoaxialJoints::CoaxialJoints(const ChainModel& model) : joints_(model.joints) {
  if (!is_simple(model)) return;
  const auto& joints = model.kernel.joints;
  for (std::size_t j = 1; j < joints.size(); ++j) {
    const KernelJoint& joint = joints[j];
    const bool is_coaxial = !joint.prismatic && !joints[j - 1].prismatic &&
                            std::abs(joint.sin_alpha) <= kRounding &&
                            std::hypot(joint.p[0], joint.p[1]) <= kRounding * model.reach;
    if (!is_coaxial) continue;
    const int before = static_cast<int>(j) - 1;
    if (groups_.empty() || groups_.back().last() != before) groups_.push_back({before, 1, {1}});
    Group& group = groups_.back();
    const auto count = static_cast<std::size_t>(group.count++);
    group.side[count] = group.side[count - 1] * (joint.cos_alpha < 0 ? -1 : 1);
  }
}

void CoaxialJoints::bring_nearest(const JointVector& near, const JointMove& move,
                                  JointVector& q) const {
  for (const Group& group : groups_) {
    double sum = 0;
    double wanted = 0;
    double least = 0;
    double most = 0;
    for (int j = group.first; j <= group.last(); ++j) {
      const double side = group.side_of(j);
      sum += side * q[j];
      wanted += side * near[j];
      least += side * (side > 0 ? joints_.lower[j] : joints_.upper[j]);
      most += side * (side > 0 ? joints_.upper[j] : joints_.lower[j]);
    }
    // The move is the shorter the nearer the sum is to that of `near`.
    const double lower = sum + kTwoPi * std::floor((wanted - sum) / kTwoPi);
    const JointVector before = q;
    double shortest = move.length(before - near);
    for (const double image : {lower, lower + kTwoPi}) {
      const double inside = image > most    ? image - kTwoPi * std::ceil((image - most) / kTwoPi)
                            : image < least ? image + kTwoPi * std::ceil((least - image) / kTwoPi)
                                            : image;
      if (inside > most) continue;
      JointVector shared = before;
      share(group, inside, near, move, shared);
      const double length = move.length(shared - near);
      if (length >= shortest) continue;
      shortest = length;
      q = shared;
    }
  }
}

void CoaxialJoints::share(const Group& group, double sum, const JointVector& near,
                          const JointMove& move, JointVector& q) const {
  const double least = MoveCost::kLeastWeight * move.weights().maxCoeff();
  // Those that reach a limit stay there, and the others share the rest.
  std::array<bool, kMaxDof> stays{};
  double rest = sum;
  const auto turn_to = [&](int j, double wanted) {
    q[j] = std::min(std::max(wanted, joints_.lower[j]), joints_.upper[j]);
    return q[j] == wanted;
  };
  const auto yields = [&](int j) {
    const double weight = std::max(move.weights()[j], least);
    return 1 / (weight * weight);
  };
  for (int j = group.first; j <= group.last(); ++j) {
    turn_to(j, near[j]);
    rest -= group.side_of(j) * q[j];
  }
  for (int round = 0; round < group.count; ++round) {
    double all = 0;
    for (int j = group.first; j <= group.last(); ++j) {
      if (!stays[static_cast<std::size_t>(j)]) all += yields(j);
    }
    if (all == 0) return;
    const double each = rest / all;
    for (int j = group.first; j <= group.last(); ++j) {
      bool& is_at_limit = stays[static_cast<std::size_t>(j)];
      if (is_at_limit) continue;
      const double before = q[j];
      is_at_limit = !turn_to(j, before + group.side_of(j) * each * yields(j));
      rest -= group.side_of(j) * (q[j] - before);
    }
  }
}

}  // namespace iksel
