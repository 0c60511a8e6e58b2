// SPDX-License-Identifier: BSD-3-Clause
// Where the arcs of a self-motion of seven joints end: inside the limits they end where a joint is
// at a limit, and there the six others solve the pose with that joint locked.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "base/work.hpp"
#include "iksel/self_motion.hpp"
#include "seeds/enumeration.hpp"
#include "seeds/root_sweep.hpp"
#include "structure/locked_arms.hpp"

namespace iksel {

class ArcEnds {
 public:
  /// Tolerances are the solver's [m, rad]. `arms` has to outlive this.
  ArcEnds(const LockedArms& arms, double position_tolerance, double rotation_tolerance,
          const lanes::LaneKernels& kernels);

  [[nodiscard]] std::size_t size() const { return ends_.size(); }
  /// Which limit the i-th arm is locked at.
  [[nodiscard]] SelfMotionEnd limit(std::size_t i) const {
    const LockedArm& arm = *ends_[i].arm;
    return {ArcEnd::limit, arm.joint, arm.is_upper};
  }
  /// Solves the target with the i-th arm: a number of joint values, inside the limits or so near
  /// to them that it cannot be told. False if there may be others.
  bool find(std::size_t i, const Pose& T_base_tcp);
  [[nodiscard]] int count() const { return count_; }
  /// The k-th solution of the last find(), seven joint values [rad or m]; kept until begin().
  const double* keep(int k);
  /// Forgets what is kept.
  void begin() { kept_.clear(); }
  [[nodiscard]] int kept() const { return static_cast<int>(kept_.size()); }
  [[nodiscard]] const double* kept(int i) const {
    return kept_[static_cast<std::size_t>(i)].data();
  }
  /// Whether each end that a joint's limit could make is looked for.
  [[nodiscard]] bool are_all() const { return are_all_; }

 private:
  struct End {
    const LockedArm* arm;
    Pose base_inverse, tip_inverse;  ///< of its kernel chain
    std::optional<Enumeration> branches;
    std::optional<RootSweep> roots;
  };

  std::vector<End> ends_;
  bool are_all_;
  const End* last_ = nullptr;
  bool by_roots_ = false;
  int count_ = 0;
  std::vector<std::array<double, 7>> kept_;
};

/// These as a source of seeds, an arm a stage.
class EndSeeds {
 public:
  EndSeeds(ArcEnds& ends, const Pose& T_base_tcp, Work& work, StageClock& clock)
      : ends_(ends), target_(T_base_tcp), work_(work), clock_(clock), certain_(ends.are_all()) {
    ends_.begin();
  }

  bool next_stage() {
    if (arm_ == ends_.size()) return false;
    if (!ends_.find(arm_++, target_)) certain_ = false;
    next_ = 0;
    clock_.lap(&StageTimes::query);
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (next_ == ends_.count()) return false;
    work_.take_on_top();
    refiner.load_seed(lane, ends_.keep(next_++));
    return true;
  }
  /// Those that were tried, seven joint values each [rad or m].
  [[nodiscard]] int count() const { return ends_.kept(); }
  [[nodiscard]] const double* q(int i) const { return ends_.kept(i); }
  /// Whether no arc has an end but these, and each was tried.
  [[nodiscard]] bool is_certain() const { return certain_ && arm_ == ends_.size(); }

 private:
  ArcEnds& ends_;
  const Pose& target_;
  Work& work_;
  StageClock& clock_;
  bool certain_;
  std::size_t arm_ = 0;
  int next_ = 0;
};

}  // namespace iksel
