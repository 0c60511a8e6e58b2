// SPDX-License-Identifier: BSD-3-Clause
#include "search/context.hpp"

#include <algorithm>
#include <thread>

#include "options/strategy.hpp"
#include "structure/closed_form.hpp"

namespace iksel {

namespace {

bool solves_in_lanes(const DatabaseData& data, const SolverOptions& options) {
  return std::holds_alternative<Lanes>(options.strategy) && data.reduction != nullptr;
}

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

Workspace::InLanes::InLanes(const ChainModel& model, const ChainModel& nominal,
                            const DatabaseData& data, const SolverOptions& options,
                            const ClosedForms& closed_forms, const BranchTrials* trials,
                            const lanes::LaneKernels& kernels)
    : refiner(model, options, kernels),
      query(model, nominal, data, neighbours_of(options.strategy), kernels),
      screen(model, options, kernels),
      closest(model, options.seed, kernels) {
  const bool is_nominal = &model == &nominal;
  const double position = options.position_tolerance;
  const double rotation = options.rotation_tolerance;
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
    if (trials != nullptr) branch_lanes.emplace(model, branches->chain(), *trials, kernels);
  } else {
    sweep.emplace(model, *closed_form, is_nominal, position, rotation, kernels);
    nearest_on_curve.emplace(model, *closed_form, is_nominal, kernels);
    curve.emplace(model, kernels);
    if (trials != nullptr) branch_lanes.emplace(model, *closed_form, *trials, kernels);
  }
}

Enumeration* Workspace::InLanes::branches_of(const TaskSpace& task) {
  if (task.is_full_pose()) return branches ? &*branches : nullptr;
  for (auto& [of_task, of_its_goals] : task_branches) {
    if (of_task == task.task()) return &of_its_goals;
  }
  return nullptr;
}

Workspace::OneAtATime::OneAtATime(const ChainModel& model, const ChainModel& nominal,
                                  const DatabaseData& data, const SolverOptions& options,
                                  const Paper& scheme)
    : refiner(model, scheme, options.max_iterations),
      selection(&model, &nominal, data, scheme),
      task_samples(model, data, selection) {}

Workspace::Workspace(const ChainModel& model, const ChainModel& nominal, const DatabaseData& data,
                     const SolverOptions& options, const ClosedForms& closed_forms,
                     const BranchTrials* trials, const lanes::LaneKernels& kernels)
    : scheme(iksel::one_at_a_time(options.strategy)),
      given(model, scheme, data.options.pinv_cutoff),
      collected(model) {
  minima.reserve(kRandomDescents + 1);
  collected.coaxial.emplace(model);
  if (solves_in_lanes(data, options)) {
    lanes = std::make_unique<InLanes>(model, nominal, data, options, closed_forms, trials, kernels);
  } else {
    one_at_a_time = std::make_unique<OneAtATime>(model, nominal, data, options, scheme);
  }
}

Workspace::Workspace(const RobotModel& several, const SolverOptions& options)
    : scheme(iksel::one_at_a_time(options.strategy)),
      given(several, scheme, /*cutoff=*/0),
      collected(several) {
  minima.reserve(kRandomDescents + 1);
}

WorkspacePool::WorkspacePool(const Robot& robot, const Robot& nominal, const Database& database,
                             const SolverOptions& options)
    : robot_(robot),
      nominal_(nominal),
      database_(&database),
      options_(options),
      closed_forms_(closed_forms_of(robot.model(), nominal.model())),
      solves_in_lanes_(iksel::solves_in_lanes(database.data(), options)),
      damaged_(database.data().storage.damaged) {
  if (solves_in_lanes_ && &robot.model() == &nominal.model()) {
    held_arms_ = Held::arms_of(robot.model());
  }
  const auto& chain = closed_forms_.pose;
  has_curve_ = solves_in_lanes_ && !chain && robot.dof() == kCurveJoints &&
               is_simple(robot.model()) && !is_singular_everywhere(robot.model());
  if (solves_in_lanes_ && (has_arcs() || has_curve_)) locked_arms_ = LockedArms::of(robot.model());
  if (solves_in_lanes_ && chain && !chain->is_completed()) {
    const bool proves =
        chain->held < 0 && &robot.model() == &nominal.model() && !chain->is_almost();
    const TaskSpace task(Task(), options.position_tolerance, options.rotation_tolerance);
    if (proves || chain->form.is_held) {
      trials_.emplace(robot.model(), *chain, database.data(), task, kernels_);
    }
  }
  fill();
}

WorkspacePool::WorkspacePool(const Robot& several, const SolverOptions& options)
    : robot_(several), nominal_(several), database_(nullptr), options_(options) {
  fill();
}

void WorkspacePool::fill() {
  const std::size_t cores = std::max(1U, std::thread::hardware_concurrency());
  for (std::size_t i = 0; i < std::min(cores, kPlaces); ++i) idle_[i] = make().release();
}

WorkspacePool::~WorkspacePool() {
  for (auto& place : idle_) delete place.load();
}

std::unique_ptr<Workspace> WorkspacePool::make() const {
  if (database_ == nullptr) return std::make_unique<Workspace>(robot_.all(), options_);
  auto workspace =
      std::make_unique<Workspace>(robot_.model(), nominal_.model(), database_->data(), options_,
                                  closed_forms_, trials_ ? &*trials_ : nullptr, kernels_);
  for (const Held::Arm& arm : held_arms_) {
    workspace->lanes->held.emplace_back(robot_.model(), arm, kernels_);
  }
  if (has_curve_) workspace->lanes->curve.emplace(robot_.model(), kernels_);
  if (!locked_arms_.arms.empty()) {
    workspace->lanes->ends.emplace(robot_.model(), locked_arms_, options_.position_tolerance,
                                   options_.rotation_tolerance, kernels_);
  }
  return workspace;
}

WorkspacePool::Lease::Lease(const WorkspacePool& pool) : pool_(pool) {
  if (pool.damaged_ != nullptr) pool.database_->data().check_intact();
  for (auto& place : pool.idle_) {
    if (place.load(std::memory_order_relaxed) == nullptr) continue;
    workspace_ = place.exchange(nullptr, std::memory_order_acquire);
    if (workspace_ != nullptr) return;
  }
  workspace_ = pool.make().release();
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
