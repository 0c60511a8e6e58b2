// SPDX-License-Identifier: BSD-3-Clause
// Which seeds and which refiner a goal of one tip is searched with.
#pragma once

#include "search/context.hpp"
#include "search/first_answer.hpp"

namespace iksel {

/// For a FirstAnswer or a Collector, until it wants no more; `times` may be null. The proof that
/// there are no answers but those found.
template <typename Answers>
Proof search_for(const SolverOptions& options, Answers& answers, Workspace& workspace,
                 StageTimes* times);

}  // namespace iksel
