// SPDX-License-Identifier: BSD-3-Clause
// The body of a robot as spheres on its links.
#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "iksel/export.hpp"
#include "iksel/types.hpp"

namespace iksel {

struct Sphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< [m]
  double radius = 0;                                 ///< [m]
};

/// Spheres that cover the links of a robot, and which links may not touch each other. Spheres that
/// cover a link may refuse a configuration that is free, but never pass a contact.
struct IKSEL_EXPORT RobotSpheres {
  /// By name of the link, in its frame. Links that are not here touch nothing.
  std::map<std::string, std::vector<Sphere>> links;
  /// Pairs of links that are looked at for collisions with each other.
  std::vector<std::pair<std::string, std::string>> pairs;

  /// Throws InvalidArgumentError about a sphere that is not finite, beyond kMaxCoordinate or whose
  /// radius is not above 0, and a pair of one link or of a link without spheres.
  void validate() const;
};

}  // namespace iksel
