// SPDX-License-Identifier: BSD-3-Clause
// Random chains of six joints whose axes lie so that they are solved in closed form, and the
// configurations at which that is hardest.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>
#include <utility>
#include <vector>

#include "kinematics/chain_model.hpp"
#include "odd_maker.hpp"
#include "simd/branch_types.hpp"
#include "structure/closed_form.hpp"

namespace iksel_test {

using iksel::lanes::Closure;

inline constexpr Closure kClosures[] = {Closure::parallel_23, Closure::intersect_12,
                                        Closure::intersect_23, Closure::parallel_12,
                                        Closure::three_parallel};

/// Unit vectors along axes and points on them where all angles are zero, in the base frame.
struct AxisChain {
  std::vector<Eigen::Vector3d> h, p;

  void reverse() {
    std::reverse(h.begin(), h.end());
    std::reverse(p.begin(), p.end());
  }
};

/// How one axis lies to the next.
enum class Pair { none, parallel, meeting };

class AxisMaker {
 public:
  explicit AxisMaker(Dice& dice) : dice_(dice) {}

  /// Six axes that lie anyhow, but for that of number `first`, counted from 0, and the next.
  AxisChain make(Pair pair, std::size_t first) {
    AxisChain axes;
    for (std::size_t j = 0; j < 6; ++j) {
      const bool is_parallel = pair == Pair::parallel && j == first + 1;
      axes.h.push_back(j == 0 ? direction() : is_parallel ? axes.h[first] : across(axes.h[j - 1]));
      axes.p.push_back(dice_.vector(0.5));
    }
    if (pair == Pair::meeting) meet(axes, first, 2);
    return axes;
  }

  /// Six axes of that class, seen from the front or, as a spherical shoulder, from the end. The
  /// class's parallel axes may point opposite ways.
  AxisChain make(Closure closure, bool reversed) {
    // Whether axis j is parallel to the one before.
    const auto is_parallel = [&](int j) {
      switch (closure) {
        case Closure::parallel_12:
          return j == 1;
        case Closure::parallel_23:
        case Closure::sweep_4:
        case Closure::sweep_6:
          return j == 2;
        case Closure::three_parallel:
          return j == 2 || j == 3;
        default:
          return false;
      }
    };
    AxisChain axes;
    axes.h.push_back(direction());
    for (int j = 1; j < 6; ++j) {
      const Eigen::Vector3d before = axes.h.back();
      const double sign = dice_.chance(0.5) ? 1 : -1;
      axes.h.push_back(is_parallel(j) ? Eigen::Vector3d(sign * before) : across(before));
    }
    for (int j = 0; j < 6; ++j) axes.p.push_back(dice_.vector(0.5));
    if (closure == Closure::intersect_12) meet(axes, 0, 2);
    if (closure == Closure::intersect_23) meet(axes, 1, 2);
    if (closure == Closure::three_parallel || closure == Closure::sweep_4) {
      meet(axes, 4, 2);
    } else if (closure == Closure::sweep_6) {
      meet(axes, 3, 2);
    } else {
      meet(axes, 3, 3);
    }
    if (reversed) axes.reverse();
    return axes;
  }

  Eigen::Vector3d direction() {
    Eigen::Vector3d v = dice_.vector(1);
    while (v.norm() < 0.1 || v.norm() > 1) v = dice_.vector(1);
    return v.normalized();
  }

 private:
  static bool is_flat(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return a.cross(b).norm() < 0.4;
  }
  /// At a right angle to v as most arms have it, or at any that is not small.
  Eigen::Vector3d across(const Eigen::Vector3d& v) {
    Eigen::Vector3d other = direction();
    while (is_flat(v, other)) other = direction();
    return dice_.chance(0.4) ? v.cross(other).normalized() : other;
  }
  /// `count` axes from `first` on meet in a point; those on them lie anywhere else.
  void meet(AxisChain& axes, std::size_t first, std::size_t count) {
    const Eigen::Vector3d centre = dice_.vector(0.5);
    for (std::size_t i = first; i < first + count; ++i) {
      axes.p[i] = centre + dice_.uniform(-0.3, 0.3) * axes.h[i];
    }
  }

