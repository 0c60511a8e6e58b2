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
#include "seeds/row_seeds.hpp"

namespace iksel {

/// Memory is taken at construction for kRoom seeds; more take it once, and it is kept.
class SeedRanking {
 public:
  static constexpr std::size_t kRoom = 1024;

  /// `cutoff` is that of the database's pseudo-inverses.
  SeedRanking(const RobotModel& model, const Paper& scheme, double cutoff);

  /// Puts `seeds`, which must outlive their use, in order: n log n for n of them. Asks
  /// `should_continue` before each; there are none if that says no.
  void rank(const Goal& goal, const std::vector<JointVector>& seeds,
            FunctionRef<bool()> should_continue);

  /// The seed of the next attempt; null when there is none left.
  const double* next() {
    return queue_.next([&](const Candidate& each) { return (*seeds_)[each.index].data(); });
  }

 private:
  [[nodiscard]] Candidate rank_one(std::size_t index, const Goal& goal) const;
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
class GivenSeeds : public RowSeeds {
 public:
  /// A stage has `per_stage` seeds, kBlock at most. `should_continue` is asked while they are
  /// ranked.
  GivenSeeds(SeedRanking& ranking, const Goal& goal, const std::vector<JointVector>& seeds,
             int most, std::size_t per_stage, FunctionRef<bool()> should_continue, Work& work)
      : RowSeeds(work, &Work::take_on_top),
        ranking_(ranking),
        goal_(goal),
        seeds_(seeds),
        left_(most),
        per_stage_(per_stage),
        should_continue_(should_continue) {}

  bool next_stage() {
    if (seeds_.empty()) return false;
    // Interrupted by the deadline, there are none, and the search then ends.
    if (!ranked_) ranking_.rank(goal_, seeds_, should_continue_);
    ranked_ = true;
    const auto dof = static_cast<std::size_t>(seeds_[0].size());
    std::size_t count = 0;
    for (; count < per_stage_ && left_ > 0; ++count, --left_) {
      const double* seed = ranking_.next();
      if (seed == nullptr) break;
      std::copy_n(seed, dof, rows_ + count * dof);
    }
    give(rows_, count, dof, /*are_answers=*/false);
    return count > 0;
  }

 private:
  SeedRanking& ranking_;
  const Goal& goal_;
  const std::vector<JointVector>& seeds_;
  int left_;
  std::size_t per_stage_;
  FunctionRef<bool()> should_continue_;
  bool ranked_ = false;
  double rows_[lanes::kBlock * kMaxDof];
};

}  // namespace iksel
