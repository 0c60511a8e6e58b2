// SPDX-License-Identifier: BSD-3-Clause
// Seeds that a caller gives, ranked and re-selected by the same rules as the database's.
#pragma once

#include <cstddef>
#include <vector>

#include "iksel/options.hpp"
#include "iteration/task_space.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

class GivenSeeds {
 public:
  /// `seeds` must outlive this.
  GivenSeeds(const ChainModel& model, const SolverOptions& options, const TaskSpace& task,
             const Pose& T_base_tip, const std::vector<JointVector>& seeds);

  /// The seed of attempt 0, 1, ...; null when there is none left.
  const double* next(int attempt);
  [[nodiscard]] std::size_t size() const { return ranked_.size(); }

 private:
  struct Ranked {
    double score;  ///< squared norm of Eq. (2) or Eq. (5)
    std::size_t index;
    bool leaves_limits;
    friend bool operator<(const Ranked& a, const Ranked& b) {
      if (a.leaves_limits != b.leaves_limits) return b.leaves_limits;
      return a.score != b.score ? a.score < b.score : a.index < b.index;
    }
  };
  [[nodiscard]] Ranked rank(std::size_t index, const TaskSpace& task, const Pose& T_base_tip) const;
  /// The error to be reduced, and the Jacobian J of what reduces it.
  Vector6 error_of(const JointVector& q, const TaskSpace& task, const Pose& T_base_tip,
                   JacobianMatrix& J) const;
  void bring_farthest_forward(std::size_t position);

  const ChainModel& model_;
  const SolverOptions& options_;
  const std::vector<JointVector>& seeds_;
  std::vector<Ranked> ranked_;
  JointVector sum_of_failed_;
};

}  // namespace iksel
