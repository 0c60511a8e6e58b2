// SPDX-License-Identifier: BSD-3-Clause
// A chain's coupled limits as its closed form counts the joints.
#pragma once

#include <memory>

#include "kinematics/chain_model.hpp"
#include "structure/closed_form.hpp"

namespace iksel {

/// Null if there are none.
std::shared_ptr<const lanes::CoupledForm> make_coupled_form(const ChainModel& model,
                                                            const ClosedFormChain& chain);

/// Whether branches of the chain tell which solutions lie inside the model's coupled limits: not
/// where a joint in them turns as it likes.
bool suits_coupled_limits(const ChainModel& model, const ClosedFormChain& chain);

}  // namespace iksel
