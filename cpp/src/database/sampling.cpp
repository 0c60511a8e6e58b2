// SPDX-License-Identifier: BSD-3-Clause
#include "database/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/low_discrepancy.hpp"
#include "base/random.hpp"
#include "iksel/database.hpp"

namespace iksel {
namespace {

/// In doubles: 4^32 does not fit an integer.
double product(const std::vector<int>& counts) {
  return std::accumulate(counts.begin(), counts.end(), 1.0, std::multiplies<>());
}

/// k_i = int(linspace(N, 4, dof, endpoint=False)[i])
std::vector<int> paper_counts(int dof, Scale scale) {
  int most = 8;
  if (scale == Scale::small) most = 6;
  if (scale == Scale::large) most = 10;
  std::vector<int> counts(static_cast<std::size_t>(dof));
  for (int i = 0; i < dof; ++i) {
    counts[static_cast<std::size_t>(i)] =
        static_cast<int>(most + static_cast<double>(i) * (4.0 - most) / dof);
  }
  return counts;
}

void fill_grid(const SampleSpace& space, const DatabaseOptions& options,
               std::vector<double>& samples) {
  const std::vector<int> counts = grid_counts(static_cast<int>(space.dof()), options.scale);
  const std::size_t dof = space.dof();
  for (std::size_t i = 0; i < samples.size() / dof; ++i) {
    std::size_t rest = i;
    for (std::size_t j = dof; j-- > 0;) {
      const auto count = static_cast<std::size_t>(counts[j]);
      const auto step = static_cast<double>(rest % count + 1);
      rest /= count;
      const double lower = space.lower[j];
      const double upper = space.upper[j];
      // linspace(lower, upper, count + 2) without its ends
      samples[i * dof + j] = lower + (upper - lower) * (step / static_cast<double>(count + 1));
    }
  }
}

/// Fills the samples one after the other, joint j where part(j) in [0, 1) of its range is.
template <typename Part>
void fill_by_parts(const SampleSpace& space, std::vector<double>& samples, const Part& part) {
  const std::size_t dof = space.dof();
  for (std::size_t i = 0; i < samples.size(); i += dof) {
    space.draw_inside(&samples[i], [&] {
      for (std::size_t j = 0; j < dof; ++j) {
        samples[i + j] = space.lower[j] + (space.upper[j] - space.lower[j]) * part(j);
      }
    });
  }
}

void fill_random(const SampleSpace& space, std::uint64_t seed, std::vector<double>& samples) {
  Random random(seed);
  fill_by_parts(space, samples, [&](std::size_t) { return random.uniform(); });
}

/// Shifted by the seed.
void fill_low_discrepancy(const SampleSpace& space, std::uint64_t seed,
                          std::vector<double>& samples) {
  const std::vector<double> step = low_discrepancy_steps(space.dof());
  Random random(seed);
  std::vector<double> shift(space.dof());
  for (double& each : shift) each = random.uniform();
  double index = 0;
  fill_by_parts(space, samples, [&](std::size_t j) {
    if (j == 0) ++index;
    const double x = shift[j] + step[j] * index;
    return x - std::floor(x);
  });
}

}  // namespace

std::vector<int> grid_counts(int dof, Scale scale) {
  std::vector<int> counts = paper_counts(dof, scale);
  // The paper stops at 7 joints, and the product would explode: lower the largest count, the last
  // of equals first, until there are no more samples than the paper has for 7 joints.
  const double most = product(paper_counts(std::min(dof, 7), scale));
  while (product(counts) > most) {
    const auto largest = std::max_element(counts.rbegin(), counts.rend());
    if (*largest == 1) break;
    --*largest;
  }
  return counts;
}

SampleSpace sample_space(const ChainModel& model, const Reduction* reduction) {
  SampleSpace space;
  for (int j = 0; j < model.dof; ++j) {
    if (reduction != nullptr && reduction->leaves_out(j)) continue;
    space.lower.push_back(model.joints.sample_lower(j));
    space.upper.push_back(model.joints.sample_upper(j));
    const bool slides = model.joints.is_slide(j);
    space.unit.push_back(slides ? std::max(model.reach, 1e-9) : 1.0);
  }
  for (Limit row : model.joints.sums) {
    const JointVector c = row.c;
    row.c.resize(static_cast<Eigen::Index>(space.dof()));
    for (int j = 0, kept = 0; j < model.dof; ++j) {
      if (reduction == nullptr || !reduction->leaves_out(j)) {
        row.c[kept++] = c[j];
      } else if (c[j] != 0) {
        // What is left out adds anything between its limits.
        const double a = c[j] * model.joints.lower[j];
        const double b = c[j] * model.joints.upper[j];
        row.lower -= std::max(a, b);
        row.upper -= std::min(a, b);
      }
    }
    space.sums.push_back(row);
  }
  return space;
}

std::size_t sample_count(const SampleSpace& space, const DatabaseOptions& options) {
  if (options.sampling == Sampling::grid || options.samples == 0) {
    return static_cast<std::size_t>(
        product(grid_counts(static_cast<int>(space.dof()), options.scale)));
  }
  return options.samples;
}

std::size_t update_count(const DatabaseOptions& options) {
  if (options.sampling == Sampling::cvt) return options.cvt_updates;
  if (options.sampling != Sampling::kmeans) return 0;
  return options.kmeans_pool * static_cast<std::size_t>(options.kmeans_rounds);
}

std::vector<double> make_samples(const SampleSpace& space, const DatabaseOptions& options,
                                 const std::function<void(std::size_t)>& on_progress) {
  std::vector<double> samples(sample_count(space, options) * space.dof());
  switch (options.sampling) {
    case Sampling::grid:
      fill_grid(space, options, samples);
      break;
    case Sampling::low_discrepancy:
      fill_low_discrepancy(space, options.seed, samples);
      break;
    case Sampling::random:
      fill_random(space, options.seed, samples);
      break;
    case Sampling::cvt:
    case Sampling::kmeans:
      fill_random(space, options.seed, samples);
      tessellate(space, options, samples, on_progress);
      break;
  }
  return samples;
}

}  // namespace iksel
