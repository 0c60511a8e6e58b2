// SPDX-License-Identifier: BSD-3-Clause
// Along the self-motions of seven joints: a curve in each lane (curve_kernel.hpp), and where it
// leaves the limits.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

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

    /// Of the other way along the curve.
    [[nodiscard]] Place reversed() const;
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
    const Limit* limit;
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
  /// That place, on the curve and at the limit but for rounding.
  [[nodiscard]] Place leave(const Step& step, const Exit& exit);

  /// Follows curves, as many at a time as there are lanes. `walks.begin(lane, from, is_reversed)`
  /// gives the next to follow, and whether against the orientation; false: there is none.
  /// `walks.advance(lane, step)` takes a step; false: it ends there. `walks.stop(lane)` ends it at
  /// a singularity.
  template <typename Walks>
  void follow(Walks& walks);
  /// In the course of it: goes on at another image of where a lane is.
  void turn_to(int lane, const Joints& image);

 private:
  void start(int lane, bool is_reversed);
  /// After a step.
  [[nodiscard]] Place place(int lane) const;
  /// Where one of a step's values leaves a limit, if that is before `first`.
  static void look_at_limit(const Limit& limit, const Step& step, Exit& first);

  lanes::LaneChain chain_;
  const lanes::LaneKernels& kernels_;
  std::vector<Limit> limits_;
  lanes::CurvePack pack_{}, probe_{};
  std::array<Place, lanes::kWidth> at_{};  ///< where each lane is
};

double way_between(const CurveWalker::Joints& a, const CurveWalker::Joints& b);

template <typename Walks>
void CurveWalker::follow(Walks& walks) {
  /// A walk that comes to so short steps is at a singularity [rad and m].
  constexpr double kShortest = 1e-6;
  unsigned busy = 0;
  const auto bit = [](int lane) { return 1U << static_cast<unsigned>(lane); };
  const auto load = [&](int lane) {
    bool is_reversed = false;
    const bool is_busy = walks.begin(lane, at_[static_cast<std::size_t>(lane)], is_reversed);
    if (is_busy) start(lane, is_reversed);
    return is_busy;
  };
  for (int lane = 0; lane < lanes::kWidth; ++lane) {
    if (load(lane)) busy |= bit(lane);
  }
  while (busy != 0) {
    const unsigned went = kernels_.follow_curves(chain_, pack_);
    for (int lane = 0; lane < lanes::kWidth; ++lane) {
      if ((busy & bit(lane)) == 0) continue;
      if ((went & bit(lane)) != 0) {
        Place& at = at_[static_cast<std::size_t>(lane)];
        const Place from = at;
        at = place(lane);
        const Place to = at;
        if (walks.advance(lane, Step{from, to, way_between(from.q, to.q)})) continue;
      } else {
        if (pack_.step[lane] >= kShortest) continue;
        walks.stop(lane);
      }
      if (!load(lane)) busy &= ~bit(lane);
    }
  }
}

}  // namespace iksel
