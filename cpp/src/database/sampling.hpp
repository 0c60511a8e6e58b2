// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "iksel/options.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

/// Number of samples that the options ask for.
std::size_t sample_count(const ChainModel& model, const DatabaseOptions& options);

/// Joint samples, dof values each, one after another. `on_progress` is called with the number of
/// updates done (cvt only).
std::vector<double> make_samples(const ChainModel& model, const DatabaseOptions& options,
                                 const std::function<void(std::size_t)>& on_progress);

/// Centroidal Voronoi tessellation of the joint limits, starting from `samples`.
void refine_by_cvt(const ChainModel& model, const DatabaseOptions& options,
                   std::vector<double>& samples,
                   const std::function<void(std::size_t)>& on_progress);

}  // namespace iksel
