// SPDX-License-Identifier: BSD-3-Clause
// Arms that are given by Denavit and Hartenberg's parameters.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "iksel/types.hpp"

namespace iksel {

/// How a row of a table places the next frame; the joint moves about or along z.
enum class DhConvention {
  standard,  ///< Rz(theta) Tz(d) Tx(a) Rx(alpha): Denavit and Hartenberg, Siciliano, Spong
  modified,  ///< Rx(alpha) Tx(a) Rz(theta) Tz(d): Craig; a and alpha of the link before
};

/// One row of a table: a joint, with the four numbers that place the next frame.
struct DhJoint {
  double a = 0;      ///< [m]
  double alpha = 0;  ///< [rad]
  double d = 0;      ///< [m]; the value of a prismatic joint is added
  double theta = 0;  ///< [rad]; the value of a joint that turns is added
  /// A revolute joint without limits is continuous; a prismatic one needs them.
  JointType type = JointType::revolute;
  double lower = -std::numeric_limits<double>::infinity();    ///< [rad or m]
  double upper = std::numeric_limits<double>::infinity();     ///< [rad or m]
  double velocity = std::numeric_limits<double>::infinity();  ///< limit [rad/s or m/s]
  std::string name;                                           ///< empty: "joint1", ...
};

/// A table, and where it begins. The robot's links are `base`, in whose frame poses are, and the
/// table's frames `link0` to `linkN`; the tip link is the last of them.
struct DhTable {
  std::vector<DhJoint> joints;  ///< base to tip
  DhConvention convention = DhConvention::standard;
  StoredPose T_base_link0 = StoredPose::Identity();
  std::string robot_name = "dh";
};

}  // namespace iksel
