// SPDX-License-Identifier: BSD-3-Clause
// Seeds that a caller gives, ranked and re-selected by the same rules as the database's.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "base/function_ref.hpp"
#include "base/work.hpp"
#include "goal/goal.hpp"
#include "iksel/options.hpp"
#include "kinematics/chain_model.hpp"
#include "seeds/candidate_queue.hpp"

namespace iksel {

/// Memory is taken at construction for kRoom seeds; more take it once, and it is kept.
class SeedRanking {
 public:
  static constexpr std::size_t kRoom = 1024;

  /// `cutoff` is that of the database's pseudo-inverses.
  SeedRanking(const RobotModel& model, const Paper& scheme, double cutoff);

  /// Puts `seeds`, which must outlive their use, in order: n log n for n of them. Asks
  /// `should_continue` every few; false if that said no, and there are no seeds then.
  bool rank(const Goal& goal, const std::vector<JointVector>& seeds,
            FunctionRef<bool()> should_continue);

  /// The seed of the next attempt; null when there is none left.
  const double* next() {
    return queue_.next([&](const Candidate& each) { return (*seeds_)[each.index].data(); });
  }

 private:
  [[nodiscard]] Candidate rank_one(std::size_t index, const Goal& goal) const;
  /// The same of several tips.
  [[nodiscard]] Candidate rank_for_tips(Candidate ranked, const Goal& goal) const;
  /// The error to be reduced, and the Jacobian J of what reduces it.
  Vector6 error_of(const JointVector& q, const Goal& goal, JacobianMatrix& J) const;

  const RobotModel& model_;
  const Paper& scheme_;
  double cutoff_;
  const std::vector<JointVector>* seeds_ = nullptr;
  CandidateQueue queue_;
};

/// These as a source of seeds. They come on top of max_attempts, which bounds how many of them are
/// tried.
class GivenSeeds {
 public:
  /// A stage has `per_stage` seeds. `should_continue` is asked while they are ranked.
  GivenSeeds(SeedRanking& ranking, const Goal& goal, const std::vector<JointVector>& seeds,
             int most, int per_stage, FunctionRef<bool()> should_continue, Work& work)
      : ranking_(ranking),
        goal_(goal),
        seeds_(seeds),
        left_(most),
        per_stage_(per_stage),
        should_continue_(should_continue),
        work_(work) {}

  bool next_stage() {
    left_in_stage_ = std::min(left_, per_stage_);
    left_ -= left_in_stage_;
    if (seeds_.empty() || left_in_stage_ == 0 || is_empty_) return false;
    if (!ranked_) {
      // Interrupted by the deadline, the stage is empty, and the search then ends.
      ranking_.rank(goal_, seeds_, should_continue_);
      ranked_ = true;
    }
    return true;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    if (left_in_stage_ == 0) return false;
    --left_in_stage_;
    const double* seed = ranking_.next();
    if (seed == nullptr) {
      is_empty_ = true;
      return false;
    }
    work_.take_on_top();
    refiner.load_seed(lane, seed);
    return true;
  }

 private:
  SeedRanking& ranking_;
  const Goal& goal_;
  const std::vector<JointVector>& seeds_;
  int left_;
  int per_stage_;
  FunctionRef<bool()> should_continue_;
  Work& work_;
  bool ranked_ = false;
  bool is_empty_ = false;
  int left_in_stage_ = 0;
};

}  // namespace iksel
