// SPDX-License-Identifier: BSD-3-Clause
// Which seeds and which refiner a goal of one tip is searched with.
#pragma once

#include "iksel/request.hpp"
#include "search/context.hpp"
#include "search/search_state.hpp"

namespace iksel {

/// The first answer; `times` may be null; `request` is read for its seeds, `near` and deadline
/// only.
Result find_first(const SolverOptions& options, const Goal& goal, const SolveRequest& request,
                  Workspace& workspace, StageTimes* times, Effort effort = Effort::full);

/// Collects solutions in workspace.collected.found, until the collector has enough.
void collect(const SolverOptions& options, Collector& collector, Workspace& workspace,
             StageTimes* times = nullptr);

}  // namespace iksel
