// SPDX-License-Identifier: BSD-3-Clause
// The geometry of one joint of a URDF, checked.
#pragma once

#include <urdf_model/joint.h>

#include <Eigen/Geometry>

namespace iksel {

/// Pose of the joint in its parent link. Throws UrdfError if it is not finite.
Eigen::Isometry3d origin_of(const urdf::Joint& joint);

/// Unit vector about or along which the joint moves. Throws UrdfError if it has no direction.
Eigen::Vector3d axis_of(const urdf::Joint& joint);

}  // namespace iksel
