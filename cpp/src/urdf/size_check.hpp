// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "urdf/chain_spec.hpp"

namespace iksel {

/// Throws UrdfError, naming the joint, where a length or joint value of the chain, or the chain as
/// a whole, is beyond kMaxCoordinate or not finite.
void check_sizes(const ChainSpec& spec);

}  // namespace iksel
