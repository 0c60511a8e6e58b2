// SPDX-License-Identifier: BSD-3-Clause
// Which chains of six joints can be solved in closed form, and their constants.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "iksel/task.hpp"
#include "simd/branch_types.hpp"
#include "structure/loop_equations.hpp"
#include "structure/screw_axes.hpp"

namespace iksel {

/// Deviation of axes from being parallel [rad] or meeting [in units of the reach] up to which they
/// are taken to be: beyond what is left of a rounded pi, and far below any tolerance.
inline constexpr double kStructureTolerance = 1e-9;
/// The same where what is found is refined anyway, and nothing is proven: a pi of four decimals.
inline constexpr double kSweptTolerance = 2e-5;
/// The same of arms that are solved in closed form as if they were regular, and what is found
/// refined: of calibrated ones as well. By how much they are not is an error of the target.
inline constexpr double kAlmostTolerance = 2e-4;

/// Six consecutive joints of a chain, seen from either end; before them there may be one that is
/// held, be it a slide. A chain of fewer joints, or one for a task that leaves rotations free, is
/// completed (complete_axes).
struct ClosedFormChain {
  /// `joints[i]` is the chain's joint that the form counts as its i-th; from `dof` on, what
  /// completes it.
  int joints[6]{};
  int dof = 0;
  unsigned free = 0;  ///< bit j: joint j turns as it likes
  /// The chain's joint that is held; -1: there are but six.
  int held = -1;
  bool reversed = false;
  lanes::ClosedForm form{};
  /// Of the closure `loop`, of which the form has but the limits.
  std::shared_ptr<const LoopEquations> loop;
  /// What form.sums points at.
  std::shared_ptr<const lanes::SumForm> sums;
  double unit = 0;           ///< [m]
  double deviation = 0;      ///< of axes from where the form has them [rad, units]
  Eigen::Vector3d first;     ///< the point on axis 1 [m]
  Eigen::Vector3d tail;      ///< from the point on axis 6 to the end, in the basis [m]
  Eigen::Matrix3d to_basis;  ///< R_06 E = R * to_basis

  /// Sets the form's limits and offsets to those of a model.
  void use_limits(const ChainModel& model);
  /// Sets the target of all lanes of a pack, or of one, to Y (reduction.hpp), or its inverse if
  /// reversed.
  void set_target(const Pose& Y, lanes::BranchPack& pack) const;
  void set_target(const Pose& Y, int lane, lanes::BranchPack& pack) const;
  [[nodiscard]] bool turns_freely(int joint) const { return (free >> joint & 1U) != 0; }
  /// Whether branches tell which solutions lie inside limits: not where a joint turns as it likes
  /// in a sum.
  [[nodiscard]] bool tells_inside(const JointSpace& limits) const;
  /// By how much the form's target may be off within the tolerances of a pose [m, rad] [rad,
  /// units].
  [[nodiscard]] double tolerance_of_target(const ChainModel& model, double position,
                                           double rotation) const {
    // A rotation moves what the form sees of a target by the tool's length, and seen from the other
    // end by the arm's.
    const double lever = tail.norm() + to_pose(model.kernel.tip).translation().norm() +
                         (reversed ? model.reach_of_tcp() : 0.0);
    return std::max({(position + lever * rotation) / unit, rotation, kStructureTolerance});
  }
  /// The same of targets that the form shows for them.
  [[nodiscard]] double error_of_target(const ChainModel& model, double position,
                                       double rotation) const {
    // What axes that lie off may do to it, by their deviation, which counts each twice: they turn
    // what is behind them back and forth, and move it by as much at a lever of 1.
    constexpr double kAxesOff = 2;
    return tolerance_of_target(model, position, rotation) +
           kAxesOff * deviation * std::max(1.0, model.reach / unit);
  }
  /// Whether the axes lie only nearly as the form has them.
  [[nodiscard]] bool is_almost() const { return deviation > 12 * kStructureTolerance; }
  /// Whether there are axes besides the chain's joints.
  [[nodiscard]] bool is_completed() const { return dof < 6 || free >> dof != 0; }
  /// Whether the angles of some joints do not matter, so that each branch is a family of solutions.
  [[nodiscard]] bool has_families() const { return (free & ((1U << dof) - 1)) != 0; }
  /// Writes the joints of a lane to where they belong in q, the chain's joint values.
  void copy_joints(const double (&of_six)[6][lanes::kWidth], int lane, double* q) const;

