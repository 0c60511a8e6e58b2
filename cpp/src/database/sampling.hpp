// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "database/reduction.hpp"
#include "iksel/options.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

/// The joints that samples are spread over, and their ranges.
struct SampleSpace {
  std::vector<double> lower, upper;
  /// Length in the joint's own unit that counts as 1 rad between samples.
  std::vector<double> unit;
  /// Over these joints.
  std::vector<Limit> sums;

  [[nodiscard]] std::size_t dof() const { return lower.size(); }
  /// Draws a sample by draw(), again where a sum is outside its limits, though not without end.
  template <typename Draw>
  void draw_inside(const double* sample, const Draw& draw) const {
    for (int i = 0; i < kMostDraws; ++i) {
      draw();
      if (contain(sums, sample)) return;
    }
  }
};

/// All joints, or those that `reduction` does not leave out.
SampleSpace sample_space(const ChainModel& model, const Reduction* reduction);

/// Number of samples that the options ask for; of a grid, those whose sums are outside included.
std::size_t sample_count(const SampleSpace& space, const DatabaseOptions& options);

/// Points that a tessellation is made of, each as often as it is looked at; else 0.
std::size_t update_count(const DatabaseOptions& options);

/// Joint samples, space.dof() values each, one after another. `on_progress` is called with the
/// number of updates done.
std::vector<double> make_samples(const SampleSpace& space, const DatabaseOptions& options,
                                 const std::function<void(std::size_t)>& on_progress);

/// Centroidal Voronoi tessellation of the joint limits by cvt or kmeans, starting from `samples`.
void tessellate(const SampleSpace& space, const DatabaseOptions& options,
                std::vector<double>& samples, const std::function<void(std::size_t)>& on_progress);

}  // namespace iksel
