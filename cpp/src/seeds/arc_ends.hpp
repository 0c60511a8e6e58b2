// SPDX-License-Identifier: BSD-3-Clause
// Where the arcs of a self-motion of seven joints end: inside the limits they end where a joint is
// at a limit, and there the six others solve the pose with that joint locked.
#pragma once

#include <optional>
#include <vector>

#include "iksel/self_motion.hpp"
#include "seeds/enumeration.hpp"
#include "seeds/root_sweep.hpp"
#include "structure/locked_arms.hpp"

namespace iksel {

class ArcEnds {
 public:
  /// Tolerances are the solver's [m, rad]. `whole` and its `arms` have to outlive this.
  ArcEnds(const ChainModel& whole, const LockedArms& arms, double position_tolerance,
          double rotation_tolerance, const lanes::LaneKernels& kernels);

  [[nodiscard]] std::size_t size() const { return ends_.size(); }
  /// Which limit the i-th arm is locked at.
  [[nodiscard]] SelfMotionEnd limit(std::size_t i) const {
    const LockedArm& arm = *ends_[i].arm;
    return {ArcEnd::limit, arm.joint, arm.is_upper};
  }
  /// The ends, and where closed curves cross the plane of the elbow, on either side of the first
  /// axis.
  [[nodiscard]] std::size_t places() const { return size() + (crossing_ ? 2 : 0); }
  /// Solves the target with the i-th arm, or for the crossings of a side: adds what is inside the
  /// limits, or so near to them that it cannot be told. False if there may be others.
  bool find(std::size_t i, const Pose& T_base_tcp);
  /// Whether every end is found.
  [[nodiscard]] bool are_all() const { return are_all_; }
  /// Whether it can be told in closed form that no curve of solutions lies inside the limits: none
  /// goes through one of the places.
  [[nodiscard]] bool are_closed() const { return are_closed_; }
  /// Forgets what was added.
  void begin() { found_.clear(); }
  [[nodiscard]] int count() const { return static_cast<int>(found_.size() / kCurveJoints); }
  [[nodiscard]] const std::vector<double>& found() const { return found_; }
  /// Seven joint values [rad or m].
  [[nodiscard]] const double* q(int i) const { return found_.data() + kCurveJoints * i; }

 private:
  struct End {
    const LockedArm* arm;
    Pose base_inverse, tip_inverse;  ///< of its kernel chain
    std::optional<Enumeration> branches;
    std::optional<RootSweep> roots;
  };
  struct Crossing {
    const Elbow* elbow;
    End first;
    Pose base, base_inverse, tip_inverse;  ///< of the whole kernel chain
  };

  bool find_crossings(std::size_t side, const Pose& T_base_tcp);
  /// With the end's joint locked at a value [rad or m].
  bool solve(End& end, double locked, const Pose& T_base_tcp);

  const JointSpace& joints_;
  std::vector<End> ends_;
  bool are_all_, are_closed_;
  std::optional<Crossing> crossing_;
  std::vector<double> found_;
};

}  // namespace iksel
