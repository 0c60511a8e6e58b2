// SPDX-License-Identifier: BSD-3-Clause
// Configurations of a self-motion that do not collide, found before they are refined: a scene looks
// at a pack of them at a time.
#pragma once

#include <algorithm>
#include <array>
#include <vector>

#include "goal/joint_move.hpp"
#include "iksel/scene.hpp"
#include "seeds/self_motion_arcs.hpp"
#include "seeds/sweep.hpp"

namespace iksel {

class FreeSamples {
 public:
  /// `memory` is written to. All must outlive this.
  FreeSamples(Sweep& sweep, SelfMotionArcs& arcs, const Scene& scene, const Pose& Y,
              std::vector<double>& memory, Work& work, StageClock& clock)
      : sweep_(sweep), arcs_(arcs), scene_(scene), Y_(Y), q_(memory), work_(work), clock_(clock) {
    q_.clear();
  }

  /// The samples of the sweep, those far from each other first; where none is free, points close to
  /// each other all along the arcs.
  bool next_stage() {
    while (free_count_ = 0, next_ = 0, at_ < rows() || add_rows()) {
      screen_pack();
      if (free_count_ > 0) break;
    }
    clock_.lap(&StageTimes::query);
    return free_count_ > 0;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (next_ == free_count_) return false;
    work_.take_on_top();
    refiner.load_answer(lane, row(free_[next_++]));
    return true;
  }
  /// Whether the arm can reach the target at all inside the limits, as far as was seen.
  [[nodiscard]] bool has_any() const { return has_any_; }

 private:
  static constexpr std::size_t kDof = SweptBranches::kDof;
  static constexpr std::size_t kPack = SweptBranches::kCount;
  /// The samples of the sweep come in so many parts.
  static constexpr int kParts = 16;
  /// Between points on the arcs no joint moves farther [rad].
  static constexpr double kSpacing = 0.03;

  [[nodiscard]] std::size_t rows() const { return q_.size() / kDof; }
  [[nodiscard]] const double* row(std::size_t i) const { return &q_[i * kDof]; }

  /// False if there are no more.
  bool add_rows() {
    while (at_ == rows()) {
      if (part_ > kParts || (part_ == kParts && !has_any_)) return false;
      q_.clear();
      at_ = 0;
      if (part_ == kParts) {
        add_arcs();
      } else {
        constexpr int kSpread = 7;
        sweep_.add_samples(Y_, part_ * kSpread % kParts, kParts, q_);
      }
      ++part_;
      has_any_ = has_any_ || !q_.empty();
    }
    return true;
  }

  void add_arcs() {
    arcs_.find(Y_, kSpacing);
    for (const SelfMotionArcs::Arc& arc : arcs_.arcs()) {
      for (const SelfMotionArcs::Joints& q : arc.q) q_.insert(q_.end(), q.begin(), q.end());
    }
  }

  void screen_pack() {
    const std::size_t count = std::min(kPack, rows() - at_);
    std::array<bool, kPack> free{};
    scene_.find_free(row(at_), count, free.data());
    for (std::size_t i = 0; i < count; ++i) {
      if (free[i]) free_[free_count_++] = at_ + i;
    }
    at_ += count;
  }

  Sweep& sweep_;
  SelfMotionArcs& arcs_;
  const Scene& scene_;
  const Pose& Y_;
  std::vector<double>& q_;
  Work& work_;
  StageClock& clock_;
  std::size_t at_ = 0;  ///< row to be looked at next
  int part_ = 0;
  bool has_any_ = false;
  std::array<std::size_t, kPack> free_{};
  std::size_t free_count_ = 0;
  std::size_t next_ = 0;
};

/// Of the points on the arcs that are free the `most` nearest to `near`, row by row. False if there
/// is no point at all.
bool find_nearest_free(const SelfMotionArcs& arcs, const Scene& scene, const JointSpace& joints,
                       const JointVector& near, const JointMove& move, std::size_t most,
                       std::vector<double>& q);

}  // namespace iksel
