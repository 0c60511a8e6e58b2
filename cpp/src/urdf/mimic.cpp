// SPDX-License-Identifier: BSD-3-Clause
#include "urdf/mimic.hpp"

#include <cmath>
#include <string>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "iksel/types.hpp"
#include "urdf/parse.hpp"

namespace iksel {

Motion resolve_mimic(const urdf::ModelInterface& model, const urdf::Joint& joint) {
  Motion motion{&joint, 1.0, 0.0};
  for (std::size_t steps = 0; motion.source->mimic; ++steps) {
    const urdf::JointMimic& mimic = *motion.source->mimic;
    const auto it = model.joints_.find(mimic.joint_name);
    if (it == model.joints_.end()) {
      throw_unknown_name("joint '" + motion.source->name + "' mimics '" + mimic.joint_name +
                             "', which is not in the URDF",
                         mimic.joint_name, joint_names_of(model));
    }
    if (steps > model.joints_.size()) {
      throw UrdfError("joint '" + joint.name + "' mimics itself through a circle of joints");
    }
    motion = {it->second.get(), motion.multiplier * mimic.multiplier,
              motion.offset + motion.multiplier * mimic.offset};
  }
  for (const double number : {motion.multiplier, motion.offset}) {
    if (std::abs(number) <= kMaxCoordinate) continue;
    throw UrdfError("joint '" + joint.name + "': its mimic multiplier or offset is " +
                    number_text(number) + "; at most " + number_text(kMaxCoordinate) +
                    " can be computed with");
  }
  const auto type = motion.source->type;
  if (type != urdf::Joint::REVOLUTE && type != urdf::Joint::CONTINUOUS &&
      type != urdf::Joint::PRISMATIC) {
    throw UrdfError("joint '" + joint.name + "' mimics '" + motion.source->name + "', which is " +
                    joint_type_name(type));
  }
  return motion;
}

}  // namespace iksel
