// SPDX-License-Identifier: BSD-3-Clause
// Query and rank: the seeds for one target, best first; and re-selection among them.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "database/data.hpp"
#include "iksel/options.hpp"
#include "kinematics/chain_model.hpp"
#include "seeds/candidate_queue.hpp"
#include "seeds/row_seeds.hpp"

namespace iksel {

/// Picks seeds for one target. Memory is taken at construction, none later.
class Selection {
 public:
  /// `nominal` is the chain that the data belongs to; `model` may differ from it a little. Both may
  /// be null for a full key, and a scheme that asks for no limits.
  Selection(const ChainModel* model, const ChainModel* nominal, const DatabaseData& data,
            const Paper& scheme);

  /// From now on there is room for that many neighbours.
  void make_room(std::size_t k) { neighbours_.resize(std::min(k, data_.size)); }

  /// The neighbours of T_base_flange (the tip link, without the tool), k at most.
  void query(const Pose& T_base_flange, std::size_t k = std::numeric_limits<std::size_t>::max());
  /// At most k seeds for T_base_flange, of the nearest neighbours in no order; those that a reduced
  /// key cannot bring inside the limits are left out. Returns how many.
  std::size_t nearest_seeds(const Pose& T_base_flange, std::size_t k);
  /// The dof values of seed i of nearest_seeds().
  [[nodiscard]] const double* nearest_seed(std::size_t i) const {
    return data_.reduction ? &seeds_[i * static_cast<std::size_t>(data_.dof)]
                           : data_.q(neighbours_[i].index);
  }
  /// The sample that seed i of nearest_seeds() is made of.
  [[nodiscard]] std::uint32_t nearest_sample(std::size_t i) const { return neighbours_[i].index; }
  /// Puts the neighbours in order and keeps the best.
  void rank();
  /// The seed of the next attempt, dof values; null when there is none left.
  const double* next_seed() {
    return queue_.next([&](const Candidate& candidate) { return seed_of(candidate); });
  }

  /// What rank() put in order, and what the sources of seeds by hand ask of it (selector.cpp).
  [[nodiscard]] CandidateQueue& queue() { return queue_; }
  /// Distance of a candidate's key from the target's, Eq. (2).
  [[nodiscard]] double distance(const Candidate& candidate) const {
    return std::sqrt(neighbours_[candidate.place].distance);
  }
  /// Square of the joint adjustment that a candidate's own pseudo-inverse predicts, Eq. (5).
  [[nodiscard]] double squared_adjustment(const Candidate& candidate) const {
    return square(adjustment(candidate));
  }
  /// Joint values to start from: the sample's, with the joints that a reduced key leaves out set
  /// for this target.
  [[nodiscard]] const double* seed_of(const Candidate& candidate) const;

 private:
  /// Keeps those within the threshold of Eq. (3).
  void drop_far_neighbours();
  void score(Candidate& candidate) const;
  /// Eq. (4).
  [[nodiscard]] JointVector adjustment(const Candidate& candidate) const;
  [[nodiscard]] static double square(const JointVector& adjustment) {
    double sum = 0;
    for (const double each : adjustment) sum += each * each;
    return sum;
  }
  /// Error from sample to target, in the frame that the sample's pseudo-inverse is made for.
  [[nodiscard]] Eigen::Matrix<double, 6, 1> error_of(const Candidate& candidate) const;
  /// Makes the seeds of all neighbours of a reduced key; drops those outside the limits.
  void prepare_seeds();

  const ChainModel* model_;
  const ChainModel* nominal_;
  const DatabaseData& data_;
  const Paper& scheme_;
  /// Pose of the tip link, or Y of reduction.hpp.
  Pose target_;
  double target_x_[6];
  // Only for a reduced key.
  lanes::LaneChain chain_;
  std::vector<double> seeds_;
  std::vector<Neighbour> neighbours_;
  std::size_t found_ = 0;
  CandidateQueue queue_;
};

/// The database's seeds as the paper selects them: query, rank, re-select; one a stage.
class SelectedSeeds : public RowSeeds {
 public:
  SelectedSeeds(Selection& selection, const Pose& tip_target, Work& work)
      : RowSeeds(work, &Work::take), selection_(selection), tip_target_(tip_target) {}

  bool next_stage() {
    work_.lap(&StageTimes::iterate);
    if (!ranked_) {
      ranked_ = true;
      selection_.query(tip_target_);
      work_.lap(&StageTimes::query);
      selection_.rank();
      work_.lap(&StageTimes::rank);
    }
    const double* seed = work_.has_left() ? selection_.next_seed() : nullptr;
    give(seed, seed != nullptr ? 1 : 0, 0, /*are_answers=*/false);
    work_.lap(&StageTimes::reselect);
    return seed != nullptr;
  }

 private:
  Selection& selection_;
  Pose tip_target_;
  bool ranked_ = false;
};

}  // namespace iksel
