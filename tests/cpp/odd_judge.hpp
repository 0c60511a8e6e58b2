// SPDX-License-Identifier: BSD-3-Clause
// Judges answers for odd chains by nothing of the library's: forward kinematics and limits of
// odd_chain.hpp, errors and boxes as task.hpp defines them.
#pragma once

#include <array>
#include <sstream>
#include <string>

#include "odd_chain.hpp"

namespace iksel_test {

using RealVector = Eigen::Matrix<Real, 3, 1>;
using RealMatrix = Eigen::Matrix<Real, 3, 3>;

/// The rotation vector of E, for angles below pi.
inline RealVector rotation_vector(const RealMatrix& E) {
  const RealVector sine(E(2, 1) - E(1, 2), E(0, 2) - E(2, 0), E(1, 0) - E(0, 1));
  const Real twice = sine.norm();
  const Real angle = std::atan2(twice, E.trace() - 1);
  return twice > 0 ? RealVector(sine * (angle / twice)) : RealVector::Zero();
}

/// What a task is about, as this judge knows them.
enum class OddTask { pose, position_only, free_spin, upright, planar, box };

struct OddGoal {
  OddTask kind = OddTask::pose;
  int axis = 2;
  double position_width = 0;  ///< box: along each of the tool's axes [m]
  double rotation_width = 0;  ///< box: about each of them [rad]

  [[nodiscard]] iksel::Task task() const {
    const auto of_axis = static_cast<iksel::Axis>(axis);
    const double p = position_width;
    const double r = rotation_width;
    switch (kind) {
      case OddTask::position_only:
        return iksel::Task::position_only();
      case OddTask::free_spin:
        return iksel::Task::free_spin(of_axis);
      case OddTask::upright:
        return iksel::Task::upright(of_axis);
      case OddTask::planar:
        return iksel::Task::planar(of_axis);
      case OddTask::box:
        return iksel::Task::box({p, p, p}, {r, r, r});
      default:
        return {};
    }
  }
};

/// How far a pose lies outside of a goal: [m] and [rad].
struct Miss {
  Real position = 0;
  Real rotation = 0;
};

inline Real beyond(Real value, Real width) { return std::max(Real(0), std::abs(value) - width); }

inline Miss miss_of(const OddGoal& goal, const iksel::Pose& target, const RealPose& reached) {
  const RealMatrix R_target = target.linear().cast<Real>();
  const RealMatrix R = reached.linear();
  const RealVector d = reached.translation() - target.translation().cast<Real>();
  const RealVector axis = RealVector::Unit(goal.axis);
  const RealMatrix in_tool = R_target.transpose() * R;
  const RealMatrix in_base = R * R_target.transpose();
  const auto swing = [&](const RealMatrix& E) {
    const RealVector turned = E * axis;
    return std::atan2(axis.cross(turned).norm(), axis.dot(turned));
  };
  Miss miss{d.norm(), 0};
  switch (goal.kind) {
    case OddTask::pose:
      miss.rotation = rotation_vector(in_base).norm();
      break;
    case OddTask::position_only:
      break;
    case OddTask::free_spin:
      miss.rotation = swing(in_tool);
      break;
    case OddTask::upright:
      miss.rotation = swing(in_base);
      break;
    case OddTask::planar: {
      miss.position = (d - d.dot(axis) * axis).norm();
      const Eigen::Quaternion<Real> turn(in_base);
      const Real half = std::atan2(turn.vec().dot(axis), turn.w());
      miss.rotation = std::abs(std::remainder(2 * half, 2 * std::acos(Real(-1))));
      break;
    }
    case OddTask::box: {
      const RealVector position = R_target.transpose() * d;
      const RealVector rotation = rotation_vector(in_tool);
      RealVector p;
      RealVector r;
      for (int i = 0; i < 3; ++i) {
        p[i] = beyond(position[i], goal.position_width);
        r[i] = beyond(rotation[i], goal.rotation_width);
      }
      miss = {p.norm(), r.norm()};
    }
  }
  return miss;
}

/// Whether every joint of the chain, followers included, lies inside its limits at q.
inline bool inside_limits(const OddChain& chain, const iksel::JointVector& q, std::string& why) {
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    const OddJoint& joint = chain.joints[i];
    if (joint.locked || joint.type == iksel::JointType::continuous) continue;
    const Real value = value_of(chain, i, q);
    // A follower's limits reach the joint it follows through a division.
    const Real room = joint.mimics < 0 ? 0 : 1e-12L * (1 + std::abs(value));
    if (value >= joint.lower - room && value <= joint.upper + room) continue;
    why = "joint j" + std::to_string(i) + " is outside of its limits";
    return false;
  }
  return true;
}

/// A length that the chain cannot outgrow much [m].
inline double length_of(const OddChain& chain) {
  double length = chain.tcp_xyz.norm();
  for (const OddJoint& joint : chain.joints) {
    length += joint.xyz.norm();
    if (joint.type == iksel::JointType::prismatic && std::isfinite(joint.lower)) {
      length += std::max(std::abs(joint.lower), std::abs(joint.upper));
    }
  }
  return length;
}

/// Empty if q is an answer; else what is wrong with it.
inline std::string judge(const OddChain& chain, const iksel::SolverOptions& options,
                         const OddGoal& goal, const iksel::Pose& target,
                         const iksel::JointVector& q) {
  if (q.size() != chain.dof()) return "of the wrong length";
  if (!q.allFinite()) return "not finite";
  std::string why;
  if (!inside_limits(chain, q, why)) return why;
  const Miss miss = miss_of(goal, target, forward(chain, q));
  // What the library's doubles cannot tell, over so many joints and so much length.
  const double digits = 1e-14 * static_cast<double>(chain.joints.size() + 1);
  const Real position = options.position_tolerance + digits * length_of(chain);
  const Real rotation = options.rotation_tolerance + digits;
  if (miss.position <= position && miss.rotation <= rotation) return "";
  std::ostringstream text;
  text << "misses by " << miss.position << " m of " << position << " and " << miss.rotation
       << " rad of " << rotation;
  return text.str();
}

}  // namespace iksel_test
