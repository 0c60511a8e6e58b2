// SPDX-License-Identifier: BSD-3-Clause
// Along the self-motions of seven joints: a curve in each lane (curve_kernel.hpp), and where it
// leaves the limits.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "base/function_ref.hpp"
#include "iksel/self_motion.hpp"
#include "kinematics/chain_model.hpp"
#include "simd/kernels.hpp"

namespace iksel {

class CurveWalker {
 public:
  using Joints = std::array<double, kCurveJoints>;
  /// A configuration on a curve, and a unit vector along it.
  struct Place {
    Joints q, tangent;
  };
  /// What a lane goes from one place to the next: a cubic for each joint.
  struct Step {
    const Place &from, &to;
    double way;

    [[nodiscard]] Joints at(double part) const;
  };
  /// A configuration between two of a step, where it leaves a limit.
  struct Exit {
    double part;  ///< of the way; above 1: it does not
    SelfMotionEnd at;
  };
  /// What lies beyond a limit by no more is at it [rad or m].
  static constexpr double kAtLimit = 1e-7;

  CurveWalker(const ChainModel& model, const lanes::LaneKernels& kernels);

  /// For a target (reduction.hpp), with steps up to so long [rad and m].
  void set_target(const Pose& Y, double longest);
  [[nodiscard]] double longest() const { return pack_.longest; }
  [[nodiscard]] bool is_inside(const Joints& q) const;
  /// Brings places nearer to their curves, on them but for rounding where they are near, and finds
  /// the tangents there, oriented.
  void orient(Place* places, std::size_t count);
  /// Where a step leaves the limits first.
  [[nodiscard]] Exit exit(const Step& step) const;

  /// Follows curves, as many at a time as there are lanes. `begin(lane, from, is_reversed)` gives
  /// the next to follow, and whether against the orientation; false: there is none. `advance(lane,
  /// step)` takes a step; false: it ends there. `stop(lane)` ends it at a singularity.
  void follow(FunctionRef<bool(int lane, Place& from, bool& is_reversed)> begin,
              FunctionRef<bool(int lane, const Step& step)> advance,
              FunctionRef<void(int lane)> stop);
  /// In the course of it: goes on at another image of where a lane is.
  void turn_to(int lane, const Joints& image);

 private:
  /// Where one of a step's values leaves a limit, if that is before `first`.
  static void look_at_limit(const Limit& limit, const Step& step, Exit& first);

  lanes::LaneChain chain_;
  const lanes::LaneKernels& kernels_;
  std::vector<Limit> limits_;
  lanes::CurvePack pack_{}, probe_{};
  std::array<Place, lanes::kWidth> at_{};  ///< where each lane is
};

}  // namespace iksel
