// SPDX-License-Identifier: BSD-3-Clause
// The fields of answers, as iksel/result.hpp declares them.
#pragma once

#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include "array_fields.hpp"
#include "py_batch.hpp"
#include "py_result.hpp"

namespace iksel::python {

template <>
struct FieldTable<PyResult> {
  static constexpr const char* kName = "Result";
  static constexpr const char* kDoc =
      "Answer to one target, true if it is one. Everything in it is measured on the returned q.";
  static std::vector<Field> fields() {
    return {
        field<PyResult>("status", &Result::status, "Why the solve ended."),
        field<PyResult>(
            "proof", &Result::proof,
            "`answer` of a success; of a failure, how certain it is that there is no answer."),
        field<PyResult>("q", &Result::q, nullptr),
        field<&may_be_length, PyResult>("position_error", &Result::position_error,
                                        "Distance to the target [m]; NaN without a q."),
        field<&may_be_length, PyResult>(
            "rotation_error", &Result::rotation_error,
            "Length of the rotation vector to the target [rad]; NaN without a q."),
        field<&may_be_length, PyResult>(
            "move", &Result::move,
            "Length of the move from `near`, by its norm and weights; NaN without one."),
        field<PyResult>("cost", &Result::cost, "Cost of q by the objective; NaN without one."),
        field<&is_count, PyResult>("attempts", &Result::attempts, "Seeds tried."),
        field<&is_count, PyResult>("iterations", &Result::iterations,
                                   "Iteration steps over all attempts."),
        field<&is_index<kMaxTips>, PyResult>("unreachable_tip", &Result::unreachable_tip, nullptr)};
  }
  static void check(const PyResult& self) {
    const std::string of = "pickled Result, ";
    const bool has_q = has_joints(self.status);
    if (has_q != (self.q.size() > 0)) {
      refuse_state(of + "q", has_q ? "joint values" : "None, as it is not solved", "another");
    }
    if (has_q && !(self.position_error >= 0 && self.rotation_error >= 0)) {
      refuse_state(of + "errors", "0 or more where there is a q", "NaN");
    }
    if (self.success() != (self.proof == Proof::answer)) {
      refuse_state(of + "proof", "answer where solved, and only there", enum_name(self.proof));
    }
  }
};

template <>
struct FieldTable<PyBatchResult> {
  using B = PyBatchResult;
  static constexpr const char* kName = "BatchResult";
  static constexpr const char* kDoc =
      "Answers to many targets as arrays; row i belongs to target i. Indexing gives a Result, and "
      "by a slice or an array a BatchResult of its own. It is neither true nor false: ask "
      "success.all() or success.any().";
  static std::vector<Field> fields() {
    return {field("q", &B::q, "Joint values [rad or m], (N, dof); NaN where not solved."),
            field("success", &B::success, "Whether each target is solved, (N,)."),
            field("status", &B::status, "Values of Status, (N,)."),
            field("proof", &B::proof, "Values of Proof, (N,); that of `answer` where solved."),
            field("position_error", &B::position_error,
                  "Distances to the targets [m], (N,); NaN where not solved."),
            field("rotation_error", &B::rotation_error,
                  "Lengths of the rotation vectors to the targets [rad], (N,); NaN where not "
                  "solved."),
            field("attempts", &B::attempts, "Seeds tried, (N,)."),
            field("iterations", &B::iterations, "Iteration steps over all attempts, (N,)."),
            field("move", &B::move,
                  "Lengths of the moves from `near`, (N,); NaN where not solved or without one.")};
  }
  /// Statuses and proofs that there are, and numbers where there are answers.
  static void check(const B& self);
};

}  // namespace iksel::python
