// SPDX-License-Identifier: BSD-3-Clause
// What the searches of one solver share, and what each of them writes to.
#pragma once

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <vector>

#include "goal/goal.hpp"
#include "iksel/database.hpp"
#include "iksel/options.hpp"
#include "iksel/robot.hpp"
#include "refine/closest_descent.hpp"
#include "refine/lane_refiner.hpp"
#include "refine/scheme_refiner.hpp"
#include "search/collector.hpp"
#include "seeds/arc_ends.hpp"
#include "seeds/branch_enclosure.hpp"
#include "seeds/branch_lanes.hpp"
#include "seeds/closest_screen.hpp"
#include "seeds/curve.hpp"
#include "seeds/enumeration.hpp"
#include "seeds/free_samples.hpp"
#include "seeds/held.hpp"
#include "seeds/lane_query.hpp"
#include "seeds/nearest_on_curve.hpp"
#include "seeds/root_sweep.hpp"
#include "seeds/screened_seeds.hpp"
#include "seeds/seed_ranking.hpp"
#include "seeds/selection.hpp"
#include "seeds/sweep.hpp"
#include "seeds/task_samples.hpp"

namespace iksel {

/// What one search writes to. Never shared between two at once.
struct Workspace {
  /// `nominal` is the chain that the data belongs to; `closed_forms` are its own.
  Workspace(const ChainModel& model, const ChainModel& nominal, const DatabaseData& data,
            const SolverOptions& options, const ClosedForms& closed_forms,
            const BranchTrials* trials, const lanes::LaneKernels& kernels);
  /// Of several tips, whose chains have their own: neither in lanes nor one at a time.
  Workspace(const RobotModel& several, const SolverOptions& options);

  /// The scheme of one seed at a time, by which given seeds are ranked too.
  Paper scheme;
  SeedRanking given;
  CollectorMemory collected;
  /// Where descents to what is closest ended.
  std::vector<LocalMinimum> minima;
  /// Which of some solutions beside limits were moved inside.
  std::vector<int> tried;

  /// One of two ways to search of one tip: lanes, if the options, the chain and the database allow
  /// it.
  struct InLanes {
    InLanes(const ChainModel& model, const ChainModel& nominal, const DatabaseData& data,
            const SolverOptions& options, const ClosedForms& closed_forms,
            const BranchTrials* trials, const lanes::LaneKernels& kernels);

    LaneRefiner refiner;
    LaneQuery query;
    SeedScreen screen;
    ClosestScreen closest;
    /// The arcs of the self-motion, for a target and its Y (reduction.hpp); where no joint is
    /// swept, what is known of it are its ends and so many solutions.
    const std::vector<Curve::Arc>& find_arcs(const Pose& T_base_tcp, const Pose& Y, double spacing,
                                             const double* known = nullptr, std::size_t count = 0) {
      return curve->find(T_base_tcp, Y, ends ? &*ends : nullptr, sweep ? &*sweep : nullptr, known,
                         count, spacing);
    }
    /// The proof that a self-motion has no configuration inside the limits, for the same; none if
    /// one is found between the samples, or in doubt.
    Proof find_none(const Pose& T_base_tcp, const Pose& Y) {
      if (ends && ends->rules_out(T_base_tcp)) return Proof::closed_form;
      return sweep->find_between(Y) ? Proof::none : sweep->proof_of_none();
    }
    /// Whether the ends of arcs tell in closed form that there are none.
    [[nodiscard]] bool has_closed_ends() const { return ends && ends->are_closed(); }
    /// All branches of a goal of that task; null if it cannot be solved in closed form at once.
    [[nodiscard]] Enumeration* branches_of(const TaskSpace& task);

    /// Only of a chain that can be solved in closed form, at once or for each value of a joint.
    std::optional<Enumeration> branches;
    std::vector<std::pair<Task, Enumeration>> task_branches;
    std::optional<BranchLanes> branch_lanes;
    std::optional<Sweep> sweep;
    std::optional<RootSweep> roots;
    /// What proves that these are none, if the chain is the nominal one.
    std::optional<BranchEnclosure> enclosure;
    std::optional<NearestOnCurve> nearest_on_curve;
    std::optional<Curve> curve;
    std::optional<ArcEnds> ends;
    /// Of longer chains.
    std::vector<Held> held;
    /// Configurations of a self-motion that a scene is to look at.
    FreeSamples::Memory samples;
  };
  struct OneAtATime {
    OneAtATime(const ChainModel& model, const ChainModel& nominal, const DatabaseData& data,
               const SolverOptions& options, const Paper& scheme);

    SchemeRefiner refiner;
    Selection selection;
    TaskSamples task_samples;
  };
  std::unique_ptr<InLanes> lanes;
  std::unique_ptr<OneAtATime> one_at_a_time;
};

/// Workspaces of a solver, each lent to one search at a time.
class WorkspacePool {
 public:
  WorkspacePool(const Robot& robot, const Robot& nominal, const Database& database,
                const SolverOptions& options);
  /// Of several tips.
  WorkspacePool(const Robot& several, const SolverOptions& options);
  WorkspacePool(const WorkspacePool&) = delete;
  WorkspacePool& operator=(const WorkspacePool&) = delete;
  ~WorkspacePool();

  /// Of all its workspaces, whatever IKSEL_SIMD says when they are made.
  [[nodiscard]] const lanes::LaneKernels& kernels() const { return kernels_; }

  /// Whether its workspaces solve in lanes.
  [[nodiscard]] bool solves_in_lanes() const { return solves_in_lanes_; }

  /// Whether the self-motion is known as arcs.
  [[nodiscard]] bool has_arcs() const {
    return closed_forms_.pose && closed_forms_.pose->held >= 0;
  }

  /// A workspace, given back when this goes. Throws DatabaseError if the database was damaged since
  /// it was mapped.
  class Lease {
   public:
    explicit Lease(const WorkspacePool& pool);
    Lease(const Lease&) = delete;
    Lease& operator=(const Lease&) = delete;
    ~Lease();
    [[nodiscard]] Workspace& get() const { return *workspace_; }

   private:
    const WorkspacePool& pool_;
    Workspace* workspace_ = nullptr;
  };

 private:
  [[nodiscard]] std::unique_ptr<Workspace> make() const;

  const lanes::LaneKernels& kernels_ = lanes::choose_kernels();

  void fill();

  const Robot& robot_;
  const Robot& nominal_;
  const Database* database_;  ///< null: of several tips
  const SolverOptions& options_;
  ClosedForms closed_forms_;
  std::vector<Held::Arm> held_arms_;
  LockedArms locked_arms_;
  bool solves_in_lanes_ = false;
  std::optional<BranchTrials> trials_;
  /// Whether seven joints of which none can be swept have a self-motion that is a curve.
  bool has_curve_ = false;
  /// As Storage::damaged of the database.
  const std::atomic<bool>* damaged_ = nullptr;
  /// Those that lie idle; a null is a place to put one back. More solves at once than places make
  /// their own.
  static constexpr std::size_t kPlaces = 64;
  mutable std::array<std::atomic<Workspace*>, kPlaces> idle_{};
};

}  // namespace iksel