  Dice& dice_;
};

/// Joints about these axes, with a tool behind; without limits, or with the same for all.
inline iksel::Robot make_robot(const AxisChain& axes, Dice& dice, double limit = 0) {
  OddChain chain;
  Eigen::Vector3d before = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < axes.h.size(); ++i) {
    OddJoint joint;
    joint.type = limit > 0 ? iksel::JointType::revolute : iksel::JointType::continuous;
    joint.xyz = axes.p[i] - before;
    joint.axis = axes.h[i];
    joint.lower = -limit;
    joint.upper = limit;
    before = axes.p[i];
    chain.joints.push_back(joint);
  }
  chain.tcp_xyz = dice.vector(0.2);
  chain.tcp_rpy = dice.vector(3);
  return iksel::Robot::from_urdf_string(urdf_of(chain), robot_options(chain));
}

/// A pose as forms of closed chains have it (reduction.hpp).
inline iksel::Pose reduced(const iksel::Robot& robot, const iksel::Pose& T_base_tcp) {
  const iksel::KernelChain& kernel = robot.model().kernel;
  return iksel::to_pose(kernel.base).inverse() * T_base_tcp * iksel::to_pose(kernel.tip).inverse();
}

/// The joint values in a lane.
inline iksel::JointVector branch_of(const iksel::ClosedFormChain& chain,
                                    const iksel::lanes::BranchPack& pack, int lane) {
  iksel::JointVector q(6);
  chain.copy_joints(pack.q, lane, q.data());
  return q;
}

/// The pose, off by at most so much [m, rad].
inline iksel::Pose shifted(const iksel::Pose& pose, double position, double rotation, Dice& dice) {
  AxisMaker maker(dice);
  iksel::Pose other = pose;
  other.linear() =
      Eigen::AngleAxisd(rotation, maker.direction()).toRotationMatrix() * pose.linear();
  other.translation() += position * maker.direction();
  return other;
}

/// Of a solver with tolerances of 3 cm and 0.1 rad, for poses that far off the configurations'.
inline void expect_no_proof_at_large_tolerances(const iksel::Robot& robot,
                                                const std::vector<iksel::JointVector>& reached,
                                                Dice& dice) {
  iksel::SolverOptions options;
  options.position_tolerance = 0.03;
  options.rotation_tolerance = 0.1;
  const iksel::Solver rough(robot, options);
  for (const iksel::JointVector& q : reached) {
    const iksel::Pose target = shifted(robot.fk(q), 0.029, 0.099, dice);
    const iksel::Result result = rough.solve(target);
    EXPECT_TRUE(result.success() || result.proof == iksel::Proof::none) << q.transpose();
  }
}

/// Moves joint j of q to where the arm is singular, if it comes to such a place inside the limits.
inline bool make_singular(const iksel::Robot& robot, int j, iksel::JointVector& q) {
  const double low = std::isfinite(robot.lower()[j]) ? robot.lower()[j] : -3.14;
  const double high = std::isfinite(robot.upper()[j]) ? robot.upper()[j] : 3.14;
  const auto determinant = [&](double value) {
    q[j] = value;
    return Eigen::Matrix<double, 6, 6>(robot.jacobian(q)).determinant();
  };
  constexpr int kSteps = 32;
  double a = low;
  double at_a = determinant(a);
  for (int k = 1; k <= kSteps; ++k) {
    double b = low + (high - low) * k / kSteps;
    const double at_b = determinant(b);
    if (at_a * at_b < 0) {
      for (int halved = 0; halved < 52; ++halved) {
        const double middle = (a + b) / 2;
        (determinant(middle) * at_a > 0 ? a : b) = middle;
      }
      q[j] = a;
      return true;
    }
    a = b;
    at_a = at_b;
  }
  return false;
}

}  // namespace iksel_test
