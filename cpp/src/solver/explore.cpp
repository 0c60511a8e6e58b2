// SPDX-License-Identifier: BSD-3-Clause
#include "solver/explore.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "solver/lane_explore.hpp"
#include "solver/mirror.hpp"
#include "solver/solver_impl.hpp"

namespace iksel {
namespace {

/// A seed this near to a solution in every joint would end there itself [rad or m]; or at the other
/// of a pair that is near, which is looked for from the solution.
constexpr double kCaught = 0.2;
/// Seeds for a task between two questions to a filter.
constexpr int kFilterStage = 16;

struct Steering {
  const Exploration& search;
  Found& found;
  std::vector<JointVector>& mirrors;
  FunctionRef<bool()> ask;
  /// Seeds and lanes nearer to a solution are not followed further [rad or m]; 0: all are.
  double caught;

  /// The next seed that goes before the database's, if there is one.
  bool take(JointVector& q) const {
    if (mirrors.empty()) return false;
    q = mirrors.back();
    mirrors.pop_back();
    return true;
  }
  [[nodiscard]] bool exhausted() const { return search.ends_complete(); }

  [[nodiscard]] bool go_on() const { return ask(); }
  [[nodiscard]] bool wants_more() const { return search.wants_more(); }
  /// Solutions that seeds are to be taken far from: none where all are followed.
  [[nodiscard]] std::size_t known() const { return caught > 0 ? found.size() : 0; }
  [[nodiscard]] const double* solution(std::size_t i) const { return found.q(i); }
  template <typename Q>
  [[nodiscard]] bool knows(const Q& q) const {
    return caught > 0 && found.is_near_known(q, caught);
  }
};

/// Where the turns lie that an objective wants; the others take what comes.
std::optional<JointVector> cheapest_turns(const ChainModel& model, const Objective& objective) {
  if (objective.kind == Objective::Kind::posture) return objective.posture;
  if (objective.kind == Objective::Kind::limits) return middle_of_limits(model);
  return std::nullopt;
}

}  // namespace

void Solver::Impl::explore(Exploration& search, Workspace& workspace) const {
  const ChainModel& model = robot.model();
  Found& found = workspace.found;
  found.clear();
  if (out_of_reach(search.task, search.T_base_tip)) {
    search.status = Status::out_of_reach;
    return;
  }

  search.orientations_cancel = search.task.is_full_pose() && orientations_cancel(model);
  search.most = most_solutions;
  const SolveRequest& request = search.request;
  const JointMove move(model.dof, request);
  const Deadline deadline(request.deadline);
  const JointVector middle = middle_of_limits(model);
  const std::optional<JointVector> turns_near = cheapest_turns(model, request.objective);
  const bool in_pairs = search.task.is_full_pose() && model.dof <= 6;
  std::vector<JointVector>& mirrors = workspace.mirrors;
  mirrors.clear();
  const auto accept = [&](JointVector& q) {
    model.wrap_into_limits(q.data());
    Result answer;
    Jacobian J;
    measure(search.task, search.T_base_tip, q, answer.position_error, answer.rotation_error,
            in_pairs ? &J : nullptr);
    if (!within_tolerances(answer.position_error, answer.rotation_error)) return Verdict::refine;
    if (!model.within_limits(q.data())) {
      search.status = Status::outside_limits;
      return Verdict::next;
    }
    answer.status = Status::solved;
    answer.q = q;
    if (turns_near) {
      take_turns_near(*turns_near, search.task, search.T_base_tip, answer);
    } else if (request.near) {
      take_turns_near(*request.near, search.task, search.T_base_tip, answer);
    } else if (!request.objective.is_set()) {
      take_turns_near(middle, search.task, search.T_base_tip, answer);
    }
    // What a filter has been asked about stays as it is.
    const double cost = request.near && !turns_near && !request.filter
                            ? move.length(answer.q - *request.near)
                            : 0.0;
    if (!found.add(answer, cost, search.min_distance)) return Verdict::next;
    ++search.found;
    search.last_new = search.work.attempts;
    if (in_pairs) {
      // Of a pair that counts as one, the other may lie on the side of a limit where `near` is.
      Surroundings around = look_around(J, answer.q, request.near ? 0.0 : search.min_distance);
      search.orientation += around.orientation;
      if (around.paired && mirrors.size() < mirrors.capacity()) {
        mirrors.push_back(std::move(around.other));
      }
    }
    return Verdict::next;
  };
  const auto go_on = [&] {
    if (search.enough(search) || search.ends_complete()) return false;
    search.out_of_time = deadline.passed();
    return !search.out_of_time;
  };

  if (!search.task.is_full_pose()) {
    explore_task(search, workspace, accept, go_on);
  } else if (workspace.lanes) {
    explore_in_lanes(search, workspace, accept, go_on);
  } else {
    explore_one_by_one(search, workspace, accept, go_on);
  }
  if (found.size() > 0) search.status = Status::solved;
}

int Solver::Impl::count_most_solutions() const {
  constexpr std::size_t kPoses = 64;
  if (!task.is_full_pose() || !orientations_cancel(robot.model())) return 0;
  const SolveRequest none;
  const SolveAllOptions all;
  const auto never = [](const Exploration&) { return false; };
  const Lease lease(*this);
  const Matrix q = robot.random_configurations(kPoses, options.seed);
  int most = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Pose target = robot.fk(q.row(i));
    Exploration search{
        target, task, none, all.min_distance, FunctionRef<bool(const Exploration&)>(never), true};
    explore(search, lease.get());
    most = std::max(most, search.found);
  }
  return most;
}

