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
  /// Solves the target with the i-th arm, or for the crossings of a side: a number of joint values,
  /// inside the limits or so near to them that it cannot be told. False if there may be others.
  bool find(std::size_t i, const Pose& T_base_tcp);
  /// Whether it can be told in closed form that no curve of solutions lies inside the limits: none
  /// goes through one of the places.
  [[nodiscard]] bool are_closed() const { return are_closed_; }
  /// Whether that is so.
  bool rules_out(const Pose& T_base_tcp);
  [[nodiscard]] int count() const { return solutions_ != nullptr ? solutions_->size() : 0; }
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
  struct Crossing {
    const Elbow* elbow;
    End first;
    Pose base, base_inverse, tip_inverse;  ///< of the whole kernel chain
  };

  bool find_crossings(std::size_t side, const Pose& T_base_tcp);
  bool solve(End& end, const Pose& T_base_tcp);

  const JointSpace& joints_;
  std::vector<End> ends_;
  bool are_all_;
  bool are_closed_;
  std::optional<Crossing> crossing_;
  // Of the last find().
  const BranchList* solutions_ = nullptr;
  int joint_ = 0;      ///< that is locked
  double locked_ = 0;  ///< and where [rad or m]
  std::vector<std::array<double, 7>> kept_;
};

/// These as a source of seeds, a place a stage.
class EndSeeds {
 public:
  EndSeeds(ArcEnds& ends, const Pose& T_base_tcp, Work& work, StageClock& clock)
      : ends_(ends), target_(T_base_tcp), work_(work), clock_(clock), certain_(ends.are_all()) {
    ends_.begin();
  }

  bool next_stage() {
    if (is_through()) return false;
    if (!ends_.find(place_++, target_)) certain_ = false;
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
  [[nodiscard]] bool is_certain() const { return certain_ && is_through(); }
  /// Whether there certainly is no solution.
  [[nodiscard]] bool is_none() const { return is_certain() && ends_.are_closed() && count() == 0; }

 private:
  [[nodiscard]] bool is_through() const { return place_ == ends_.places(); }

  ArcEnds& ends_;
  const Pose& target_;
  Work& work_;
  StageClock& clock_;
  bool certain_;
  std::size_t place_ = 0;
  int next_ = 0;
};

}  // namespace iksel
