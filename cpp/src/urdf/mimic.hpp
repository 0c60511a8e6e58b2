// SPDX-License-Identifier: BSD-3-Clause
// Which joint really moves one that mimics another.
#pragma once

#include <urdf_model/joint.h>
#include <urdf_model/model.h>

namespace iksel {

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
