// SPDX-License-Identifier: BSD-3-Clause
// The candidates of one waypoint of a path.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "iksel/types.hpp"

namespace iksel {

/// Candidates nearer than this in every joint are one [rad or m].
inline constexpr double kSameCandidate = 1e-4;

/// Candidates of one waypoint, with the cheapest way to each.
struct Layer {
  std::size_t dof;
  std::vector<double> q;
  std::vector<double> cost;
  std::vector<std::size_t> parent;

  [[nodiscard]] std::size_t size() const { return q.size() / dof; }
  [[nodiscard]] JointVector at(std::size_t i) const {
    return Eigen::Map<const Eigen::VectorXd>(&q[i * dof], static_cast<Eigen::Index>(dof));
  }
  /// Adds a candidate unless it is there; periodic images are candidates of their own.
  void add(const JointVector& candidate) {
    for (const double* known = q.data(); known != q.data() + q.size(); known += dof) {
      std::size_t j = 0;
      while (j < dof && std::abs(known[j] - candidate.data()[j]) < kSameCandidate) ++j;
      if (j == dof) return;
    }
    q.insert(q.end(), candidate.data(), candidate.data() + dof);
  }
  /// Leaves only the candidates for which keep(index) is true.
  template <typename Keep>
  void keep_if(const Keep& keep) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      if (keep(i)) std::copy_n(&q[i * dof], dof, &q[kept++ * dof]);
    }
    q.resize(kept * dof);
  }
};

}  // namespace iksel
