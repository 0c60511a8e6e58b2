// SPDX-License-Identifier: BSD-3-Clause
// Which chains of six joints can be solved in closed form, and their constants.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "simd/branch_types.hpp"
#include "structure/screw_axes.hpp"

namespace iksel {

/// Deviation of axes from being parallel [rad] or meeting [in units of the reach] up to which they
/// are taken to be: beyond what is left of a rounded pi, and far below any tolerance.
inline constexpr double kStructureTolerance = 1e-9;

/// Six consecutive joints of a chain, seen from either end.
struct ClosedFormChain {
  /// `joints[i]` is the chain's joint that the form counts as its i-th.
  int joints[6];
  bool reversed;
  lanes::ClosedForm form;
  double unit;               ///< [m]
  Eigen::Vector3d first;     ///< the point on axis 1 [m]
  Eigen::Vector3d tail;      ///< from the point on axis 6 to the end, in the basis [m]
  Eigen::Matrix3d to_basis;  ///< R_06 E = R * to_basis
  std::string description;

  /// Rows of a BranchPack for Y (reduction.hpp), or its inverse if reversed.
  void write_target(const Pose& Y, double (&rows)[12]) const;
};

/// What makes the chain solvable, if anything does.
std::optional<ClosedFormChain> find_closed_form(const ChainModel& model);

}  // namespace iksel
