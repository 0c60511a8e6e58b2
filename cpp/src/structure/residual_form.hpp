// SPDX-License-Identifier: BSD-3-Clause
// The residual of a chain by the angle of one of its joints, for a target.
#pragma once

#include "structure/closed_form.hpp"

namespace iksel {

/// Of a chain whose closure is sweep_4 or sweep_6, and the target of a pack.
lanes::ResidualForm make_residual(const ClosedFormChain& chain, const lanes::BranchPack& pack);

}  // namespace iksel
