// SPDX-License-Identifier: BSD-3-Clause
// The enums of results in words.
#include "iksel/diagnosis.hpp"
#include "iksel/result.hpp"

namespace iksel {

const char* to_string(Proof proof) {
  switch (proof) {
    case Proof::none:
      return "none";
    case Proof::reach:
      return "reach";
    case Proof::closed_form:
      return "closed_form";
    case Proof::sweep:
      return "sweep";
  }
  return "unknown";
}

const char* to_string(Status status) {
  switch (status) {
    case Status::solved:
      return "solved";
    case Status::not_converged:
      return "not_converged";
    case Status::outside_limits:
      return "outside_limits";
    case Status::out_of_reach:
      return "out_of_reach";
    case Status::rejected:
      return "rejected";
    case Status::out_of_time:
      return "out_of_time";
    case Status::too_fast:
      return "too_fast";
    case Status::invalid_pose:
      return "invalid_pose";
  }
  return "unknown";
}

const char* to_string(Cause cause) {
  switch (cause) {
    case Cause::none:
      return "none";
    case Cause::out_of_reach:
      return "out_of_reach";
    case Cause::orientation:
      return "orientation";
    case Cause::joint_limits:
      return "joint_limits";
    case Cause::no_branch:
      return "no_branch";
    case Cause::rejected:
      return "rejected";
    case Cause::singular:
      return "singular";
    case Cause::budget:
      return "budget";
    case Cause::out_of_time:
      return "out_of_time";
  }
  return "unknown";
}

}  // namespace iksel
