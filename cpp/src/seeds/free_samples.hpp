// SPDX-License-Identifier: BSD-3-Clause
// Configurations of a self-motion that do not collide, found before they are refined.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "goal/joint_move.hpp"
#include "scene/scene_data.hpp"
#include "seeds/self_motion_arcs.hpp"
#include "seeds/sweep.hpp"

namespace iksel {

class FreeSamples {
 public:
  /// A sample that is not free.
  struct Overlap {
    double clearance;  ///< scene_types.hpp
    Sweep::Sample sample;
    std::array<double, SweptBranches::kDof> q;
  };
  struct Known {
    /// Of a sample that collides; infinite: it does not exist, or is free.
    float clearance = std::numeric_limits<float>::infinity();
    /// By what it collides; 0: not known.
    std::uint32_t culprit = 0;
  };
  /// What it writes to.
  struct Memory {
    std::vector<double> q;
    std::vector<Sweep::Sample> samples;
    /// Of each sample of each branch, what is known about it.
    std::vector<Known> known;
    std::vector<Overlap> overlaps;
  };

  /// All must outlive this. Nothing may touch that is where it is in all solutions.
  FreeSamples(Sweep& sweep, const Scene& scene, const Pose& Y, Memory& memory, Work& work,
              StageClock& clock);

  /// The samples of the sweep, those far from each other first; where none is free, between the
  /// samples beside those that overlap least; where there is none at all, between the samples
  /// beside where the sweep finds an answer.
  bool next_stage();

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

  [[nodiscard]] std::size_t rows() const { return to_.q.size() / kDof; }
  [[nodiscard]] const double* row(std::size_t i) const { return &to_.q[i * kDof]; }
  /// Makes rows of the next part; false if there are no more.
  bool add_rows();
  /// Makes rows beside an answer between the samples; false if there is none.
  bool add_between();
  /// The next of those that overlap least; null if there are no more.
  const Overlap* next_overlap();
  /// Whether there may be free configurations between an overlap and the samples beside it.
  [[nodiscard]] bool may_be_free_beside(const Overlap& overlap) const;
  [[nodiscard]] Known& known(int place, int branch) const {
    return to_.known[static_cast<std::size_t>(place) * kPack + static_cast<std::size_t>(branch)];
  }
  /// Looks at the next rows, as many as there are lanes.
  void screen_pack();

  Sweep& sweep_;
  const Scene& scene_;
  const Pose& Y_;
  SceneLook look_;
  Memory& to_;
  Work& work_;
  StageClock& clock_;
  std::size_t at_ = 0;      ///< row to be looked at next
  int part_ = 0;            ///< of the samples
  std::size_t beside_ = 0;  ///< overlaps that were looked beside
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
