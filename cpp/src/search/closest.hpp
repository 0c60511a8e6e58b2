// SPDX-License-Identifier: BSD-3-Clause
// Of a goal that has no answer, the configuration inside the limits that is nearest to one.
#pragma once

#include "search/context.hpp"

namespace iksel {

/// Makes a failure the nearest configuration that the request's scene and filter take, if there is
/// one.
void give_closest(const SolverOptions& options, const Goal& goal, const SolveRequest& request,
                  const Vector6& weights, Workspace& workspace, Result& result);

/// Measures q, which is nearest to a goal, into the result.
void set_closest(const Goal& goal, const JointVector& q, Result& result);

}  // namespace iksel
