// SPDX-License-Identifier: BSD-3-Clause
// Makes ordinary and odd chains at random.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include "odd_chain.hpp"

namespace iksel_test {

/// Numbers that are the same on every platform for a seed.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}
  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11U) * 0x1p-53);
  }
  /// One of 0 .. n - 1.
  int pick(int n) { return static_cast<int>(engine_() % static_cast<std::uint64_t>(n)); }
  bool chance(double p) { return uniform(0, 1) < p; }
  Eigen::Vector3d vector(double largest) {
    const double x = uniform(-largest, largest);
    const double y = uniform(-largest, largest);
    return {x, y, uniform(-largest, largest)};
  }

 private:
  std::mt19937_64 engine_;
};

/// A point of the joint space, uniform inside the limits (of continuous joints within a turn).
inline iksel::JointVector random_q(const OddChain& chain, Dice& dice) {
  iksel::JointVector q(chain.dof());
  for (int j = 0; j < chain.dof(); ++j) {
    const double low = chain.lower[j];
    const double high = chain.upper[j];
    q[j] = std::isfinite(low) ? dice.uniform(low, high) : dice.uniform(-3.14, 3.14);
    q[j] = std::min(std::max(q[j], low), high);
  }
  return q;
}

/// Makes chains by throws of dice.
class ChainMaker {
 public:
  explicit ChainMaker(Dice& dice) : dice_(dice) {}

  OddChain make() {
    chain_.ordinary = dice_.chance(0.3);
    if (!chain_.ordinary) {
      constexpr double kScales[] = {1, 1, 1e-3, 1e3};
      chain_.scale = kScales[dice_.pick(4)];
    }
    const int n = chain_.ordinary ? 6 + dice_.pick(2) : joint_count();
    for (int i = 0; i < n; ++i) chain_.joints.push_back(chain_.ordinary ? usual(i) : odd(i));
    if (!chain_.ordinary) {
      chain_.upside_down = dice_.chance(0.2);
      add_followers();
    }
    if (dice_.chance(0.5)) {
      chain_.tcp_xyz = dice_.vector(0.2 * chain_.scale);
      chain_.tcp_rpy = dice_.vector(3);
    }
    number_variables();
    return chain_;
  }

 private:
  /// Small numbers more often than large ones.
  int joint_count() { return dice_.chance(0.7) ? 1 + dice_.pick(9) : 1 + dice_.pick(32); }

  OddJoint usual(int i) {
    OddJoint joint;
    joint.xyz = {dice_.uniform(-0.1, 0.1), dice_.uniform(-0.1, 0.1), dice_.uniform(0.1, 0.4)};
    // Axes across the last one, as most arms have them, or anywhere.
    joint.rpy =
        dice_.chance(0.7) ? Eigen::Vector3d(i % 2 == 0 ? M_PI_2 : -M_PI_2, 0, 0) : dice_.vector(3);
    joint.lower = -dice_.uniform(2, 3.1);
    joint.upper = dice_.uniform(2, 3.1);
    joint.velocity = dice_.uniform(1, 4);
    return joint;
  }

  OddJoint odd(int i) {
    OddJoint joint;
    const int kind = dice_.pick(20);
    joint.type = kind < 13   ? iksel::JointType::revolute
                 : kind < 17 ? iksel::JointType::continuous
                             : iksel::JointType::prismatic;
    place(joint, i);
    if (dice_.chance(0.3)) joint.axis = dice_.vector(1) + Eigen::Vector3d(0, 0, 1.1);
    if (joint.type != iksel::JointType::continuous) set_limits(joint);
    if (dice_.chance(0.2)) joint.velocity = dice_.chance(0.5) ? 1e-6 : 1e6;
    if (i > 0 && dice_.chance(0.06)) {
      joint.locked = true;
      joint.locked_at = dice_.uniform(-2, 2);
    }
    return joint;
  }

  void place(OddJoint& joint, int i) {
    const double s = chain_.scale;
    switch (dice_.pick(6)) {
      case 0:  // on the axis before, turned not at all: aligned with it
        joint.xyz.z() = dice_.uniform(-0.5, 0.5) * s;
        break;
      case 1:  // parallel to it
        joint.xyz = dice_.vector(0.4 * s);
        break;
      case 2:  // meeting it at a right angle
        joint.rpy.x() = i % 2 == 0 ? M_PI_2 : -M_PI_2;
        break;
      case 3:  // meeting it anyhow
        joint.rpy = dice_.vector(3);
        break;
      case 4:  // anywhere, in a length unlike the others'
        joint.xyz = dice_.vector(s * (dice_.chance(0.5) ? 1e-3 : 3));
        joint.rpy = dice_.vector(3);
        break;
      default:
        joint.xyz = dice_.vector(0.4 * s);
        joint.rpy = dice_.vector(3);
    }
  }

