// SPDX-License-Identifier: BSD-3-Clause
// The pipeline query -> rank -> iterate -> re-select.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "iksel/database.hpp"
#include "iksel/diagnosis.hpp"
#include "iksel/export.hpp"
#include "iksel/options.hpp"
#include "iksel/path.hpp"
#include "iksel/request.hpp"
#include "iksel/result.hpp"
#include "iksel/robot.hpp"
#include "iksel/self_motion.hpp"

namespace iksel {

class ArmSearch;

/// The largest difference between the tip links' poses of a calibrated chain and its nominal one at
/// the same joint values.
struct IKSEL_EXPORT CalibrationDeviation {
  double position = 0;  ///< [m]
  double rotation = 0;  ///< [rad]

  /// Throws InvalidArgumentError unless both can bound a deviation.
  void validate() const;
};

/// That of `robot` from `nominal` over `samples` configurations uniform inside the limits; tools
/// are left out. Throws InvalidArgumentError if the numbers of joints differ.
IKSEL_EXPORT CalibrationDeviation measure_calibration_deviation(const Robot& robot,
                                                                const Robot& nominal,
                                                                std::size_t samples = 2'000);

/// Solves inverse kinematics for one robot, with one tip or several. Immutable; copies share the
/// data. Safe to use from many threads at once, and the same input gives the same bits from any of
/// them. Solving allocates nothing on the heap as long as no more threads solve at once than the
/// machine has cores.
class IKSEL_EXPORT Solver {
 public:
  /// Builds a database by `options.database`, of several tips one for the chain of each. Throws
  /// InvalidArgumentError on options out of range.
  ///
  /// Of several tips the tolerances, the task and the bounds on work hold for each. The joints that
  /// they share are set to a value, and behind them each arm is a chain that is solved for by
  /// itself, completely where a chain is (find_structure). Where that leads nowhere, or an arm has
  /// too few joints of its own for its task, all joints are iterated together: Levenberg-Marquardt
  /// with the limits inside the step on the errors of all tips. Where below is one pose, it is of
  /// the only tip; several poses are one for each tip, in the order of Robot::tip_links.
  explicit Solver(const Robot& robot, const SolverOptions& options = {});
  /// Uses a given database. Throws DatabaseMismatchError if it belongs to another chain.
  Solver(const Robot& robot, const SolverOptions& options, const Database& database);
  /// A calibrated arm: uses a database that was built for `nominal`, whose constants differ a
  /// little from the robot's. Seeds come from the nominal chain; iterations, tolerances and limits
  /// are the robot's own. Throws DatabaseMismatchError if the database does not belong to
  /// `nominal`, or calibration_deviation() is beyond `bound`.
  Solver(const Robot& robot, const SolverOptions& options, const Database& database,
         const Robot& nominal, const CalibrationDeviation& bound = kMaxCalibrationDeviation);

  /// Deviation up to which a database serves a calibrated chain: several times what calibrations
  /// of industrial arms find.
  static constexpr CalibrationDeviation kMaxCalibrationDeviation{0.05, 0.1};

  /// The robot it solves for.
  [[nodiscard]] const Robot& robot() const;
  /// Its options.
  [[nodiscard]] const SolverOptions& options() const;
  /// The database it selects seeds from. Of several tips each chain_solver has its own: throws
  /// InvalidArgumentError.
  [[nodiscard]] const Database& database() const;
  /// The solver of one tip's chain by itself; tips count from 0. Throws InvalidArgumentError if
  /// there is no such tip.
  [[nodiscard]] const Solver& chain_solver(int tip) const;
  /// The chain that the database was built for: the robot itself, unless that is a calibrated one.
  [[nodiscard]] const Robot& nominal() const;
  /// The robot's deviation from `nominal`.
  [[nodiscard]] CalibrationDeviation calibration_deviation() const;

  /// Most iteration steps that one solve without given seeds can spend, over all its seeds:
  /// max_attempts * max_iterations. A step of a whole pack of lanes counts once in
  /// Result::iterations, so that solves in lanes stay below this by the number of lanes.
  [[nodiscard]] std::size_t work_bound() const;

  /// Joint values that put the TCP (the tip link's frame, if there is no tool) at T_base_tip, or if
  /// that is rounded at the nearest rigid pose. Throws InvalidArgumentError if it is none
  /// (check_pose); a pose that cannot be solved is no error but a status, and Result::proof says
  /// how certain that is. For arms of few joints see task_hint.
  [[nodiscard]] Result solve(const Pose& T_base_tip) const;
  /// As above, for a request; the time of each stage is added to `times` if that is not null. A
  /// request that asks for nothing gives solve(T_base_tip).
  [[nodiscard]] Result solve(const Pose& T_base_tip, const SolveRequest& request,
                             StageTimes* times = nullptr) const;
  /// Joint values that put each tip at its pose. Throws as solve, and InvalidArgumentError if there
  /// is not one pose for each tip.
  [[nodiscard]] Result solve(const std::vector<Pose>& T_base_tip, const SolveRequest& request = {},
                             StageTimes* times = nullptr) const;

  /// Every distinct solution inside the limits that is found within the bounds on work: all
  /// branches of an arm with as many joints as the pose has directions (Solutions::proof says
  /// whether there certainly are no others), a spread over the families of a redundant one, which
  /// may leave out small arcs that self_motion has. With an objective the best by that first, where
  /// they are found. Throws as solve.
  [[nodiscard]] Solutions solve_all(const Pose& T_base_tip, const SolveAllOptions& options = {},
                                    const SolveRequest& request = {}) const;
  [[nodiscard]] Solutions solve_all(const std::vector<Pose>& T_base_tip,
                                    const SolveAllOptions& options = {},
                                    const SolveRequest& request = {}) const;

  /// All solutions of a redundant arm at once: the arcs of its self-motion inside the limits, with
  /// what ends each (iksel/self_motion.hpp). For seven joints of which one can be swept
  /// (find_structure); one joint moves by at most `spacing` from a sample to the next [rad]. Each
  /// arc that a joint's limit ends is followed from there; a closed one, or one that coupled limits
  /// end, may be missed if it lies between two of 128 samples of the swept joint. Throws
  /// InvalidArgumentError on a robot of another structure, a task with free axes, a strategy other
  /// than Lanes, a spacing not in [0.0001, pi], and a pose that is none.
  [[nodiscard]] SelfMotion self_motion(const Pose& T_base_tip, double spacing = 0.1) const;

  /// Why solve(T_base_tip, request) gives no answer, and the best that can be done. Where a closed
  /// form proves that there is none, its branches say why: no search. Else it spends more than
  /// solving does, milliseconds. Throws as solve.
  [[nodiscard]] Diagnosis diagnose(const Pose& T_base_tip, const SolveRequest& request = {}) const;
  [[nodiscard]] Diagnosis diagnose(const std::vector<Pose>& T_base_tip,
                                   const SolveRequest& request = {}) const;

  /// Joint values along a path of poses, by a choice among the solutions of all waypoints that
  /// makes the whole way in joint space short. Of several tips the poses of all at the first
  /// waypoint, at the second, ... Throws InvalidArgumentError naming a bad pose or option.
  [[nodiscard]] PathResult solve_path(const std::vector<Pose>& T_base_tip,
                                      const PathOptions& options) const;

  /// Solves many targets (of several tips the poses of all at the first, at the second, ...);
  /// result i belongs to target i and has the same bits whatever the number
  /// of threads and whatever else is in the batch. It has the bits that solve() gives, but in
  /// lanes: there a target has a lane to itself. Where all joints are solved in closed form, only
  /// `attempts` differs, which counts no branches after the first that is an answer; else the
  /// answer may be another of the target's solutions, within the same tolerances. `threads` = 0
  /// takes one per core. A target that is no pose has Status::invalid_pose;
  /// SolveRequest::on_invalid_pose can have it thrown instead.
  ///
  /// The request holds for each target by itself. `near` is empty, or has one
  /// configuration for each target, which counts instead of the request's. A filter is asked about
  /// the first answers of up to 256 targets at once; only where it refuses, the search for that
  /// target continues. Calls to it come from any thread, one at a time.
  [[nodiscard]] std::vector<Result> solve_batch(const std::vector<Pose>& T_base_tip,
                                                const SolveRequest& request = {},
                                                const std::vector<JointVector>& near = {},
                                                int threads = 0) const;
  /// The same over `count` targets, 4x4 matrices row by row, into arrays that the caller owns;
  /// `near` is null, or has (count, dof) values row by row. An exception of `progress` ends the
  /// batch and reaches the caller.
  void solve_batch(const double* T_base_tip, std::size_t count, const SolveRequest& request,
                   const double* near, const BatchView& out, int threads = 0,
                   const Progress& progress = {}) const;

  /// What it holds; for the library's own files.
  struct Impl;

 private:
  friend class ArmSearch;
  friend class Tracker;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace iksel
