// SPDX-License-Identifier: BSD-3-Clause
// Configurations of a self-motion that do not collide, found before they are refined.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <vector>

#include "base/function_ref.hpp"
#include "goal/joint_move.hpp"
#include "scene/scene_data.hpp"
#include "seeds/curve.hpp"
#include "seeds/row_seeds.hpp"
#include "seeds/sweep.hpp"

namespace iksel {

class FreeSamples : public RowSeeds {
 public:
  /// A place of a branch that is not free, or beside which it is looked.
  struct Place {
    enum class Kind { overlap, lower_end, upper_end, between };
    Kind kind;
    Sweep::Sample sample;
    std::array<double, kCurveJoints> q;
    double clearance = 0;  ///< of an overlap (scene_types.hpp)
    int number = 0;        ///< and in the order in which they were found
  };
  /// What it writes to.
  struct Memory {
    std::vector<double> q;
    std::vector<Sweep::Sample> samples;
    /// Of each sample of each branch; infinite: there is none, or it is free.
    std::vector<double> clearance;
    std::vector<Place> overlaps;
    /// Where it is looked between samples: beside overlaps that are less than those beside them,
    /// the least first; where a branch leaves the limits, or ends; and where it is inside the
    /// limits between two samples, but at neither.
    std::vector<Place> places;
  };

  /// About so many at `most`. All must outlive this. Nothing may touch that is where it is in all
  /// solutions.
  FreeSamples(Sweep& sweep, const Scene& scene, const Pose& Y, Memory& memory, Work& work,
              std::size_t most = std::numeric_limits<std::size_t>::max());

  /// The samples of the sweep, those far from each other first; where none is free, between the
  /// samples beside those that overlap least; towards where branches leave the limits; and where
  /// they are inside these only between samples.
  bool next_stage();

  /// Whether the arm can reach the target at all inside the limits, as far as was seen.
  [[nodiscard]] bool has_any() const { return has_any_; }
  /// Whether as many as are wanted were given.
  [[nodiscard]] bool has_most() const { return given_ >= most_; }

 private:
  [[nodiscard]] std::size_t rows() const { return to_.q.size() / kCurveJoints; }
  [[nodiscard]] const double* row(std::size_t i) const { return &to_.q[i * kCurveJoints]; }
  /// Makes rows of the next part; false if there are no more.
  bool add_rows();
  /// The same where no sample is free.
  bool add_rows_between();
  /// The next place; null if there are no more.
  const Place* next_place();
  [[nodiscard]] bool is_peak(const Place& overlap) const;
  void find_peaks_and_ends();
  [[nodiscard]] double& clearance(int place, int branch) const {
    return to_.clearance[static_cast<std::size_t>(place) * lanes::kWidth +
                         static_cast<std::size_t>(branch)];
  }
  [[nodiscard]] bool exists(int place, int branch) const {
    return clearance(place, branch) < kInfinity;
  }
  /// Looks at the next rows, as many as there are lanes. Returns how many are free.
  std::size_t screen_pack();

  Sweep& sweep_;
  const Scene& scene_;
  SceneLook look_;
  Memory& to_;
  std::size_t most_;
  std::size_t given_ = 0;
  std::size_t at_ = 0;      ///< row to be looked at next
  int part_ = 0;            ///< of the samples
  std::size_t place_ = 0;   ///< that is looked beside next
  bool has_peaks_ = false;  ///< whether these are among the places
  bool has_between_ = false;
  /// What overlaps least of the last peak and what is beside it.
  std::optional<Place> beside_;
  bool has_any_ = false;
  std::array<double, lanes::kWidth * kCurveJoints> free_{};
};

/// Which of `count` rows of joint values pass.
using Passes = FunctionRef<void(const double* q, std::size_t count, bool* keep)>;

/// Of the points on the arcs that pass the `most` nearest to `near`, row by row. False if there is
/// no point at all.
bool find_nearest_passing(const std::vector<Curve::Arc>& arcs, const Passes& passes,
                          const JointSpace& joints, const JointVector& near, const JointMove& move,
                          std::size_t most, std::vector<double>& q);

}  // namespace iksel
