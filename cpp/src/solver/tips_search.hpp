// SPDX-License-Identifier: BSD-3-Clause
// The search for answers of several tips at once.
#pragma once

#include "search/context.hpp"
#include "solver/arm_search.hpp"

namespace iksel {

class TipsSearch {
 public:
  /// Builds the databases of the chains. All must outlive this.
  TipsSearch(const TipsModel& model, const SolverOptions& options);

  [[nodiscard]] const Solver& chain(int tip) const {
    return solvers_[static_cast<std::size_t>(tip)].chain;
  }

  /// As in search/run.hpp.
  template <typename Answers>
  Proof search_for(Answers& answers, Workspace& workspace) const;

 private:
  const SolverOptions& options_;
  std::vector<double> steps_;  ///< between values of the shared joints
  std::vector<TipSolvers> solvers_;
};

}  // namespace iksel
