// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/solver.hpp"

#include <algorithm>
#include <cstdio>
#include <limits>
#include <thread>
#include <utility>

#include "base/error_check.hpp"
#include "base/pose_check.hpp"
#include "base/stage_clock.hpp"
#include "iksel/error.hpp"
#include "solver/solver_impl.hpp"

namespace iksel {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

/// Whether the database leaves out what the chain lets it leave out.
bool reduction_fits(const ChainModel& model, const DatabaseData& data) {
  if (!data.reduction) return true;
  const Reduction expected = Reduction::of(model, data.weight);
  return is_simple(model) && data.reduction->left() == expected.left() &&
         data.reduction->right() == expected.right();
}

void check_fits(const Robot& robot, const Database& database) {
  if (database.chain_hash() == robot.chain_hash() && database.dof() == robot.dof() &&
      reduction_fits(robot.model(), database.data())) {
    return;
  }
  throw DatabaseMismatchError(
      "the database (" + std::to_string(database.dof()) + " joints, chain hash " +
      hex(database.chain_hash()) + ") was built for another chain than robot '" + robot.name() +
      "' (" + std::to_string(robot.dof()) + " joints, chain hash " + hex(robot.chain_hash()) + ")");
}

}  // namespace

Workspace::Workspace(const ChainModel& model, const ChainModel& nominal, const DatabaseData& data,
                     const SolverOptions& options)
    : selection(model, nominal, data, options),
      tasks(model, data, options, selection),
      given(model, options),
      found(model) {
  partners.reserve(kPartners);
  if (solves_in_lanes(model, data, options)) {
    lanes = std::make_unique<LaneSearch>(model, nominal, data, options, lanes::choose_kernels());
  }
  if (options.kinematics == Kinematics::kdl) kdl = model.make_kdl(Pose::Identity());
}

Solver::Impl::Impl(const Robot& robot_in, const SolverOptions& options_in,
                   const Database& database_in, const Robot& nominal_in)
    : robot(robot_in),
      options(options_in),
      database(database_in),
      nominal(nominal_in),
      task(options.task, options.position_tolerance, options.rotation_tolerance),
      damaged(database.data().storage->damaged()),
      largest_angle(find_largest_angle()) {
  database.data().check_intact();
  check_fits(nominal, database);
  check_limits();
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  for (std::size_t i = 0; i < std::min(cores, kPlaces); ++i) {
    idle_[i] = new Workspace(robot.model(), nominal.model(), database.data(), options);
  }
  most_solutions = count_most_solutions();
}

Solver::Impl::~Impl() {
  for (auto& place : idle_) delete place.load();
}

Solver::Impl::Lease::Lease(const Impl& solver) : solver_(solver) {
  if (solver.damaged != nullptr) solver.database.data().check_intact();
  for (auto& place : solver_.idle_) {
    if (place.load(std::memory_order_relaxed) == nullptr) continue;
    workspace_ = place.exchange(nullptr, std::memory_order_acquire);
    if (workspace_ != nullptr) return;
  }
  workspace_ = new Workspace(solver.robot.model(), solver.nominal.model(), solver.database.data(),
                             solver.options);
}

Solver::Impl::Lease::~Lease() {
  for (auto& place : solver_.idle_) {
    Workspace* expected = nullptr;
    if (place.compare_exchange_strong(expected, workspace_, std::memory_order_release,
                                      std::memory_order_relaxed)) {
      return;
    }
  }
  delete workspace_;
}

