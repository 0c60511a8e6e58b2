// SPDX-License-Identifier: BSD-3-Clause
// Why each answer is refused.
#pragma once

#include "iksel/diagnosis.hpp"
#include "iksel/request.hpp"

namespace iksel {

inline bool is_refusal(Status status) {
  return status == Status::rejected || status == Status::in_collision;
}

/// Answers that are looked at to say what refuses them, at most.
inline constexpr int kMostRefused = 512;

/// The request without what refuses answers or prefers some.
SolveRequest opened(const SolveRequest& request);

/// Puts cause, numbers and message into `out`, for answers that were all refused with that status.
/// Returns one of them, if there is one: where they collide, that whose deepest contact is the
/// least deep.
JointVector explain_refusals(const SolveRequest& request, Status status, const Solutions& refused,
                             Diagnosis& out);

}  // namespace iksel
