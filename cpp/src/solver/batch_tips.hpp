// SPDX-License-Identifier: BSD-3-Clause
// A batch of targets of several tips: one after the other on each thread.
#pragma once

#include <mutex>
#include <vector>

#include "base/parallel.hpp"
#include "base/pose_check.hpp"
#include "goal/screen.hpp"
#include "solver/solver_impl.hpp"

namespace iksel {

/// The poses of one target, made rigid; none if one of them is no pose.
template <typename PoseAt>
std::vector<Pose> rigid_poses(std::size_t row, std::size_t tips, const PoseAt& pose_at,
                              OnInvalidPose on_invalid) {
  std::vector<Pose> targets;
  for (std::size_t i = row * tips; i < (row + 1) * tips; ++i) {
    targets.push_back(pose_at(i));
    const Rigidity rigidity = rigidity_of(targets.back());
    if (rigidity == Rigidity::close) make_rigid(targets.back());
    if (rigidity != Rigidity::none) continue;
    if (on_invalid == OnInvalidPose::raise) {
      throw_not_rigid(targets.back(), "poses", static_cast<std::ptrdiff_t>(i));
    }
    return {};
  }
  return targets;
}

/// As Solver::Impl::solve_rows.
template <typename PoseAt, typename Near, typename OnRow>
void solve_rows_of_tips(const Solver::Impl& solver, std::size_t count, const PoseAt& pose_at,
                        const SolveRequest& request, const Near& near_of, int threads,
                        const OnRow& on_row, const Progress& progress) {
  constexpr std::size_t kChunk = 8;
  const auto tips = static_cast<std::size_t>(solver.robot.tips());
  const auto poses = [&](std::size_t row) {
    return rigid_poses(row, tips, pose_at, request.on_invalid_pose);
  };
  // Before any is solved.
  for (std::size_t row = 0; request.on_invalid_pose == OnInvalidPose::raise && row < count; ++row) {
    static_cast<void>(poses(row));
  }
  std::mutex turn;
  const SolveRequest locked = in_turn(request, turn);
  const auto make_worker = [&] {
    return [&, own = locked, lease = std::make_shared<WorkspacePool::Lease>(solver.workspaces)](
               std::size_t begin, std::size_t end) mutable {
      for (std::size_t row = begin; row < end; ++row) {
        if (const double* values = near_of(row)) {
          own.near = JointVector(Eigen::Map<const Eigen::VectorXd>(values, solver.robot.dof()));
        }
        const std::vector<Pose> targets = poses(row);
        Result result;
        result.status = Status::invalid_pose;
        if (!targets.empty()) result = solver.solve(targets.data(), own, lease->get(), nullptr);
        on_row(row, result);
      }
    };
  };
  parallel_for(count, kChunk, threads, make_worker, [&](std::size_t done) {
    if (progress) progress(done, count);
  });
}

}  // namespace iksel
