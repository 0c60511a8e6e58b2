// SPDX-License-Identifier: BSD-3-Clause
// Why each answer collides.
#pragma once

#include "iksel/diagnosis.hpp"

namespace iksel {

/// Of answers that all collide the one whose deepest contact is the least deep, which is returned;
/// its contacts, and the message that names them, go into `out`.
JointVector explain_collision(const Scene& scene, const Solutions& refused, Diagnosis& out);

}  // namespace iksel
