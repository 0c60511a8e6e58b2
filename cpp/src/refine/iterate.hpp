// SPDX-License-Identifier: BSD-3-Clause
// From one seed to a solution, by the scheme that the options choose.
//
// Steps are made for the pose of the tip link, where the database's samples lie too, whatever the
// tool; the tolerances are tested at the TCP. The paper's figures come out this way only: with the
// TCP of C1 0.2 m beyond its flange, stepping at the TCP loses 2.6 points of success. A task that
// leaves something of the pose open does not say where the tip link is to be, and steps at the TCP.
#pragma once

#include "base/random.hpp"
#include "goal/goal.hpp"
#include "iksel/options.hpp"
#include "kinematics/chain_model.hpp"
#include "kinematics/kdl_chain.hpp"

namespace iksel {

/// How an attempt ended.
enum class Outcome {
  solved,          ///< within both tolerances and inside the limits
  outside_limits,  ///< within both tolerances at some point, but outside the limits
  failed,
};

/// What an attempt needs besides its seed.
struct IterationContext {
  const ChainModel& model;
  const Paper& scheme;
  int max_iterations;
  const Goal& goal;
  /// Where the tip link has to be: only for a full pose.
  Pose tip_target;
  /// Used instead of the kernel if not null: without the tool for a full pose, else with it.
  KdlChain* kdl;
  /// Source of restarts.
  Random& random;
};

/// Iterates q, in place, from the seed it holds. `steps` counts the steps taken. Never throws.
Outcome iterate(const IterationContext& context, JointVector& q, int& steps);

}  // namespace iksel
