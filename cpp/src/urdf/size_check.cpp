// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <string>

#include "base/constants.hpp"
#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "urdf/chain_spec.hpp"

namespace iksel {
namespace {

[[noreturn]] void refuse(const std::string& joint, const std::string& what, double value,
                         const char* unit) {
  throw UrdfError("joint '" + joint + "': " + what + " is " + too_large_text(value, unit) +
                  " (lengths are metres, angles radians)");
}

/// Written so that NaN is none.
bool is_small(double value) { return std::abs(value) <= kMaxCoordinate; }

/// Largest value that the motion of a joint takes.
double largest_motion(const ChainJoint& joint, const ChainVariable& variable) {
  const bool free = variable.type == JointType::continuous;
  const double low = joint.multiplier * (free ? -kPi : variable.lower) + joint.offset;
  const double high = joint.multiplier * (free ? kPi : variable.upper) + joint.offset;
  return std::max(std::abs(low), std::abs(high));
}

}  // namespace

void check_sizes(const ChainSpec& spec) {
  for (const ChainVariable& variable : spec.variables) {
    if (variable.type == JointType::continuous) continue;
    const char* unit = variable.type == JointType::prismatic ? "m" : "rad";
    for (const double limit : {variable.lower, variable.upper}) {
      if (!is_small(limit)) {
        refuse(variable.name, "a limit (a joint that turns freely is 'continuous')", limit, unit);
      }
    }
  }
  double length = 0;
  for (const ChainJoint& joint : spec.joints) {
    for (const auto* T : {&joint.before, &joint.after}) {
      const double offset = T->translation().stableNorm();
      if (!is_small(offset) || !T->matrix().allFinite())
        refuse(joint.name, "the length of its origin", offset, "m");
      length += offset;
    }
    if (joint.fixed) continue;
    const double motion =
        largest_motion(joint, spec.variables[static_cast<std::size_t>(joint.variable)]);
    if (!is_small(motion)) {
      refuse(joint.name, "its largest value", motion, joint.prismatic ? "m" : "rad");
    }
    if (joint.prismatic) length += motion;
    if (!is_small(length)) refuse(joint.name, "the chain's length up to it", length, "m");
  }
  if (!is_small(length))
    refuse(spec.joints.back().name, "the chain's length up to it", length, "m");
}

}  // namespace iksel