void Solver::Impl::take_turns_near(const JointVector& near, const TaskSpace& of_call,
                                   const Pose& T_base_tip, Result& answer) const {
  const ChainModel& model = robot.model();
  // An answer at a limit lies outside by rounding as often as not. Held to the limit it need not be
  // a whole turn away.
  JointVector turned = answer.q;
  const bool held = take_nearest_turns(model, near, options.rotation_tolerance, turned);
  if (turned == answer.q) return;
  // Whole turns round, and so measured again.
  if (finish(of_call, T_base_tip, turned, answer) || !held) return;
  turned = answer.q;
  take_nearest_turns(model, near, 0, turned);
  finish(of_call, T_base_tip, turned, answer);
}

void Solver::Impl::explore_in_lanes(Exploration& search, Workspace& workspace,
                                    FunctionRef<Verdict(JointVector&)> accept,
                                    FunctionRef<bool()> go_on) const {
  LaneSearch& lanes = *workspace.lanes;
  lanes.set_target(search.T_base_tip);
  Work& work = search.work;
  const auto iterate_seeds = [&](const double* const* seeds, int count) {
    work.given += count;
    lanes.iterate(
        count, work, [&](int k, int lane) { lanes.load_seed(lane, seeds[k]); }, accept);
  };
  if (search.request.near) {
    const double* near = search.request.near->data();
    iterate_seeds(&near, 1);
  }
  if (!search.request.seeds.empty()) {
    GivenSeeds& given = workspace.given;
    if (!given.rank(search.task, search.T_base_tip, search.request.seeds, go_on)) return;
    const double* group[lanes::kGroup];
    for (int tried = 0; tried < options.max_attempts;) {
      const int most = std::min(lanes::kGroup, options.max_attempts - tried);
      int count = 0;
      while (count < most && (group[count] = given.next()) != nullptr) ++count;
      tried += count;
      if (count == 0) break;
      iterate_seeds(group, count);
      if (!go_on()) return;
    }
  }
  if (!go_on() || !search.request.database_seeds) return;
  const Steering steering{search, workspace.found, workspace.mirrors, go_on,
                          robot.dof() > 6 ? 0.0 : kCaught};
  lanes.explore(search.T_base_tip, work, accept, steering);
}

void Solver::Impl::explore_task(Exploration& search, Workspace& workspace,
                                FunctionRef<Verdict(JointVector&)> accept,
                                FunctionRef<bool()> go_on) const {
  TaskSearch& tasks = workspace.tasks;
  StageClock clock(nullptr);
  tasks.begin(search.T_base_tip, search.task,
              search.wants_more() ? TaskSearch::kMany : TaskSearch::kFew);
  // A filter is asked about many at a time.
  const int stage = search.request.filter ? kFilterStage : 1;
  int since = 0;
  const auto go_on_in_stages = [&] { return ++since % stage != 0 || go_on(); };
  if (search.request.near) tasks.attempt(*search.request.near, clock, search.work, accept);
  if (!search.request.seeds.empty()) {
    GivenSeeds& given = workspace.given;
    if (!given.rank(search.task, search.T_base_tip, search.request.seeds, go_on)) return;
    for (int k = 0; k < options.max_attempts; ++k) {
      const double* seed = given.next();
      if (seed == nullptr) break;
      tasks.attempt(Eigen::Map<const Eigen::VectorXd>(seed, robot.dof()), clock, search.work,
                    accept);
      if (!go_on_in_stages()) return;
    }
  }
  if (search.request.database_seeds) tasks.run(clock, search.work, accept, go_on_in_stages);
  if (tasks.left_limits()) search.status = Status::outside_limits;
  // What the last seeds found is looked at too.
  go_on();
}

void Solver::Impl::explore_one_by_one(Exploration& search, Workspace& workspace,
                                      FunctionRef<Verdict(JointVector&)> accept,
                                      FunctionRef<bool()> go_on) const {
  const ChainModel& model = robot.model();
  const Pose tip_target = search.T_base_tip * Pose(model.tcp_inverse);
  Random random(options.seed);
  const IterationContext context{model, options, search.T_base_tip, tip_target, workspace.kdl.get(),
                                 random};
  const auto attempt = [&](const double* from) {
    JointVector q = Eigen::Map<const Eigen::VectorXd>(from, model.dof);
    ++search.work.attempts;
    const Outcome outcome = iterate(context, q, search.work.iterations);
    if (outcome == Outcome::outside_limits) search.status = Status::outside_limits;
    if (outcome == Outcome::solved) accept(q);
  };

  if (search.request.near) attempt(search.request.near->data());
  int on_top = search.work.attempts;
  const auto left = [&] { return search.work.attempts - on_top < options.max_attempts; };
  const auto try_all = [&](auto& seeds) {
    for (int k = 0; left(); ++k) {
      if (!go_on()) return false;
      const double* seed = seeds(k);
      if (seed == nullptr) return true;
      attempt(seed);
    }
    return false;
  };

  if (!search.request.seeds.empty()) {
    GivenSeeds& given = workspace.given;
    const auto next = [&](int /*attempt*/) { return given.next(); };
    if (!given.rank(search.task, search.T_base_tip, search.request.seeds, go_on)) return;
    if (!try_all(next) && left()) {
      go_on();
      return;
    }
    on_top = search.work.attempts;
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
