// SPDX-License-Identifier: BSD-3-Clause
#include <cstddef>
#include <mutex>
#include <string>
#include <vector>

#include "base/message_text.hpp"
#include "base/parallel.hpp"
#include "base/pose_check.hpp"
#include "goal/screen.hpp"
#include "iksel/error.hpp"
#include "tree/tree_solver_impl.hpp"

namespace iksel {
namespace {

/// Makes them rigid; false if one is no pose.
bool make_all_rigid(std::vector<Pose>& poses) {
  for (Pose& pose : poses) {
    const Rigidity rigidity = rigidity_of(pose);
    if (rigidity == Rigidity::none) return false;
    if (rigidity == Rigidity::close) make_rigid(pose);
  }
  return true;
}

}  // namespace

std::vector<TreeResult> TreeSolver::solve_batch(const std::vector<Pose>& T_base_tip,
                                                const TreeRequest& request,
                                                const std::vector<JointVector>& near, int threads,
                                                const Progress& progress) const {
  const auto tips = static_cast<std::size_t>(robot().tips());
  const std::size_t count = T_base_tip.size() / tips;
  if (count * tips != T_base_tip.size()) {
    throw InvalidArgumentError("poses: expected " + std::to_string(tips) +
                               " for each target, got " + std::to_string(T_base_tip.size()));
  }
  impl_->check(request);
  if (!near.empty() && near.size() != count) {
    throw InvalidArgumentError("near: expected one configuration for each of " +
                               std::to_string(count) + " targets, got " +
                               std::to_string(near.size()));
  }
  for (const JointVector& each : near) impl_->check_near(each);
  std::vector<TreeResult> results(count);
  std::mutex turn;
  TreeRequest locked = request;
  locked.filter = in_turn(request.filter, turn);
  const auto make_worker = [&] {
    return [&, own = locked](std::size_t begin, std::size_t end) mutable {
      for (std::size_t i = begin; i < end; ++i) {
        if (!near.empty()) own.near = near[i];
        const auto first = T_base_tip.begin() + static_cast<std::ptrdiff_t>(i * tips);
        std::vector<Pose> targets(first, first + static_cast<std::ptrdiff_t>(tips));
        if (make_all_rigid(targets)) {
          results[i] = impl_->solve(targets, own);
        } else {
          results[i].status = Status::invalid_pose;
        }
      }
    };
  };
  constexpr std::size_t kChunk = 8;
  parallel_for(count, kChunk, resolve_threads(threads), make_worker, [&](std::size_t done) {
    if (progress) progress(done, count);
  });
  return results;
}

}  // namespace iksel