  void set_limits(OddJoint& joint) {
    const bool slides = joint.type == iksel::JointType::prismatic;
    const double unit = slides ? chain_.scale : 1;
    switch (dice_.pick(8)) {
      case 0:  // many turns, or far
        joint.lower = -100 * unit;
        joint.upper = 100 * unit;
        break;
      case 1:  // hardly any range
        joint.lower = dice_.uniform(-2, 2) * unit;
        joint.upper = joint.lower + 1e-9 * unit;
        break;
      case 2:  // none at all: such a joint has to be locked
        joint.lower = joint.upper = dice_.uniform(-2, 2) * unit;
        joint.locked = true;
        joint.locked_at = joint.lower;
        break;
      case 3:  // zero lies outside
        joint.lower = dice_.uniform(0.5, 4) * unit;
        joint.upper = joint.lower + dice_.uniform(0.1, 7) * unit;
        break;
      case 4:  // zero is a limit
        joint.lower = 0;
        joint.upper = dice_.uniform(0.5, 3) * unit;
        break;
      default:
        joint.lower = -dice_.uniform(0.2, 6.5) * unit;
        joint.upper = dice_.uniform(0.2, 6.5) * unit;
    }
  }

  /// Some joints follow others, those of chains of followers included.
  void add_followers() {
    for (std::size_t i = 1; i < chain_.joints.size(); ++i) {
      OddJoint& joint = chain_.joints[i];
      const auto source = static_cast<std::size_t>(dice_.pick(static_cast<int>(i)));
      const OddJoint& followed = chain_.joints[source];
      if (joint.locked || followed.locked || !dice_.chance(0.08)) continue;
      // Angles that follow a kilometre are refused: see test_solver.cpp.
      const OddJoint& leader = chain_.joints[source_of(source)];
      const bool turns = joint.type != iksel::JointType::prismatic;
      if (turns && std::max(std::abs(leader.lower), std::abs(leader.upper)) > 100 &&
          leader.type == iksel::JointType::prismatic) {
        continue;
      }
      joint.mimics = static_cast<int>(source);
      joint.multiplier = dice_.uniform(0.2, 2) * (dice_.chance(0.5) ? 1 : -1);
      joint.offset = dice_.uniform(-0.5, 0.5);
      if (joint.type == iksel::JointType::continuous) continue;
      // Its own limits leave all of the other's range, or the middle half.
      const double low = std::isfinite(followed.lower) ? followed.lower : -3;
      const double high = std::isfinite(followed.upper) ? followed.upper : 3;
      const double middle = joint.multiplier * (low + high) / 2 + joint.offset;
      const double half = std::abs(joint.multiplier) * (high - low) / 2;
      const double part = dice_.chance(0.5) ? 1.01 : 0.5;
      joint.lower = middle - part * half - 1e-12;
      joint.upper = middle + part * half + 1e-12;
    }
  }

  std::size_t source_of(std::size_t i) const {
    while (chain_.joints[i].mimics >= 0) i = static_cast<std::size_t>(chain_.joints[i].mimics);
    return i;
  }

  /// Degrees of freedom in the order in which the way from base to tip first meets them.
  void number_variables() {
    chain_.joints[source_of(0)].locked = false;  // one joint at least moves
    OddJoint& first = chain_.joints[0];
    if (first.lower == first.upper) first.upper = first.lower + 1e-9 * chain_.scale;
    const std::size_t n = chain_.joints.size();
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = chain_.upside_down ? n - 1 - k : k;
      if (chain_.joints[i].locked) continue;
      OddJoint& source = chain_.joints[source_of(i)];
      if (source.variable >= 0) continue;
      source.variable = chain_.dof();
      chain_.variables.push_back(static_cast<int>(source_of(i)));
      chain_.lower.push_back(source.lower);
      chain_.upper.push_back(source.upper);
    }
    for (std::size_t i = 0; i < n; ++i) narrow_by(i);
  }

  /// What joint i, which follows another, leaves of that one's range.
  void narrow_by(std::size_t i) {
    const OddJoint& follower = chain_.joints[i];
    if (follower.mimics < 0 || !std::isfinite(follower.lower)) return;
    double multiplier = 1;
    double offset = 0;
    std::size_t k = i;
    for (; chain_.joints[k].mimics >= 0; k = static_cast<std::size_t>(chain_.joints[k].mimics)) {
      offset += multiplier * chain_.joints[k].offset;
      multiplier *= chain_.joints[k].multiplier;
    }
    const double a = (follower.lower - offset) / multiplier;
    const double b = (follower.upper - offset) / multiplier;
    const auto v = static_cast<std::size_t>(chain_.joints[k].variable);
    chain_.lower[v] = std::max(chain_.lower[v], std::min(a, b));
    chain_.upper[v] = std::min(chain_.upper[v], std::max(a, b));
  }

  Dice& dice_;
  OddChain chain_;
};

}  // namespace iksel_test
