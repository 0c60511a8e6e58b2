// SPDX-License-Identifier: BSD-3-Clause
// All of the library.
#pragma once

#include "iksel/coupled_limit.hpp"  // IWYU pragma: export
#include "iksel/database.hpp"       // IWYU pragma: export
#include "iksel/dh.hpp"             // IWYU pragma: export
#include "iksel/diagnosis.hpp"      // IWYU pragma: export
#include "iksel/error.hpp"          // IWYU pragma: export
#include "iksel/evaluation.hpp"     // IWYU pragma: export
#include "iksel/link_tree.hpp"      // IWYU pragma: export
#include "iksel/mimic_curve.hpp"    // IWYU pragma: export
#include "iksel/objective.hpp"      // IWYU pragma: export
#include "iksel/options.hpp"        // IWYU pragma: export
#include "iksel/path.hpp"           // IWYU pragma: export
#include "iksel/pose.hpp"           // IWYU pragma: export
#include "iksel/request.hpp"        // IWYU pragma: export
#include "iksel/result.hpp"         // IWYU pragma: export
#include "iksel/robot.hpp"          // IWYU pragma: export
#include "iksel/robot_options.hpp"  // IWYU pragma: export
#include "iksel/robot_spheres.hpp"  // IWYU pragma: export
#include "iksel/scene.hpp"          // IWYU pragma: export
#include "iksel/selector.hpp"       // IWYU pragma: export
#include "iksel/self_motion.hpp"    // IWYU pragma: export
#include "iksel/simd.hpp"           // IWYU pragma: export
#include "iksel/solver.hpp"         // IWYU pragma: export
#include "iksel/structure.hpp"      // IWYU pragma: export
#include "iksel/task.hpp"           // IWYU pragma: export
#include "iksel/tracker.hpp"        // IWYU pragma: export
#include "iksel/types.hpp"          // IWYU pragma: export
#include "iksel/urdf_text.hpp"      // IWYU pragma: export
#include "iksel/version.hpp"        // IWYU pragma: export
