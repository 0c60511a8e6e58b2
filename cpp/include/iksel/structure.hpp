// SPDX-License-Identifier: BSD-3-Clause
// How the axes of a chain lie, and what that makes of the solutions of a pose.
#pragma once

#include <cstdint>
#include <string>

#include "iksel/export.hpp"
#include "iksel/robot.hpp"

namespace iksel {

/// How the solutions of a pose can be found.
enum class StructureKind : std::uint8_t {
  closed_form,  ///< all of them in closed form: that there is none is proven
  swept,        ///< by equations for each value of one joint, which is swept over its range
  searched,     ///< by search only
};

/// Lower-case name of a kind.
IKSEL_EXPORT const char* to_string(StructureKind kind);

/// What follows from how the axes of a chain lie.
struct Structure {
  StructureKind kind = StructureKind::searched;
  /// Which axes, numbered from 1, are parallel or meet, or that none do that would help; a sentence
  /// without its full stop.
  std::string description;
};

/// That of a robot. Of three to five joints, which reach but some poses, a closed form tells which.
/// For a closed form, axes are taken to be parallel, or to meet, up to 1e-9 rad, or 1e-9 of the
/// robot's reach: what is left of a rounded pi; up to 2e-4 nearly so, and what is found is refined.
/// For a sweep up to 2e-5, a pi of four decimals: a no of it is proven by the ends of the
/// self-motion or by intervals (Proof), where it is. Six joints that turn are swept however their
/// axes lie, but where several solutions share each angle of every joint that could be swept.
[[nodiscard]] IKSEL_EXPORT Structure find_structure(const Robot& robot);

}  // namespace iksel
