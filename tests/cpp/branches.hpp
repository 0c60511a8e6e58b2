// SPDX-License-Identifier: BSD-3-Clause
// Branches of solutions by brute force, and how far joint values lie apart.
#pragma once

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>
#include <vector>

#include "robots.hpp"

namespace iksel_test {

inline bool turns(const iksel::Robot& robot, int j) {
  return robot.joint_types()[static_cast<std::size_t>(j)] != iksel::JointType::prismatic &&
         robot.upper()[j] - robot.lower()[j] >= kTwoPi;
}

/// The largest difference of a joint, whole turns counting nothing.
inline double distance(const iksel::Robot& robot, const iksel::JointVector& a,
                       const iksel::JointVector& b) {
  double largest = 0;
  for (int j = 0; j < robot.dof(); ++j) {
    const double d = a[j] - b[j];
    largest = std::max(largest, std::abs(turns(robot, j) ? std::remainder(d, kTwoPi) : d));
  }
  return largest;
}

/// The length of the shortest move from near to q or a copy of it inside the limits.
inline double shortest_move(const iksel::Robot& robot, const iksel::JointVector& q,
                            const iksel::JointVector& near, iksel::MoveNorm norm) {
  iksel::JointVector move = q - near;
  for (int j = 0; j < robot.dof(); ++j) {
    if (!turns(robot, j)) continue;
    for (int k = -3; k <= 3; ++k) {
      const double copy = q[j] + k * kTwoPi;
      if (copy < robot.lower()[j] || copy > robot.upper()[j]) continue;
      if (std::abs(copy - near[j]) < std::abs(move[j])) move[j] = copy - near[j];
    }
  }
  return norm == iksel::MoveNorm::two ? move.norm() : move.cwiseAbs().maxCoeff();
}

/// Every solution that is found from each of n random seeds alone.
inline std::vector<iksel::JointVector> brute_force(const iksel::Solver& solver,
                                                   const iksel::Pose& target, int n) {
  std::vector<iksel::JointVector> found;
  const Eigen::MatrixXd seeds =
      solver.robot().random_configurations(static_cast<std::size_t>(n), iksel_test::seed() + 99);
  for (int i = 0; i < n; ++i) {
    iksel::SolveRequest request;
    request.seeds = {seeds.row(i).transpose()};
    request.database_seeds = false;
    const iksel::Result result = solver.solve(target, request);
    if (!result.success()) continue;
    const bool known = std::any_of(found.begin(), found.end(), [&](const iksel::JointVector& q) {
      return distance(solver.robot(), q, result.q) < 0.02;
    });
    if (!known) found.push_back(result.q);
  }
  return found;
}

inline iksel::JointVector noisy(const iksel::JointVector& q, iksel::Matrix noise, Eigen::Index i,
                                double scale) {
  return q + scale * iksel::JointVector(noise.row(i).transpose());
}

}  // namespace iksel_test
