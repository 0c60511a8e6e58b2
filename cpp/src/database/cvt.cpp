// SPDX-License-Identifier: BSD-3-Clause
// Centroidal Voronoi tessellation by MacQueen's method (the sampling of the paper's revision), or
// by Lloyd's over a pool of random points, k-means (that of paper(2026)).
//
// MacQueen draws one random point after another and moves the generator nearest to it to the mean
// of all points it has drawn so far. Here the nearest generators are looked up for a round of draws
// at a time, against the generators as they stood before the round, and the moves are then made in
// order: rounds are spread over threads and give the same bits for any number of them. Lloyd's
// rounds draw the same points each, and move each generator to the mean of its own of the round.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "base/parallel.hpp"
#include "base/random.hpp"
#include "database/kd_tree.hpp"
#include "database/sampling.hpp"

namespace iksel {
namespace {

class Tessellation {
 public:
  using Progress = std::function<void(std::size_t)>;

  /// Of rounds of up to `round` points. The samples are scaled until `finish`.
  Tessellation(const SampleSpace& space, const DatabaseOptions& options, std::size_t round,
               std::vector<double>& samples)
      : space_(space),
        options_(options),
        threads_(resolve_threads(options.threads)),
        dof_(space.dof()),
        samples_(samples),
        draws_(round * dof_),
        nearest_(round),
        hits_(samples.size() / dof_, 1) {
    // Distances are taken in radians; slides are scaled so that the arm's reach counts as a radian.
    for (const double unit : space.unit) scale_.push_back(1.0 / unit);
    for (std::size_t i = 0; i < samples.size(); ++i) samples[i] *= scale_[i % dof_];
  }

  /// Draws the points number `first` and following, and looks up the sample nearest to each.
  void draw(std::size_t first, std::size_t size, const Progress& on_progress) {
    size_ = size;
    const auto tree = make_kd_tree(samples_.data(), hits_.size(), static_cast<int>(dof_));
    const auto look_up = [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        Random random = Random::stream(options_.seed + 1, first + i);
        draw_point(random, &draws_[i * dof_]);
        tree->nearest(&draws_[i * dof_], 1, &nearest_[i]);
      }
    };
    parallel_for(
        size, 1024, threads_, [&] { return look_up; }, on_progress);
  }

  /// MacQueen's move.
  void move_one_by_one() {
    for (std::size_t i = 0; i < size_; ++i) {
      const std::uint32_t g = nearest_[i].index;
      const double share = 1.0 / ++hits_[g];
      for (std::size_t j = 0; j < dof_; ++j) {
        double& value = samples_[g * dof_ + j];
        value += share * (draws_[i * dof_ + j] - value);
      }
    }
  }

  /// Lloyd's; a sample that is nearest to none stays.
  void move_to_means() {
    std::fill(hits_.begin(), hits_.end(), 0);
    std::vector<double> sums(samples_.size());
    for (std::size_t i = 0; i < size_; ++i) {
      const std::uint32_t g = nearest_[i].index;
      ++hits_[g];
      for (std::size_t j = 0; j < dof_; ++j) sums[g * dof_ + j] += draws_[i * dof_ + j];
    }
    for (std::size_t i = 0; i < sums.size(); ++i) {
      if (hits_[i / dof_] > 0) samples_[i] = sums[i] / hits_[i / dof_];
    }
  }

  void finish() {
    for (std::size_t i = 0; i < samples_.size(); ++i) samples_[i] /= scale_[i % dof_];
  }

 private:
  /// A random point inside the limits, scaled; they are convex, and so means stay inside.
  void draw_point(Random& random, double* point) const {
    double q[kMaxDof];
    space_.draw_inside(q, [&] {
      for (std::size_t j = 0; j < dof_; ++j) {
        const double lower = space_.lower[j] * scale_[j];
        point[j] = lower + (space_.upper[j] - space_.lower[j]) * scale_[j] * random.uniform();
        q[j] = point[j] / scale_[j];
      }
    });
  }

  const SampleSpace& space_;
  const DatabaseOptions& options_;
  int threads_;
  std::size_t dof_;
  std::vector<double>& samples_;
  std::vector<double> scale_;
  /// The points of a round, and the sample nearest to each.
  std::vector<double> draws_;
  std::vector<Neighbour> nearest_;
  std::size_t size_ = 0;
  /// Of MacQueen's all points so far that a sample was nearest to, itself among them.
  std::vector<std::uint32_t> hits_;
};

}  // namespace

void tessellate(const SampleSpace& space, const DatabaseOptions& options,
                std::vector<double>& samples, const std::function<void(std::size_t)>& on_progress) {
  const bool is_lloyds = options.sampling == Sampling::kmeans;
  const std::size_t count = samples.size() / space.dof();
  const std::size_t updates = update_count(options);
  // Of MacQueen's, a generator should rarely be drawn twice, and the tree not be built too often.
  const std::size_t round =
      is_lloyds ? options.kmeans_pool : std::max<std::size_t>(1, std::min(updates, count / 4 + 1));
  Tessellation tessellation(space, options, round, samples);
  for (std::size_t first = 0; first < updates; first += round) {
    tessellation.draw(is_lloyds ? 0 : first, std::min(round, updates - first),
                      [&](std::size_t done) { on_progress(first + done); });
    if (is_lloyds) {
      tessellation.move_to_means();
    } else {
      tessellation.move_one_by_one();
    }
  }
  tessellation.finish();
}

}  // namespace iksel
