// SPDX-License-Identifier: BSD-3-Clause
#include "solver/explore.hpp"

#include <algorithm>

#include "solver/given_seeds.hpp"
#include "solver/solver_impl.hpp"
#include "solver/stage_clock.hpp"

namespace iksel {
namespace {

/// Seeds between two looks at what was found, where they are iterated one by one.
constexpr int kStage = 8;

}  // namespace

void Solver::Impl::explore(Exploration& search, Workspace& workspace) const {
  const ChainModel& model = robot.model();
  Found& found = workspace.found;
  found.clear();
  const double distance = (search.T_base_tip.translation() - robot.reach_centre()).norm();
  if (distance > robot.reach() + options.position_tolerance) {
    search.status = Status::out_of_reach;
    return;
  }

  const Deadline deadline(search.request.deadline);
  const auto accept = [&](JointVector& q) {
    model.wrap_into_limits(q.data());
    const Result measured = finish(Result{}, search.T_base_tip, q);
    if (!measured.success()) return false;
    if (search.request.near) {
      take_nearest_turns(model, *search.request.near, q);
    } else {
      take_first_turns(model, q);
    }
    found.add(q, search.min_distance);
    return false;
  };
  const auto go_on = [&] {
    if (search.enough()) return false;
    search.out_of_time = deadline.passed();
    return !search.out_of_time;
  };

  const Pose tip_target = search.T_base_tip * Pose(model.tcp_inverse);
  if (workspace.lanes) {
    explore_in_lanes(search, tip_target, *workspace.lanes, accept, go_on);
  } else {
    explore_one_by_one(search, tip_target, workspace, accept, go_on);
  }
  if (found.size() > 0) search.status = Status::solved;
}

void Solver::Impl::explore_in_lanes(Exploration& search, const Pose& tip_target, LaneSearch& lanes,
                                    FunctionRef<bool(JointVector&)> accept,
                                    FunctionRef<bool()> go_on) const {
  lanes.set_target(tip_target);
  if (search.request.near) {
    lanes.iterate_seed(search.request.near->data(), search.attempts, search.iterations, accept);
  }
  if (!search.request.seeds.empty()) {
    GivenSeeds given(robot.model(), options, tip_target, search.request.seeds);
    int k = 0;
    while (search.attempts < options.max_attempts) {
      const double* seed = given.next(k++);
      if (seed == nullptr) break;
      lanes.iterate_seed(seed, search.attempts, search.iterations, accept);
      if (k % kStage == 0 && !go_on()) return;
    }
  }
  if (!go_on() || !search.request.database_seeds) return;
  StageClock clock(nullptr);
  lanes.run(tip_target, nullptr, clock, search.attempts, search.iterations, accept, go_on);
}

void Solver::Impl::explore_one_by_one(Exploration& search, const Pose& tip_target,
                                      Workspace& workspace, FunctionRef<bool(JointVector&)> accept,
                                      FunctionRef<bool()> go_on) const {
  const ChainModel& model = robot.model();
  Random random(options.seed);
  const IterationContext context{model, options, search.T_base_tip, tip_target, workspace.kdl.get(),
                                 random};
  const auto attempt = [&](const double* from) {
    JointVector q = Eigen::Map<const Eigen::VectorXd>(from, model.dof);
    ++search.attempts;
    const Outcome outcome = iterate(context, q, search.iterations);
    if (outcome == Outcome::outside_limits) search.status = Status::outside_limits;
    if (outcome == Outcome::solved) accept(q);
  };

  if (search.request.near) attempt(search.request.near->data());
  const int on_top = search.attempts;
  const auto left = [&] { return search.attempts - on_top < options.max_attempts; };
  const auto try_all = [&](auto& seeds) {
    for (int k = 0; left(); ++k) {
      if (k % kStage == 0 && !go_on()) return false;
      const double* seed = seeds(k);
      if (seed == nullptr) return true;
      attempt(seed);
    }
    return false;
  };

  if (!search.request.seeds.empty()) {
    GivenSeeds given(model, options, tip_target, search.request.seeds);
    const auto next = [&](int k) { return given.next(k); };
    if (!try_all(next)) {
      go_on();
      return;
    }
  }
  if (search.request.database_seeds) {
    Selection& selection = workspace.selection;
    selection.query(tip_target);
    selection.rank();
    const auto next = [&](int k) { return selection.next_seed(k); };
    try_all(next);
  }
  // What the last seeds found is looked at too.
  go_on();
}

}  // namespace iksel
