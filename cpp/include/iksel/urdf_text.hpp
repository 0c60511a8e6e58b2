// SPDX-License-Identifier: BSD-3-Clause
// Text of robot files as every reader takes it.
#pragma once

#include <string>

#include "iksel/export.hpp"

namespace iksel {

/// The text of an XML file (URDF, SRDF, MJCF) as every XML reader takes it, and Robot::urdf() gives
/// it: UTF-8, with what people and exporters get wrong mended where it is clear what is meant.
///
/// Out of UTF-16 and UTF-32 becomes UTF-8. A DOCTYPE, whose entities are not expanded, comments,
/// processing instructions and a default namespace are left out; prefixes that nothing binds are
/// bound; an & that begins no entity stands for itself. `quat_xyzw`, which a URDF may have from
/// version 1.1 on, becomes `rpy`. Of a URDF whose links hang in several trees, the one of `link` is
/// left; all, where no link is given.
///
/// Throws UrdfError, which says the line, where it is not clear what is meant.
IKSEL_EXPORT std::string mend_xml(const std::string& bytes, const std::string& link = "");

}  // namespace iksel
