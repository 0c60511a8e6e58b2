// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "base/random.hpp"
#include "simd/kernels.hpp"
#include "structure/closed_form.hpp"

namespace iksel {
namespace {

/// The last joint's frame at these angles.
Pose end_at(const ScrewAxes& axes, const double (&angles)[kPoseJoints]) {
  Pose pose = axes.end;
  for (std::size_t j = kPoseJoints; j-- > 0;) {
    const Eigen::AngleAxisd turn(angles[j], axes.h[j]);
    pose = Eigen::Translation3d(axes.p[j]) * turn * Eigen::Translation3d(-axes.p[j]) * pose;
  }
  return pose;
}

/// The slope of the determinant at solutions, of its noise: by the inverse of that a root is off.
/// Where several solutions share an angle, the slope is but noise; so is the whole determinant
/// where the axes are such that it is always 0. The geometric mean over some solutions.
double tell_apart(const LoopEquations& loop, const ScrewAxes& axes, int swept) {
  constexpr int kSolutions = 16;
  constexpr std::uint64_t kSeed = 6;
  LoopPolynomial determinant(lanes::choose_kernels());
  Random random(kSeed);
  double sum = 0;
  for (int i = 0; i < kSolutions; ++i) {
    double angles[kPoseJoints];
    for (double& angle : angles) angle = random.uniform(-kPi, kPi);
    lanes::LoopTarget target;
    loop.set_target(end_at(axes, angles), target);
    determinant.find(target);
    const double slope = std::abs(determinant.slope(angles[swept]));
    const double noise = std::max(determinant.noise(), 1e-16 * determinant.size());
    sum += std::log(std::max(slope / noise, 1e-30));  // finite
  }
  return std::exp(sum / kSolutions);
}

}  // namespace

std::optional<ClosedFormChain> find_loop(const ChainModel& model) {
  const ScrewAxes forward = ScrewAxes::of(model);
  double best = 1e6;  // roots that are known worse are no seeds to rely on [1/rad]
  std::optional<ClosedFormChain> found;
  for (const bool reversed : {false, true}) {
    const ScrewAxes axes = reversed ? forward.reversed() : forward;
    for (const int swept : {3, 4, 5, 0}) {
      auto loop = std::make_shared<const LoopEquations>(axes, model.reach, swept);
      const double apart = tell_apart(*loop, axes, swept);
      if (!(apart > best)) continue;
      best = apart;
      ClosedFormChain& chain = found.emplace();
      for (int i = 0; i < kPoseJoints; ++i) {
        const int joint = (swept + i) % kPoseJoints;
        chain.joints[i] = reversed ? kPoseJoints - 1 - joint : joint;
      }
      chain.dof = kPoseJoints;
      chain.held = chain.joints[0];
      chain.reversed = reversed;
      chain.form.closure = lanes::Closure::loop;
      chain.unit = model.reach;
      chain.loop = std::move(loop);
    }
  }
  return found;
}

}  // namespace iksel
