// SPDX-License-Identifier: BSD-3-Clause
// From coupled limits by names to rows over a chain's degrees of freedom.
#pragma once

#include "iksel/coupled_limit.hpp"
#include "kinematics/joint_space.hpp"
#include "urdf/chain_spec.hpp"

namespace iksel {

/// Adds the limits to `joints`, whose own are set. Mimic joints become their sources, locked ones
/// constants. Throws InvalidArgumentError, naming the limit and what is wrong with it: no number, a
/// joint that turns without limits, nothing between its ends, or no configuration inside of all;
/// UnknownNameError for a name that is no joint of the chain.
void add_coupled_limits(const std::vector<CoupledLimit>& limits, const ChainSpec& spec,
                        JointSpace& joints);

}  // namespace iksel
