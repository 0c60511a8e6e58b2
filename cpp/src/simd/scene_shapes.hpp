// SPDX-License-Identifier: BSD-3-Clause
// The clearance (scene_types.hpp) between a ball, at a place of its own in each lane, and another
// or a shape.
#pragma once

#include "simd/lane_math.hpp"
#include "simd/scene_types.hpp"

namespace iksel::lanes {

template <typename T>
struct Placed {
  T x, y, z;
};

template <typename T>
IKSEL_INLINE Placed<T> operator+(const Placed<T>& a, const Placed<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <typename T>
IKSEL_INLINE T square_between(const Placed<T>& a, const Placed<T>& b) {
  const T x = a.x - b.x;
  const T y = a.y - b.y;
  const T z = a.z - b.z;
  return x * x + y * y + z * z;
}

/// Of two balls whose radii together are `reach`.
template <typename T>
IKSEL_INLINE T clearance(const Placed<T>& a, const Placed<T>& b, double reach) {
  return square_between(a, b) - T(reach * reach);
}

/// Whether a ball is so far from a shape that it need not be looked at closer.
template <typename T>
IKSEL_INLINE bool is_far(const SceneBlock& block, const Placed<T>& c, double radius) {
  const T x = c.x - T(block.centre[0]);
  const T y = c.y - T(block.centre[1]);
  const T z = c.z - T(block.centre[2]);
  const double reach = radius + block.around;
  return !any(x * x + y * y + z * z <= T(reach * reach));
}

template <typename Shape, typename T>
IKSEL_INLINE bool is_far(const Shape& /*shape*/, const Placed<T>& /*c*/, double /*radius*/) {
  return false;
}

template <typename T>
IKSEL_INLINE T clearance(const SceneBlock& block, const Placed<T>& c, double radius) {
  const T x = c.x - T(block.centre[0]);
  const T y = c.y - T(block.centre[1]);
  const T z = c.z - T(block.centre[2]);
  T square(0.0);
  for (int i = 0; i < 3; ++i) {
    const double(&a)[3] = block.axis[i];
    const T along = x * T(a[0]) + y * T(a[1]) + z * T(a[2]);
    const T outside = max(abs(along) - T(block.half[i]), T(0.0));
    square = square + outside * outside;
  }
  const double reach = radius + block.radius;
  return square - T(reach * reach);
}

template <typename T>
IKSEL_INLINE T clearance(const SceneCylinder& cylinder, const Placed<T>& c, double radius) {
  const T x = c.x - T(cylinder.centre[0]);
  const T y = c.y - T(cylinder.centre[1]);
  const T z = c.z - T(cylinder.centre[2]);
  const double(&a)[3] = cylinder.axis;
  const T along = x * T(a[0]) + y * T(a[1]) + z * T(a[2]);
  const T across2 = max(x * x + y * y + z * z - along * along, T(0.0));
  const T beside = max(sqrt(across2) - T(cylinder.radius), T(0.0));
  const T above = max(abs(along) - T(cylinder.half), T(0.0));
  const double reach = radius + cylinder.margin;
  return beside * beside + above * above - T(reach * reach);
}

template <typename T>
IKSEL_INLINE T clearance(const ScenePlane& plane, const Placed<T>& c, double radius) {
  const double(&n)[3] = plane.normal;
  return c.x * T(n[0]) + c.y * T(n[1]) + c.z * T(n[2]) - T(plane.offset + radius);
}

template <typename Shape, typename T>
IKSEL_INLINE bool is_clear(const Shape& shape, const Placed<T>& c, double radius) {
  return is_far(shape, c, radius) || !any(clearance(shape, c, radius) <= T(0.0));
}

}  // namespace iksel::lanes
