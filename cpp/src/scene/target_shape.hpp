// SPDX-License-Identifier: BSD-3-Clause
// What of an arm is at the same place in all solutions of a target: the tip with all that is fixed
// to it, and what turns on the spot. If that touches something, no solution is free.
#pragma once

#include <array>
#include <vector>

#include "iksel/types.hpp"
#include "scene/arm_shape.hpp"
#include "simd/scene_types.hpp"

namespace iksel {

/// Balls on two bodies, the base and the tip, that lie inside those of an arm at any joint values:
/// a ball at a distance from a joint's axis holds one on the axis, which is smaller by that.
class TargetShape {
 public:
  explicit TargetShape(const ArmShape& arm);

  /// Sets what of a view belongs to it, with the tip where a target puts it. Balls are smaller by
  /// what the tip may be off the target by [m, rad]. False if that is more than they are large.
  /// It holds as long as this and `bodies` are not changed.
  using Bodies = std::array<lanes::SceneBody, 2>;
  bool show(const Pose& T_base_tip, double position, double rotation, Bodies& bodies,
            lanes::SceneView& view) const;

 private:
  /// Balls of a link, seen from one of the bodies.
  struct Part {
    int body;
    std::vector<Sphere> spheres;
  };
  [[nodiscard]] Part seen_from_base(const ArmShape& arm, std::size_t link) const;
  [[nodiscard]] Part seen_from_tip(const ArmShape& arm, std::size_t link) const;
  /// Index of the new link; -1 if it has no balls.
  int add(Part part);

  StoredPose T_tip_body_;
  std::vector<int> to_tip_;  ///< bodies between the base and the tip, the latter first
  double reach_ = 0;         ///< of the tip's balls from its origin [m]
  double smallest_;          ///< radius of the balls [m]
  LinkTable table_;
};

}  // namespace iksel