 private:
  void use_sums(const ChainModel& model);
  /// The rows of a target, each by write(row, value).
  template <typename Write>
  void make_rows(const Pose& Y, const Write& write) const;
};

/// Whether answers lie so near to branches of a chain that something can be concluded from these:
/// of a chain other than the nominal one, and beyond such tolerances, they lie too far away.
/// `tolerance` is the larger of the solver's [rad, and m in units of the reach].
inline bool concludes_from_branches(bool is_nominal, double tolerance) {
  return is_nominal && tolerance <= 1e-4;
}

/// +-1: which solution of its subproblem number `of` a branch takes.
inline double branch_sign(int branch, int of) { return (branch >> of & 1) == 0 ? 1 : -1; }

/// A pack with another branch in each lane.
lanes::BranchPack all_branches();

/// What makes the chain solvable, if anything does, for a task that asks for the whole pose, for
/// all but a spin about one of the tool's axes, or for the position only: at once, or of seven
/// joints for each value of one, for whole poses.
std::optional<ClosedFormChain> find_closed_form(const ChainModel& model,
                                                const Task& task = Task::pose());

/// What gives a residual for each angle of one of six joints, whose roots are the solutions.
std::optional<ClosedFormChain> find_residual(const ChainModel& model);

/// The axes of a chain of fewer than six joints, or of a task that leaves rotations free, completed
/// to six: by axes behind the last joint that are locked at zero, where joints are missing, or that
/// turn as they like, where the task does not ask for a rotation.
struct CompletedAxes {
  ScrewAxes axes;
  /// Bit j: axis j turns as it likes: one behind the last joint, or a joint of which the task does
  /// not feel the angle.
  unsigned free = 0;
};

/// The ways in which the axes of a chain, whose joints all turn, can be completed for a task; none
/// if they can't. `tolerance`: as of ClosedFormChain [rad, units of the reach].
std::vector<CompletedAxes> complete_axes(const ChainModel& model, const Task& task,
                                         double tolerance);

/// The six joints in the order of the loop (loop_equations.hpp) from the one that is swept on, as
/// seen from the end from which solutions are told apart the best by that joint's angle; nothing if
/// there is none from which they are: where the axes lie so that several solutions share each of
/// its angles, or that the equations lose more than they may. `model` has six joints that turn.
std::optional<ClosedFormChain> find_loop(const ChainModel& model);

/// Whether the branches of poses of random configurations have these among them: not where the axes
/// lie so that solutions come in families, of which the form has some, or that it divides by 0. Of
/// a chain with a joint that is held, at its own value; and that joint has to move along the
/// self-motion. For full poses.
bool finds_known_solutions(const ChainModel& model, ClosedFormChain chain);

/// Whether a joint of seven moves along the self-motion anywhere: where it does not, its value is
/// fixed by the pose, and the six others are singular wherever it is held.
bool takes_part_in_self_motion(const ChainModel& model, int joint);

/// The residual of a chain whose closure is sweep_4 or sweep_6, by the angle of one of its joints,
/// for the target of a pack.
lanes::ResidualForm make_residual(const ClosedFormChain& chain, const lanes::BranchPack& pack);

/// A chain's closed forms: for whole poses, and for each of the other tasks that have one.
struct ClosedForms {
  std::optional<ClosedFormChain> pose;
  /// Where `pose` is but nearly the chain, or there is none.
  std::optional<ClosedFormChain> residual;
  std::vector<std::pair<Task, ClosedFormChain>> tasks;

  static ClosedForms of(const ChainModel& model);
};

}  // namespace iksel
