// SPDX-License-Identifier: BSD-3-Clause
// How the links of a URDF's text hang together, before urdfdom sees it.
#pragma once

#include <string>
#include <vector>

#include "urdf/xml.hpp"

namespace iksel {

/// Leaves the tree with `links` in the URDF and takes the others out.
///
/// Throws UrdfError where a link is the child of two joints, of which urdfdom keeps the last; where
/// joints close a circle, which urdfdom walks for ever and loses as memory; where two links are of
/// different trees; and where there are several trees and none of the links.
void keep_one_tree(XmlElement& robot, const std::vector<std::string>& links);

}  // namespace iksel
