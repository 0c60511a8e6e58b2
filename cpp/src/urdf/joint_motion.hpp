// SPDX-License-Identifier: BSD-3-Clause
// Where a joint of the URDF is, how it moves, and which joint really moves one that mimics another.
#pragma once

#include <urdf_model/joint.h>
#include <urdf_model/model.h>

#include <Eigen/Geometry>

namespace iksel {

/// Pose of the joint in its parent link. Throws UrdfError if it is not finite.
Eigen::Isometry3d origin_of(const urdf::Joint& joint);

/// Unit vector about or along which the joint moves. Throws UrdfError if it has no direction.
Eigen::Vector3d axis_of(const urdf::Joint& joint);

/// What moves a joint: `source`'s value q, as multiplier * q + offset.
struct Motion {
  const urdf::Joint* source;
  double multiplier;
  double offset;
};

/// Through any number of mimic tags. Throws UnknownNameError if one names no joint, and UrdfError
/// if they go in a circle, end at a joint that has no value, or a number is too large.
Motion resolve_mimic(const urdf::ModelInterface& model, const urdf::Joint& joint);

}  // namespace iksel
