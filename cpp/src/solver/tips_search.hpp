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
  Result find_first(const Goal& goal, const SolveRequest& request, Workspace& workspace) const;
  void collect(Collector& collector, Workspace& workspace) const;

 private:
  template <typename Answers>
  Proof search_for(Answers& answers, const Collector* collector, Workspace& workspace) const;

  const SolverOptions& options_;
  std::vector<double> steps_;  ///< between values of the shared joints
  std::vector<TipSolvers> solvers_;
};

}  // namespace iksel