Result Solver::Impl::solve(const Pose& T_base_tip, const JointVector* seed, Workspace& workspace,
                           StageTimes* times) const {
  const ChainModel& model = robot.model();
  StageClock clock(times);

  Result result;
  if (out_of_reach(task, T_base_tip)) {
    result.status = Status::out_of_reach;
    return result;
  }
  const auto accept = [&](JointVector& q) {
    model.joints.wrap(q.data());
    return finish(task, T_base_tip, q, result) ? Verdict::stop : Verdict::refine;
  };

  if (!task.is_full_pose()) {
    Work work;
    TaskSearch& tasks = workspace.tasks;
    tasks.begin(T_base_tip, task, TaskSearch::kFew);
    if (seed == nullptr || !tasks.attempt(*seed, clock, work, accept)) {
      tasks.run(clock, work, accept);
    }
    if (!result.success() && tasks.left_limits()) result.status = Status::outside_limits;
    result.attempts = work.attempts;
    result.iterations = work.iterations;
    return result;
  }

  if (workspace.lanes) {
    Work work;
    workspace.lanes->search(T_base_tip, seed, clock, work, accept);
    result.attempts = work.attempts;
    result.iterations = work.iterations;
    return result;
  }

  const Pose tip_target = T_base_tip * Pose(model.tcp_inverse);
  Random random(options.seed);
  const IterationContext context{model, options, T_base_tip, tip_target, workspace.kdl.get(),
                                 random};
  JointVector q;
  const auto attempt = [&](const double* from) {
    q = Eigen::Map<const Eigen::VectorXd>(from, model.dof);
    ++result.attempts;
    const Outcome outcome = iterate(context, q, result.iterations);
    if (outcome == Outcome::outside_limits) result.status = Status::outside_limits;
    return outcome == Outcome::solved && finish(task, T_base_tip, q, result);
  };

  if (seed != nullptr && attempt(seed->data())) {
    clock.lap(&StageTimes::iterate);
    return result;
  }

  Selection& selection = workspace.selection;
  clock.lap(&StageTimes::iterate);
  selection.query(tip_target);
  clock.lap(&StageTimes::query);
  selection.rank();
  clock.lap(&StageTimes::rank);
  for (int i = 0; i < options.max_attempts; ++i) {
    const double* from = selection.next_seed(i);
    clock.lap(&StageTimes::reselect);
    if (from == nullptr) break;
    const bool solved = attempt(from);
    clock.lap(&StageTimes::iterate);
    if (solved) break;
  }
  return result;
}

bool Solver::Impl::out_of_reach(const TaskSpace& of_call, const Pose& T_base_tip) const {
  const double distance = of_call.is_full_pose()
                              ? (T_base_tip.translation() - robot.reach_centre()).norm()
                              : of_call.distance_from(T_base_tip, robot.reach_centre());
  return distance > robot.reach() + options.position_tolerance;
}

void Solver::Impl::measure(const TaskSpace& of_call, const Pose& target, const JointVector& q,
                           double& position, double& rotation, Jacobian* jacobian) const {
  const ChainModel& model = robot.model();
  if (!of_call.is_full_pose()) {
    of_call.measure(target, model.fk(q.data()), position, rotation);
  } else if (jacobian != nullptr) {
    measure_error(target, model.fk_jacobian(q.data(), *jacobian), position, rotation);
  } else {
    measure_error(target, forward(model.kernel, q.data()), position, rotation);
  }
}

bool Solver::Impl::within_tolerances(double position, double rotation) const {
  return position <= options.position_tolerance && rotation <= options.rotation_tolerance;
}

bool Solver::Impl::finish(const TaskSpace& of_call, const Pose& target, const JointVector& q,
                          Result& result) const {
  double position = kNan;
  double rotation = kNan;
  measure(of_call, target, q, position, rotation);
  if (!within_tolerances(position, rotation) || !robot.model().joints.contains(q.data())) {
    return false;
  }
  result.status = Status::solved;
  result.q = q;
  result.position_error = position;
  result.rotation_error = rotation;
  return true;
}

Solver::Solver(const Robot& robot, const SolverOptions& options) {
  options.validate();
  impl_ = std::make_shared<Impl>(robot, options, Database::build(robot, options.database), robot);
}

Solver::Solver(const Robot& robot, const SolverOptions& options, const Database& database) {
  options.validate();
  impl_ = std::make_shared<Impl>(robot, options, database, robot);
}

const Robot& Solver::robot() const { return impl_->robot; }
const SolverOptions& Solver::options() const { return impl_->options; }
const Database& Solver::database() const { return impl_->database; }

std::size_t Solver::work_bound() const {
  return static_cast<std::size_t>(options().max_attempts) *
         static_cast<std::size_t>(options().max_iterations);
}

Result Solver::solve(const Pose& T_base_tip) const {
  Pose nearest;
  const Pose& target = to_rigid(T_base_tip, nearest);
  const Impl::Lease lease(*impl_);
  return impl_->solve(target, nullptr, lease.get(), nullptr);
}

Result Solver::solve(const Pose& T_base_tip, const JointVector& seed) const {
  Pose nearest;
  const Pose& target = to_rigid(T_base_tip, nearest);
  check_joints(seed, robot().dof(), "seed");
  impl_->check_angles(seed, "seed");
  const Impl::Lease lease(*impl_);
  return impl_->solve(target, &seed, lease.get(), nullptr);
}

Result Solver::solve(const Pose& T_base_tip, StageTimes& times) const {
  Pose nearest;
  const Pose& target = to_rigid(T_base_tip, nearest);
  const Impl::Lease lease(*impl_);
  return impl_->solve(target, nullptr, lease.get(), &times);
}

}  // namespace iksel
