// SPDX-License-Identifier: BSD-3-Clause
// The clearance (scene_types.hpp) between a ball in each lane and another or a shape.
#pragma once

#include "simd/lane_vector.hpp"
#include "simd/scene_types.hpp"

namespace iksel::lanes {

/// Of two balls whose radii together are `reach`.
template <typename T>
IKSEL_INLINE T clearance(const Vec<T>& a, const Vec<T>& b, const T& reach) {
  const Vec<T> d = a - b;
  return dot(d, d) - reach * reach;
}

/// Whether no ball is so near to a shape that it need be looked at closer.
template <typename T>
IKSEL_INLINE bool is_far(const SceneBlock& block, const Vec<T>& c, const T& radius) {
  const Vec<T> d = c - constant<T>(block.centre);
  const T reach = radius + T(block.around);
  return !any(dot(d, d) <= reach * reach);
}

template <typename Shape, typename T>
IKSEL_INLINE bool is_far(const Shape& /*shape*/, const Vec<T>& /*c*/, const T& /*radius*/) {
  return false;
}

template <typename T>
IKSEL_INLINE T clearance(const SceneBlock& block, const Vec<T>& c, const T& radius) {
  const Vec<T> d = c - constant<T>(block.centre);
  T square(0.0);
  for (int i = 0; i < 3; ++i) {
    const T along = dot(d, constant<T>(block.axis[i]));
    const T outside = max(abs(along) - T(block.half[i]), T(0.0));
    square = square + outside * outside;
  }
  const T reach = radius + T(block.radius);
  return square - reach * reach;
}

template <typename T>
IKSEL_INLINE T clearance(const SceneCylinder& cylinder, const Vec<T>& c, const T& radius) {
  const Vec<T> d = c - constant<T>(cylinder.centre);
  const T along = dot(d, constant<T>(cylinder.axis));
  const T across2 = max(dot(d, d) - along * along, T(0.0));
  const T beside = max(sqrt(across2) - T(cylinder.radius), T(0.0));
  const T above = max(abs(along) - T(cylinder.half), T(0.0));
  const T reach = radius + T(cylinder.margin);
  return beside * beside + above * above - reach * reach;
}

template <typename T>
IKSEL_INLINE T clearance(const ScenePlane& plane, const Vec<T>& c, const T& radius) {
  return dot(c, constant<T>(plane.normal)) - (T(plane.offset) + radius);
}

}  // namespace iksel::lanes
