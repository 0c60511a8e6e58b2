// SPDX-License-Identifier: BSD-3-Clause
// What is looked at before urdfdom sees a URDF: what it would crash on, leak or refuse without
// need.
#pragma once

#include <string>

namespace iksel {

/// The text that urdfdom is to parse: what it insists on and chains do not need, the effort and
/// velocity of a limit or the limit itself, is there with zeros. Throws UrdfError where elements
/// are nested too deeply, or links are no tree.
std::string prepare_urdf(const std::string& xml);

/// What urdfdom's parser does not say of text that it cannot read; empty where nothing is known.
std::string explain_broken_xml(const std::string& xml);

/// The first sign that the text is xacro which has to be expanded; empty if there is none.
std::string find_xacro(const std::string& xml);

}  // namespace iksel
