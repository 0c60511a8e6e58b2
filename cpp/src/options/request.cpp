// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/request.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/message_text.hpp"
#include "iksel/error.hpp"

namespace iksel {

Filter filter_each(int dof, std::function<bool(const JointVector&)> keep) {
  return [dof, one = std::move(keep)](const double* q, std::size_t count, bool* kept) {
    for (std::size_t i = 0; i < count; ++i) {
      kept[i] = one(Eigen::Map<const Eigen::VectorXd>(q + i * static_cast<std::size_t>(dof), dof));
    }
  };
}

void PoseWeights::validate() const {
  double most = 0;
  const auto check = [&](const std::array<double, 3>& weights, const char* of) {
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(weights[i] >= 0 && std::isfinite(weights[i]))) {
        throw InvalidArgumentError("closest: weight " + std::to_string(i) + " of " + of + ", " +
                                   number_text(weights[i]) + ", is not finite and at least 0");
      }
      most = std::max(most, weights[i]);
    }
  };
  check(position, "position");
  if (rotation) {
    check(*rotation, "rotation");
    if (most == 0) throw InvalidArgumentError("closest: all weights are 0");
  }
}

bool SolveRequest::has_requirements() const {
  return !seeds.empty() || !database_seeds || near || scene || filter || objective.is_set() ||
         task || !tasks.empty() || !in_frame_of.empty() || std::isfinite(deadline) || closest ||
         prove;
}

void TargetCriteria::validate(int tips) const {
  if (task) task->validate();
  for (const Task& each : tasks) each.validate();
  const auto check_count = [&](const char* name, std::size_t count) {
    if (count == 0 || count == static_cast<std::size_t>(tips)) return;
    throw InvalidArgumentError(std::string(name) + ": expected one for each of " +
                               std::to_string(tips) + " tips, or none, got " +
                               std::to_string(count));
  };
  check_count("tasks", tasks.size());
  check_count("in_frame_of", in_frame_of.size());
  for (std::size_t i = 0; i < in_frame_of.size(); ++i) {
    const auto tip = static_cast<int>(i);
    if (in_frame_of[i] >= -1 && in_frame_of[i] < tips && in_frame_of[i] != tip) continue;
    throw_invalid("in_frame_of", tip,
                  std::to_string(in_frame_of[i]) + " is not in -1 .. " + std::to_string(tips - 1) +
                      ", or is the tip itself");
  }
}

void AnswerCriteria::validate(int dof, int tips) const {
  if (weights.size() != 0) {
    check_joints(weights, dof, "weights");
    for (int i = 0; i < dof; ++i) {
      if (weights[i] < 0) {
        throw InvalidArgumentError("weights[" + std::to_string(i) +
                                   "]: " + number_text(weights[i]) + " is negative");
      }
    }
    Eigen::Index i = 0;
    const double most = weights.maxCoeff(&i);
    if (most == 0) throw InvalidArgumentError("weights: all are 0");
    // Moves are measured by squares, which neither overflow nor vanish so.
    if (most < 1e-100 || most > 1e100) {
      throw InvalidArgumentError("weights[" + std::to_string(i) + "]: the largest, " +
                                 number_text(most) + ", is not in 1e-100 .. 1e100");
    }
  }
  if (norm != MoveNorm::two && norm != MoveNorm::max) {
    throw InvalidArgumentError("norm: not a value of MoveNorm (two, max)");
  }
  if (exact && !scene) {
    throw InvalidArgumentError("exact: there is no scene of which it could judge");
  }
  TargetCriteria::validate(tips);
}

void SolveRequest::validate(int dof, int tips) const {
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    // There may be many: names are made for the error only.
    if (seeds[i].size() == dof && seeds[i].allFinite()) continue;
    check_joints(seeds[i], dof, ("seeds[" + std::to_string(i) + "]").c_str());
  }
  if (near) check_joints(*near, dof, "near");
  AnswerCriteria::validate(dof, tips);
  if (on_invalid_pose != OnInvalidPose::status && on_invalid_pose != OnInvalidPose::raise) {
    throw InvalidArgumentError("on_invalid_pose: not a value of OnInvalidPose (status, raise)");
  }
  objective.validate(dof);
  if (closest) closest->validate();
  if (!(deadline > 0)) {
    throw InvalidArgumentError("deadline: " + number_text(deadline) + " s is not above 0");
  }
}

void SolveAllOptions::validate() const {
  if (max < 1) throw InvalidArgumentError("max: " + std::to_string(max) + " is less than 1");
  if (!(min_distance > 0 && min_distance <= 1e3)) {
    throw InvalidArgumentError("min_distance: " + number_text(min_distance) +
                               " is not above 0 and at most 1000");
  }
  if (order != SolutionOrder::move && order != SolutionOrder::limit_distance &&
      order != SolutionOrder::manipulability) {
    throw InvalidArgumentError(
        "order: not a value of SolutionOrder (move, limit_distance, manipulability)");
  }
}

void PathOptions::validate(int dof, int tips) const {
  if (start) check_joints(*start, dof, "start");
  AnswerCriteria::validate(dof, tips);
  if (!(dt >= 0 && dt <= 1e9)) {
    throw InvalidArgumentError("dt: " + number_text(dt) + " s is not 0 or more");
  }
  if (candidates < 1 || candidates > 100'000) {
    throw InvalidArgumentError("candidates: " + std::to_string(candidates) +
                               " is not in 1 .. 100000");
  }
}

}  // namespace iksel
