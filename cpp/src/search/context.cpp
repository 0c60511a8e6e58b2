// SPDX-License-Identifier: BSD-3-Clause
#include "search/context.hpp"

#include <algorithm>
#include <thread>

#include "options/strategy.hpp"
#include "structure/closed_form.hpp"

namespace iksel {

namespace {

/// Those of the nominal chain that tell which solutions lie inside the model's limits.
ClosedForms closed_forms_of(const ChainModel& model, const ChainModel& nominal) {
  ClosedForms forms = ClosedForms::of(nominal);
  const auto tells = [&](const ClosedFormChain& form) { return form.tells_inside(model.joints); };
  if (forms.pose && !tells(*forms.pose)) forms.pose.reset();
  if (forms.residual && !tells(*forms.residual)) forms.residual.reset();
  forms.tasks.erase(std::remove_if(forms.tasks.begin(), forms.tasks.end(),
                                   [&](const auto& form) { return !tells(form.second); }),
                    forms.tasks.end());
  return forms;
}

}  // namespace

Workspace::InLanes::InLanes(const SharedBySearches& shared)
    : refiner(shared.robot.model(), shared.options, shared.kernels),
      query(shared.robot.model(), shared.nominal.model(), shared.database->data(),
            neighbours_of(shared.options.strategy), shared.kernels),
      screen(shared.robot.model(), shared.options, shared.kernels),
      closest(shared.robot.model(), shared.options.seed, shared.kernels) {
  const ChainModel& model = shared.robot.model();
  const lanes::LaneKernels& kernels = shared.kernels;
  const ClosedForms& closed_forms = shared.closed_forms;
  const bool is_nominal = shared.is_nominal();
  const double position = shared.options.position_tolerance;
  const double rotation = shared.options.rotation_tolerance;
  for (const Held::Arm& arm : shared.held_arms) held.emplace_back(model, arm, kernels);
  if (shared.has_curve) curve.emplace(model, kernels);
  if (!shared.locked_arms.arms.empty()) {
    ends.emplace(model, shared.locked_arms, position, rotation, kernels);
  }
  for (const auto& [task, chain] : closed_forms.tasks) {
    task_branches.emplace_back(task,
                               Enumeration(model, chain, is_nominal, position, rotation, kernels));
  }
  const auto tolerance_of = [&](const ClosedFormChain& chain) {
    return std::max(position / chain.unit, rotation);
  };
  if (closed_forms.residual) {
    roots.emplace(model, *closed_forms.residual, is_nominal, tolerance_of(*closed_forms.residual),
                  kernels);
    if (is_nominal && !closed_forms.residual->loop) {
      enclosure.emplace(model, *closed_forms.residual, position, rotation, kernels);
    }
  }
  const auto& closed_form = closed_forms.pose;
  if (!closed_form) return;
  if (closed_form->held < 0) {
    branches.emplace(model, *closed_form, is_nominal, position, rotation, kernels);
    if (shared.trials) branch_lanes.emplace(model, branches->chain(), *shared.trials, kernels);
  } else {
    sweep.emplace(model, *closed_form, is_nominal, position, rotation, kernels);
    nearest_on_curve.emplace(model, *closed_form, is_nominal, kernels);
    curve.emplace(model, kernels);
    if (shared.trials) branch_lanes.emplace(model, *closed_form, *shared.trials, kernels);
  }
}

Enumeration* Workspace::InLanes::branches_of(const TaskSpace& task) {
  if (task.is_full_pose()) return branches ? &*branches : nullptr;
  for (auto& [of_task, of_its_goals] : task_branches) {
    if (of_task == task.task()) return &of_its_goals;
  }
  return nullptr;
}

Workspace::OneAtATime::OneAtATime(const SharedBySearches& shared, const Paper& scheme)
    : selection(&shared.robot.model(), &shared.nominal.model(), shared.database->data(), scheme),
      task_samples(shared.robot.model(), shared.database->data(), selection) {
  if (scheme.kinematics != Kinematics::kdl) return;
  kdl_tip = shared.robot.model().make_kdl(Pose::Identity());
  kdl_tcp = shared.robot.model().make_kdl();
}

Workspace::Workspace(const SharedBySearches& shared)
    : scheme(iksel::one_at_a_time(shared.options.strategy)),
      given(shared.robot.all(), scheme,
            shared.database != nullptr ? shared.database->data().options.pinv_cutoff : 0),
      collected(shared.robot.all()) {
  minima.reserve(kRandomDescents + 1);
  if (shared.database == nullptr) return;
  collected.coaxial.emplace(shared.robot.model());
  if (shared.in_lanes) {
    lanes = std::make_unique<InLanes>(shared);
  } else {
    one_at_a_time = std::make_unique<OneAtATime>(shared, scheme);
  }
}

SharedBySearches::SharedBySearches(const Robot& robot_in, const Robot& nominal_in,
                                   const Database* database_in, const SolverOptions& options_in)
    : robot(robot_in), nominal(nominal_in), database(database_in), options(options_in) {
  if (database == nullptr) return;
  const ChainModel& model = robot.model();
  in_lanes =
      std::holds_alternative<Lanes>(options.strategy) && database->data().reduction != nullptr;
  closed_forms = closed_forms_of(model, nominal.model());
  if (!in_lanes) return;
  if (is_nominal()) held_arms = Held::arms_of(model);
  const auto& chain = closed_forms.pose;
  has_curve = !chain && model.dof == kCurveJoints && is_simple(model) && model.rank == kPoseJoints;
  if (has_arcs() || has_curve) locked_arms = LockedArms::of(model);
  if (!chain || chain->is_completed()) return;
  const bool proves = chain->held < 0 && is_nominal() && !chain->is_almost();
  const TaskSpace task(Task(), options.position_tolerance, options.rotation_tolerance);
  if (proves || chain->form.is_held) {
    trials.emplace(model, *chain, database->data(), task, kernels);
  }
}

WorkspacePool::WorkspacePool(const Robot& robot, const Robot& nominal, const Database* database,
                             const SolverOptions& options)
    : shared_(robot, nominal, database, options) {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  // All of them first: should there be no memory for one, the others go.
  std::vector<std::unique_ptr<Workspace>> made(std::min(cores, kPlaces));
  for (auto& each : made) each = std::make_unique<Workspace>(shared_);
  for (std::size_t i = 0; i < made.size(); ++i) idle_[i] = made[i].release();
}

WorkspacePool::~WorkspacePool() {
  for (auto& place : idle_) delete place.load();
}

WorkspacePool::Lease::Lease(const WorkspacePool& pool) : pool_(pool) {
  const Database* database = pool.shared_.database;
  if (database != nullptr) database->data().check_intact();
  for (auto& place : pool.idle_) {
    if (place.load(std::memory_order_relaxed) == nullptr) continue;
    workspace_ = place.exchange(nullptr, std::memory_order_acquire);
    if (workspace_ != nullptr) return;
  }
  workspace_ = std::make_unique<Workspace>(pool.shared_).release();
}

WorkspacePool::Lease::~Lease() {
  for (auto& place : pool_.idle_) {
    Workspace* expected = nullptr;
    if (place.compare_exchange_strong(expected, workspace_, std::memory_order_release,
                                      std::memory_order_relaxed)) {
      return;
    }
  }
  delete workspace_;
}

}  // namespace iksel
