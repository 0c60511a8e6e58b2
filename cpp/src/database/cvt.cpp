// SPDX-License-Identifier: BSD-3-Clause
// Centroidal Voronoi tessellation by MacQueen's method (the sampling of the paper's revision).
//
// MacQueen draws one random point after another and moves the generator nearest to it to the mean
// of all points it has drawn so far. Here the nearest generators are looked up for a round of draws
// at a time, against the generators as they stood before the round, and the moves are then made in
// order: rounds are spread over threads and give the same bits for any number of them.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "database/kd_tree.hpp"
#include "database/sampling.hpp"

namespace iksel {
namespace {

/// A random point inside the limits, scaled; they are convex, and so means stay inside.
void draw_point(const SampleSpace& space, const std::vector<double>& scale, Random& random,
                double* point) {
  double q[kMaxDof];
  space.draw_inside(q, [&] {
    for (std::size_t j = 0; j < space.dof(); ++j) {
      const double lower = space.lower[j] * scale[j];
      point[j] = lower + (space.upper[j] - space.lower[j]) * scale[j] * random.uniform();
      q[j] = point[j] / scale[j];
    }
  });
}

}  // namespace

void refine_by_cvt(const SampleSpace& space, const DatabaseOptions& options,
                   std::vector<double>& samples,
                   const std::function<void(std::size_t)>& on_progress) {
  const std::size_t dof = space.dof();
  const std::size_t count = samples.size() / dof;

  // Distances are taken in radians; slides are scaled so that the arm's reach counts as a radian.
  std::vector<double> scale(dof);
  for (std::size_t j = 0; j < dof; ++j) scale[j] = 1.0 / space.unit[j];
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] *= scale[i % dof];

  // A generator should rarely be drawn twice in a round, and the tree not be built too often.
  const std::size_t round = std::max<std::size_t>(1, std::min(options.cvt_updates, count / 4 + 1));
  std::vector<double> draws(round * dof);
  std::vector<Neighbour> nearest(round);
  std::vector<std::uint32_t> hits(count, 1);
  const int threads = resolve_threads(options.threads);

  for (std::size_t first = 0; first < options.cvt_updates; first += round) {
    const std::size_t size = std::min(round, options.cvt_updates - first);
    const auto tree = make_kd_tree(samples.data(), count, static_cast<int>(dof));
    const auto look_up = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Random random = Random::stream(options.seed + 1, first + i);
        draw_point(space, scale, random, &draws[i * dof]);
        tree->nearest(&draws[i * dof], 1, &nearest[i]);
      }
    };
    parallel_for(
        size, 1024, threads, [&] { return look_up; },
        [&](std::size_t done) { on_progress(first + done); });
    for (std::size_t i = 0; i < size; ++i) {
      const std::uint32_t g = nearest[i].index;
      const double share = 1.0 / ++hits[g];
      for (std::size_t j = 0; j < dof; ++j) {
        double& value = samples[g * dof + j];
        value += share * (draws[i * dof + j] - value);
      }
    }
  }
  for (std::size_t i = 0; i < samples.size(); ++i) samples[i] /= scale[i % dof];
}

}  // namespace iksel
