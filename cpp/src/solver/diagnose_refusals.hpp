// SPDX-License-Identifier: BSD-3-Clause
// Why each answer is refused.
#pragma once

#include "base/function_ref.hpp"
#include "iksel/diagnosis.hpp"
#include "iksel/request.hpp"

namespace iksel {

inline bool is_refusal(Status status) {
  return status == Status::rejected || status == Status::in_collision;
}

/// The request without what refuses answers or prefers some.
SolveRequest opened(const SolveRequest& request);

/// Puts cause, numbers and message into `out`, for answers that were all refused with that status,
/// which `find_all` finds for the opened request. Returns one of them, if there is one: where they
/// collide, that whose deepest contact is the least deep.
JointVector explain_refusals(
    const SolveRequest& request, Status status,
    FunctionRef<Solutions(const SolveAllOptions&, const SolveRequest&)> find_all, Diagnosis& out);

}  // namespace iksel
