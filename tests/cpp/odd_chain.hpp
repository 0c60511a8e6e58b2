// SPDX-License-Identifier: BSD-3-Clause
// Random chains, ordinary and odd, as URDF text and as the numbers in it; their forward kinematics
// from those numbers alone, in more digits than the library has.
#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <iksel/iksel.hpp>
#include <limits>
#include <string>
#include <vector>

namespace iksel_test {

using Real = long double;
using RealPose = Eigen::Transform<Real, 3, Eigen::Isometry>;

struct OddJoint {
  iksel::JointType type = iksel::JointType::revolute;
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  Eigen::Vector3d rpy = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  double velocity = 1;
  bool locked = false;
  double locked_at = 0;
  /// Index of the joint that is followed; -1: none.
  int mimics = -1;
  double multiplier = 1;
  double offset = 0;
  /// Index among the degrees of freedom; -1: none of its own.
  int variable = -1;
};

/// A serial chain of links l0, l1, ...; joint i is named j<i> and lies between l<i> and l<i+1>.
struct OddChain {
  std::vector<OddJoint> joints;
  /// The degrees of freedom, base to tip, and the limits that samples are taken from: those of the
  /// joint and what joints that follow it leave.
  std::vector<int> variables;
  std::vector<double> lower;
  std::vector<double> upper;
  /// The last link is the base, the first the tip.
  bool upside_down = false;
  Eigen::Vector3d tcp_xyz = Eigen::Vector3d::Zero();
  Eigen::Vector3d tcp_rpy = Eigen::Vector3d::Zero();
  /// Length that the chain's links have about [m].
  double scale = 1;
  /// Six or seven joints, turning in usual ranges, with links between them: solvers solve these.
  bool ordinary = false;

  [[nodiscard]] int dof() const { return static_cast<int>(variables.size()); }
};

template <class Scalar>
Eigen::Matrix<Scalar, 3, 3> rotation_of_rpy(const Eigen::Vector3d& rpy) {
  using Axis = Eigen::AngleAxis<Scalar>;
  using V = Eigen::Matrix<Scalar, 3, 1>;
  return (Axis(rpy[2], V::UnitZ()) * Axis(rpy[1], V::UnitY()) * Axis(rpy[0], V::UnitX()))
      .toRotationMatrix();
}

template <class Scalar>
Eigen::Transform<Scalar, 3, Eigen::Isometry> transform_of(const Eigen::Vector3d& xyz,
                                                          const Eigen::Vector3d& rpy) {
  Eigen::Transform<Scalar, 3, Eigen::Isometry> T;
  T.setIdentity();
  T.linear() = rotation_of_rpy<Scalar>(rpy);
  T.translation() = xyz.template cast<Scalar>();
  return T;
}

/// The value of joint i when the degrees of freedom are at q.
inline Real value_of(const OddChain& chain, std::size_t i, const iksel::JointVector& q) {
  const OddJoint& joint = chain.joints[i];
  if (joint.locked) return joint.locked_at;
  if (joint.mimics < 0) return q[joint.variable];
  return Real(joint.multiplier) * value_of(chain, static_cast<std::size_t>(joint.mimics), q) +
         Real(joint.offset);
}

/// T_base_tip of the TCP.
inline RealPose forward(const OddChain& chain, const iksel::JointVector& q) {
  RealPose T;
  T.setIdentity();
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    const OddJoint& joint = chain.joints[i];
    T = T * transform_of<Real>(joint.xyz, joint.rpy);
    const Eigen::Matrix<Real, 3, 1> axis = joint.axis.cast<Real>().normalized();
    const Real value = value_of(chain, i, q);
    if (joint.type == iksel::JointType::prismatic) {
      T.translate(value * axis);
    } else {
      T.rotate(Eigen::AngleAxis<Real>(value, axis));
    }
  }
  if (chain.upside_down) T = T.inverse();
  return T * transform_of<Real>(chain.tcp_xyz, chain.tcp_rpy);
}

inline std::string numbers(const Eigen::Vector3d& v) {
  char text[100];
  std::snprintf(text, sizeof text, "%.17g %.17g %.17g", v[0], v[1], v[2]);
  return text;
}

inline std::string urdf_of(const OddChain& chain) {
  std::string xml = "<robot name=\"odd\"><link name=\"l0\"/>";
  char text[300];
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    const OddJoint& joint = chain.joints[i];
    const bool continuous = joint.type == iksel::JointType::continuous;
    const char* type = continuous                                  ? "continuous"
                       : joint.type == iksel::JointType::prismatic ? "prismatic"
                                                                   : "revolute";
    std::snprintf(text, sizeof text,
                  "<link name=\"l%zu\"/>\n<joint name=\"j%zu\" type=\"%s\">"
                  "<parent link=\"l%zu\"/><child link=\"l%zu\"/>",
                  i + 1, i, type, i, i + 1);
    xml += text;
    xml += "<origin xyz=\"" + numbers(joint.xyz) + "\" rpy=\"" + numbers(joint.rpy) + "\"/>";
    xml += "<axis xyz=\"" + numbers(joint.axis) + "\"/>";
    const auto limit = [&](double lower, double upper) {
      std::snprintf(text, sizeof text,
                    "<limit lower=\"%.17g\" upper=\"%.17g\" velocity=\"%.17g\" effort=\"1\"/>",
                    lower, upper, joint.velocity);
      xml += text;
    };
    if (continuous) {
      limit(0, 0);
    } else {
      limit(joint.lower, joint.upper);
    }
    if (joint.mimics >= 0) {
      std::snprintf(text, sizeof text,
                    "<mimic joint=\"j%d\" multiplier=\"%.17g\" offset=\"%.17g\"/>", joint.mimics,
                    joint.multiplier, joint.offset);
      xml += text;
    }
    xml += "</joint>";
  }
  return xml + "</robot>\n";
}

inline iksel::RobotOptions robot_options(const OddChain& chain) {
  iksel::RobotOptions options;
  const std::string last = "l" + std::to_string(chain.joints.size());
  options.base_link = chain.upside_down ? last : "l0";
  options.tip_link = chain.upside_down ? "l0" : last;
  options.tcp = iksel::StoredPose(transform_of<double>(chain.tcp_xyz, chain.tcp_rpy));
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    if (chain.joints[i].locked) {
      options.locked_joints["j" + std::to_string(i)] = chain.joints[i].locked_at;
    }
  }
  return options;
}

}  // namespace iksel_test
