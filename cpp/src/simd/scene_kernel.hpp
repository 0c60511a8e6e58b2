// SPDX-License-Identifier: BSD-3-Clause
// Which configurations of an arm of spheres are free, one in each lane.
//
// What tells is the clearance (scene_types.hpp). A link's spheres are looked at where the one
// around them all touches in some lane.
#pragma once

#include "simd/lane_math.hpp"
#include "simd/scene_types.hpp"

namespace iksel::lanes {

template <typename T>
struct Placed {
  T x, y, z;
};

template <typename T>
struct BodyFrame {
  Placed<T> x, y, z, p;
};

template <typename T>
IKSEL_INLINE Placed<T> in_base(const BodyFrame<T>& f, const double (&v)[3]) {
  const T a(v[0]);
  const T b(v[1]);
  const T c(v[2]);
  return {f.x.x * a + f.y.x * b + f.z.x * c, f.x.y * a + f.y.y * b + f.z.y * c,
          f.x.z * a + f.y.z * b + f.z.z * c};
}
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

/// Frames of all bodies in the base frame.
template <typename T>
IKSEL_INLINE void place_bodies(const SceneView& scene, const double* q, BodyFrame<T>* frame) {
  frame[0] = {{T(1.0), T(0.0), T(0.0)},
              {T(0.0), T(1.0), T(0.0)},
              {T(0.0), T(0.0), T(1.0)},
              {T(0.0), T(0.0), T(0.0)}};
  for (int i = 1; i < scene.bodies; ++i) {
    const SceneBody& body = scene.body[i];
    const BodyFrame<T>& parent = frame[body.parent];
    BodyFrame<T>& f = frame[i];
    const T value = Lanes<T>::load(q + body.variable * kWidth);
    const T motion = value * T(body.multiplier) + T(body.offset);
    const Placed<T> x = in_base(parent, body.x);
    const Placed<T> y = in_base(parent, body.y);
    f.z = in_base(parent, body.z);
    f.p = parent.p + in_base(parent, body.p);
    if (body.prismatic) {
      f.x = x;
      f.y = y;
      f.p = f.p + Placed<T>{f.z.x * motion, f.z.y * motion, f.z.z * motion};
      continue;
    }
    T s;
    T c;
    sincos(motion, s, c);
    f.x = {x.x * c + y.x * s, x.y * c + y.y * s, x.z * c + y.z * s};
    f.y = {y.x * c - x.x * s, y.y * c - x.y * s, y.z * c - x.z * s};
  }
}

/// The lanes of one pack, and what touches in them.
template <typename T>
class PackOfScenes {
 public:
  PackOfScenes(const SceneView& scene, double* centre) : scene_(scene), centre_(centre) {}

  /// Returns the least clearance.
  T find(const double* q) {
    place(q);
    test_pairs();
    for (int i = 0; i < scene_.links && any(least_ > T(0.0)); ++i) {
      if (scene_.link[i].body != 0) test_obstacles(scene_.link[i]);
    }
    return least_;
  }

 private:
  void place(const double* q) {
    BodyFrame<T> frame[kMaxBodies];
    place_bodies(scene_, q, frame);
    for (int i = 0; i < scene_.links; ++i) {
      const SceneLink& link = scene_.link[i];
      for (int b = link.first - 1; b < link.first + link.count; ++b) {
        const BodyFrame<T>& f = frame[link.body];
        const Placed<T> c = f.p + in_base(f, scene_.ball[b].centre);
        double* out = centre_ + 3 * b * kWidth;
        Lanes<T>::store(c.x, out);
        Lanes<T>::store(c.y, out + kWidth);
        Lanes<T>::store(c.z, out + 2 * kWidth);
      }
    }
  }

  IKSEL_INLINE Placed<T> at(int ball) const {
    const double* in = centre_ + 3 * ball * kWidth;
    return {Lanes<T>::load(in), Lanes<T>::load(in + kWidth), Lanes<T>::load(in + 2 * kWidth)};
  }

  IKSEL_INLINE T clearance(int a, int b) const {
    const double reach = scene_.ball[a].radius + scene_.ball[b].radius;
    return square_between(at(a), at(b)) - T(reach * reach);
  }

  void test_pairs() {
    for (int i = 0; i < scene_.pairs && any(least_ > T(0.0)); ++i) {
      const SceneLink& a = scene_.link[scene_.pair[i].a];
      const SceneLink& b = scene_.link[scene_.pair[i].b];
      if (!any(clearance(a.first - 1, b.first - 1) <= T(0.0))) continue;
      for (int k = a.first; k < a.first + a.count; ++k) {
        if (!any(clearance(k, b.first - 1) <= T(0.0))) continue;
        for (int m = b.first; m < b.first + b.count; ++m) least_ = min(least_, clearance(k, m));
      }
    }
  }

  IKSEL_INLINE static T clearance(const SceneBlock& block, const Placed<T>& c, double radius) {
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
  IKSEL_INLINE static T clearance(const SceneCylinder& cylinder, const Placed<T>& c,
                                  double radius) {
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
  IKSEL_INLINE static T clearance(const ScenePlane& plane, const Placed<T>& c, double radius) {
    const double(&n)[3] = plane.normal;
    return c.x * T(n[0]) + c.y * T(n[1]) + c.z * T(n[2]) - T(plane.offset + radius);
  }

  template <typename Shape>
  void test(const SceneLink& link, const Placed<T>& around, const Shape* shape, int count) {
    for (int i = 0; i < count; ++i) {
      const double radius = scene_.ball[link.first - 1].radius;
      if (!any(clearance(shape[i], around, radius) <= T(0.0))) continue;
      for (int b = link.first; b < link.first + link.count; ++b) {
        least_ = min(least_, clearance(shape[i], at(b), scene_.ball[b].radius));
      }
    }
  }

  void test_obstacles(const SceneLink& link) {
    const Placed<T> around = at(link.first - 1);
    test(link, around, scene_.block, scene_.blocks);
    test(link, around, scene_.cylinder, scene_.cylinders);
    test(link, around, scene_.plane, scene_.planes);
  }

  const SceneView& scene_;
  double* centre_;
  T least_ = T(1.0);
};

template <typename T>
void find_clearance(const SceneView& scene, const double* q, int wanted, double* centre,
                    double* clearance) {
  for (int first = 0; first < wanted; first += Lanes<T>::kCount) {
    const T least = PackOfScenes<T>(scene, centre + first).find(q + first);
    Lanes<T>::store(least, clearance + first);
  }
}

}  // namespace iksel::lanes
