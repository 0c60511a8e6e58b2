// SPDX-License-Identifier: BSD-3-Clause
// The paper's selection of seeds, to be used by hand: query, rank and re-select.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "iksel/database.hpp"
#include "iksel/export.hpp"
#include "iksel/options.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// Samples of a database that may be seeds for a target, the best first. Item i of each belongs to
/// the same sample.
struct Candidates {
  std::vector<std::size_t> indices;  ///< of the samples in the database
  /// |x_target - x_i| of the tree's keys, Eq. (2) [m, rotations times the database's weight].
  std::vector<double> distances;
  std::vector<double> adjustments;  ///< |J_i^+ (x_target - x_i)|, Eq. (5) [rad or m]
  std::vector<JointVector> q;       ///< joint values of the samples [rad or m]
};

/// Selects seeds for one target after the other, as a solver with the strategy Paper does. Not to
/// be used from two threads at once.
class IKSEL_EXPORT Selector {
 public:
  /// Throws InvalidArgumentError if the scheme is out of range or limit-aware, or if the database's
  /// key is reduced: to limits and to the joints that such a key leaves out, a database alone says
  /// nothing.
  explicit Selector(const Database& database, const Paper& scheme = {});
  Selector(const Selector&) = delete;
  Selector& operator=(const Selector&) = delete;
  Selector(Selector&&) noexcept;
  Selector& operator=(Selector&&) noexcept;
  ~Selector();

  /// The `count` samples nearest to T_base_tip (of the tip link, without the TCP), put in order by
  /// `ranking`. Throws InvalidArgumentError if the pose is none or count is 0.
  Candidates candidates(const Pose& T_base_tip, std::size_t count, Ranking ranking);
  /// As many as the scheme asks for, in its order.
  Candidates candidates(const Pose& T_base_tip);
  /// The candidates of the last target in another order. Throws InvalidArgumentError if there was
  /// no target.
  Candidates rank(Ranking ranking);

  /// Index of the sample to be tried after those that failed, given in the order in which they were
  /// tried: the first in the order if there are none, else the one that the scheme's re-selection
  /// takes among its `candidates` best. Nothing if none is left. Throws InvalidArgumentError about
  /// an index that is none of these or comes twice, and if there was no target.
  [[nodiscard]] std::optional<std::size_t> next(const std::vector<std::size_t>& failed);

  /// Where the seeds come from.
  [[nodiscard]] const Database& database() const;
  /// How they are selected.
  [[nodiscard]] const Paper& scheme() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace iksel
