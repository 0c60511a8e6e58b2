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
#include "kinematics/kdl_chain.hpp"
#include "refine/closest_descent.hpp"
#include "refine/lane_refiner.hpp"
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

/// What all searches of a solver read.
struct SharedBySearches {
  /// `nominal` is the robot that the database was built for; of several tips, whose chains have
  /// their own, there is none.
  SharedBySearches(const Robot& robot, const Robot& nominal, const Database* database,
                   const SolverOptions& options);

  /// Whether the chain is that which the database and the closed forms are of.
  [[nodiscard]] bool is_nominal() const { return &robot.model() == &nominal.model(); }
  /// Whether the self-motion is known as arcs.
  [[nodiscard]] bool has_arcs() const { return closed_forms.pose && closed_forms.pose->held >= 0; }

  const Robot& robot;
  const Robot& nominal;
  const Database* database;
  const SolverOptions& options;
  /// Of all workspaces, whatever IKSEL_SIMD says when they are made.
  const lanes::LaneKernels& kernels = lanes::choose_kernels();
  /// Whether searches of one tip are in lanes, if the options, the chain and the database allow it;
  /// else one seed at a time.
  bool in_lanes = false;
  /// Whether seven joints of which none can be swept have a self-motion that is a curve.
  bool has_curve = false;
  /// Of the nominal chain.
  ClosedForms closed_forms;
  std::vector<Held::Arm> held_arms;
  LockedArms locked_arms;
  std::optional<BranchTrials> trials;
};

/// What one search writes to. Never shared between two at once.
struct Workspace {
  explicit Workspace(const SharedBySearches& shared);

  /// The scheme of one seed at a time, by which given seeds are ranked too.
  Paper scheme;
  SeedRanking given;
  CollectorMemory collected;
  /// Where descents to what is closest ended.
  std::vector<LocalMinimum> minima;
  /// Which of some solutions beside limits were moved inside.
  std::vector<int> tried;

  struct InLanes {
    explicit InLanes(const SharedBySearches& shared);

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
    /// Whether the ends of arcs tell in closed form that there are none.
    [[nodiscard]] bool has_closed_ends() const { return ends && ends->are_closed(); }
    /// Whether solutions lie on arcs of which seeds alone tell, some of their ends not being known.
    [[nodiscard]] bool has_unknown_arcs() const {
      return curve && !sweep && !(ends && ends->are_all());
    }
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
    OneAtATime(const SharedBySearches& shared, const Paper& scheme);

    /// Only if the options iterate by KDL, whose objects are not safe to share: to the tip link for
    /// a full pose, else to the TCP.
    std::unique_ptr<KdlChain> kdl_tip, kdl_tcp;
    Selection selection;
    TaskSamples task_samples;
  };
  /// Of one tip one of the two, of several neither.
  std::unique_ptr<InLanes> lanes;
  std::unique_ptr<OneAtATime> one_at_a_time;
};

/// Workspaces of a solver, each lent to one search at a time.
class WorkspacePool {
 public:
  /// As SharedBySearches; all must outlive this.
  WorkspacePool(const Robot& robot, const Robot& nominal, const Database* database,
                const SolverOptions& options);
  WorkspacePool(const WorkspacePool&) = delete;
  WorkspacePool& operator=(const WorkspacePool&) = delete;
  ~WorkspacePool();

  [[nodiscard]] const SharedBySearches& shared() const { return shared_; }

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
  SharedBySearches shared_;
  /// Those that lie idle; a null is a place to put one back. More solves at once than places make
  /// their own.
  static constexpr std::size_t kPlaces = 64;
  mutable std::array<std::atomic<Workspace*>, kPlaces> idle_{};
};

}  // namespace iksel
