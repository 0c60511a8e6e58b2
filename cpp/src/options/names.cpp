// SPDX-License-Identifier: BSD-3-Clause
// Enums in words, in the order of their values.
#include <cstddef>

#include "iksel/diagnosis.hpp"
#include "iksel/result.hpp"
#include "iksel/scene.hpp"
#include "iksel/self_motion.hpp"
#include "iksel/structure.hpp"

namespace iksel {
namespace {

template <typename Enum, std::size_t kCount>
const char* name_of(Enum value, const char* const (&names)[kCount]) {
  const auto index = static_cast<std::size_t>(value);
  return index < kCount ? names[index] : "unknown";
}

}  // namespace

const char* to_string(Proof proof) {
  return name_of(proof, {"none", "reach", "closed_form", "intervals", "sweep", "target", "answer"});
}

const char* to_string(Status status) {
  return name_of(status, {"solved", "not_converged", "outside_limits", "out_of_reach", "rejected",
                          "out_of_time", "too_fast", "invalid_pose", "closest", "in_collision"});
}

const char* to_string(Cause cause) {
  return name_of(cause,
                 {"none", "out_of_reach", "orientation", "joint_limits", "no_branch", "rejected",
                  "singular", "budget", "out_of_time", "collision", "shared_joints"});
}

const char* to_string(StructureKind kind) {
  return name_of(kind, {"closed_form", "swept", "searched"});
}

const char* to_string(ArcEnd end) { return name_of(end, {"limit", "fold", "closed"}); }

const char* to_string(Obstacle::Shape shape) {
  return name_of(shape, {"sphere", "box", "capsule", "cylinder", "half_space", "points"});
}

}  // namespace iksel
