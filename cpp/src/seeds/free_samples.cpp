// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/free_samples.hpp"

#include <utility>

namespace iksel {

bool find_nearest_free(const SelfMotionArcs& arcs, const Scene& scene, const JointSpace& joints,
                       const JointVector& near, const JointMove& move, std::size_t most,
                       std::vector<double>& q) {
  constexpr std::size_t kPack = SweptBranches::kCount;
  constexpr std::size_t kDof = SweptBranches::kDof;
  // Nearest first, so that the scene looks at few.
  std::vector<std::pair<double, JointVector>> points;
  for (const SelfMotionArcs::Arc& arc : arcs.arcs()) {
    for (const SelfMotionArcs::Joints& on_arc : arc.q) {
      JointVector point = Eigen::Map<const Eigen::VectorXd>(on_arc.data(), kDof);
      joints.wrap_nearest(near, 0, point);
      points.emplace_back(move.length(point - near), std::move(point));
    }
  }
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return a.first < b.first; });
  q.clear();
  for (std::size_t i = 0; i < points.size() && q.size() < most * kDof; i += kPack) {
    const std::size_t count = std::min(kPack, points.size() - i);
    std::array<double, kPack * kDof> rows{};
    for (std::size_t k = 0; k < count; ++k) {
      std::copy_n(points[i + k].second.data(), kDof, &rows[k * kDof]);
    }
    std::array<bool, kPack> free{};
    scene.find_free(rows.data(), count, free.data());
    for (std::size_t k = 0; k < count; ++k) {
      if (!free[k]) continue;
      const double* row = &rows[k * kDof];
      q.insert(q.end(), row, row + kDof);
    }
  }
  return !points.empty();
}

}  // namespace iksel
