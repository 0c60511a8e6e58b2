// SPDX-License-Identifier: BSD-3-Clause
// What a joint of the URDF is to a chain: where it is, how it moves, which joint really moves one
// that mimics another or follows it by a curve, and the limits of a degree of freedom: its joint's
// own, and those of the joints that mimic it.
#pragma once

#include <urdf_model/joint.h>
#include <urdf_model/model.h>

#include <Eigen/Geometry>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/motion_curve.hpp"
#include "iksel/mimic_curve.hpp"
#include "iksel/robot_options.hpp"
#include "urdf/chain_spec.hpp"

namespace iksel {

/// Throws UnknownNameError, which begins with `problem`, if there is none of that name.
const urdf::Joint& find_joint(const urdf::ModelInterface& model, const std::string& name,
                              const std::string& problem);

/// Whether it turns or slides, and so has a value.
bool has_value(const urdf::Joint& joint);

/// What moves a joint: `source`'s value q, as motion_of says (base/motion_curve.hpp).
struct Motion : Following {
  const urdf::Joint* source = nullptr;
};
/// By the joint that moves so.
using Motions = std::map<const urdf::Joint*, Motion>;

/// Throws InvalidArgumentError or UnknownNameError that names the curve.
Motions check_mimic_curves(const urdf::ModelInterface& model,
                           const std::vector<MimicCurve>& curves);

/// Through any number of mimic tags, and a curve in the place of the last; `known` are the curves
/// and those of calls before, to which it adds. Throws UnknownNameError if one names no joint, and
/// UrdfError if they go in a circle, end at a joint that has no value, or a number is too large.
Motion resolve_mimic(const urdf::ModelInterface& model, const urdf::Joint& joint, Motions& known);

/// All but the parent. Throws as resolve_mimic, and UrdfError if the origin is not finite or the
/// axis has no direction.
LinkJoint read_joint(const urdf::ModelInterface& model, const urdf::Joint& joint, Motions& known);

/// The degree of freedom that a joint is. One that turns and has infinite limits is continuous.
/// Throws UrdfError if it has no limits and the options no default ones.
ChainVariable make_variable(const urdf::Joint& joint, const RobotOptions& options);

/// Narrows the limits of `variable` to those of a joint that follows it, and to the ends of the
/// curve by which it does. Throws UrdfError where a curve leaves nothing, or several pieces.
void narrow_by_follower(const urdf::Joint& follower, const Following& motion,
                        const RobotOptions& options, ChainVariable& variable);

/// Narrows `lower` and `upper`, values of the joint that is followed, to where the curve stays
/// between `least` and `most`, up to rounding. False if that is more than one piece, or none.
bool narrow_to_values(const MotionCurve& curve, double least, double most, double& lower,
                      double& upper);

/// Throws UrdfError unless the limits are finite with lower < upper, or the joint is continuous.
void check_limits(const ChainVariable& variable);

/// Throws InvalidArgumentError unless the default limits, if any, are finite with lower < upper.
void check_default_limits(const RobotOptions& options);

}  // namespace iksel
