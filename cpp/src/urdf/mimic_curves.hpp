// SPDX-License-Identifier: BSD-3-Clause
// The curves by which joints of a URDF follow others, checked.
#pragma once

#include <urdf_model/model.h>

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "base/motion_curve.hpp"
#include "iksel/mimic_curve.hpp"

namespace iksel {

/// What a joint follows, and how.
struct CheckedCurve {
  const urdf::Joint* source;
  std::shared_ptr<const MotionCurve> curve;
};
using CheckedCurves = std::map<std::string, CheckedCurve>;

/// By the name of the joint that follows. Throws InvalidArgumentError or UnknownNameError that
/// names the curve.
CheckedCurves check_mimic_curves(const urdf::ModelInterface& model,
                                 const std::vector<MimicCurve>& curves);

/// Narrows `lower` and `upper`, values of the joint that is followed, to where the curve stays
/// between `least` and `most`, up to rounding. False if that is more than one piece, or none.
bool narrow_to_values(const MotionCurve& curve, double least, double most, double& lower,
                      double& upper);

}  // namespace iksel
