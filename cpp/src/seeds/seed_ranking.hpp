// SPDX-License-Identifier: BSD-3-Clause
// Seeds that a caller gives, ranked and re-selected by the same rules as the database's.
#pragma once

#include <cstddef>
#include <vector>

#include "base/function_ref.hpp"
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

}  // namespace iksel
