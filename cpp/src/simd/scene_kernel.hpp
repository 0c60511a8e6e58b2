// SPDX-License-Identifier: BSD-3-Clause
// Which configurations of an arm of spheres are free, one in each lane.
//
// What tells is the clearance (scene_types.hpp). What is below a node of a link's tree is looked at
// where the ball around it touches in some lane, and nothing any more once each lane collides.
#pragma once

#include "simd/lane_math.hpp"
#include "simd/scene_shapes.hpp"
#include "simd/scene_types.hpp"

namespace iksel::lanes {

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

/// The frame of body i, of which the parent's is there.
template <typename T>
IKSEL_INLINE BodyFrame<T> place_body(const SceneBody& body, const BodyFrame<T>& parent,
                                     const double* q) {
  BodyFrame<T> f;
  const double* values = q + body.variable * kWidth;
  double on_curve[kWidth];
  if (body.curve != nullptr) {
    for (int i = 0; i < kWidth; ++i) on_curve[i] = body.curve->at(values[i]).value;
    values = on_curve;
  }
  const T value = Lanes<T>::load(values);
  const T motion = value * T(body.multiplier) + T(body.offset);
  const Placed<T> x = in_base(parent, body.x);
  const Placed<T> y = in_base(parent, body.y);
  f.z = in_base(parent, body.z);
  f.p = parent.p + in_base(parent, body.p);
  if (body.prismatic) {
    f.x = x;
    f.y = y;
    f.p = f.p + Placed<T>{f.z.x * motion, f.z.y * motion, f.z.z * motion};
    return f;
  }
  T s;
  T c;
  sincos(motion, s, c);
  f.x = {x.x * c + y.x * s, x.y * c + y.y * s, x.z * c + y.z * s};
  f.y = {y.x * c - x.x * s, y.y * c - x.y * s, y.z * c - x.z * s};
  return f;
}

template <typename T>
IKSEL_INLINE Placed<T> load_placed(const double* in) {
  return {Lanes<T>::load(in), Lanes<T>::load(in + kWidth), Lanes<T>::load(in + 2 * kWidth)};
}
template <typename T>
IKSEL_INLINE void store_placed(const Placed<T>& v, double* out) {
  Lanes<T>::store(v.x, out);
  Lanes<T>::store(v.y, out + kWidth);
  Lanes<T>::store(v.z, out + 2 * kWidth);
}

/// The lanes of one pack, and what touches in them. Nothing is placed before it is looked at.
template <typename T>
class PackOfScenes {
 public:
  using Kind = SceneCulprit::Kind;

  /// Of the lanes from `first` on.
  PackOfScenes(const SceneView& scene, const SceneRoom& room, const double* q, int first)
      : scene_(scene),
        q_(q + first),
        frame_(room.frame + first),
        centre_(room.centre + first),
        placed_(room.placed) {
    for (int i = 0; i < scene.nodes; ++i) placed_[i] = 0;
    store({{T(1.0), T(0.0), T(0.0)},
           {T(0.0), T(1.0), T(0.0)},
           {T(0.0), T(0.0), T(1.0)},
           {T(0.0), T(0.0), T(0.0)}},
          0);
  }

  /// Returns the least clearance. Begins with the culprit, which is that of this pack afterwards if
  /// all its lanes collide.
  T find(SceneCulprit& culprit) {
    ask_again(culprit);
    culprit.is_sole = !is_open();
    for (int i = 0; i < scene_.pairs && is_open(); ++i) {
      test_pair(i);
      if (!is_open()) culprit = {Kind::pair, i, 0, false};
    }
    for (int i = 0; i < scene_.links && is_open(); ++i) {
      const int body = scene_.link[i].body;
      if (body != 0 && body != scene_.cleared) test_obstacles(i, culprit);
    }
    if (is_open()) place_bodies(scene_.bodies - 1);
    return least_;
  }

 private:
  /// Whether a lane may still be free.
  [[nodiscard]] bool is_open() const { return any(least_ > T(0.0)); }

  void ask_again(const SceneCulprit& culprit) {
    switch (culprit.kind) {
      case Kind::none:
        return;
      case Kind::pair:
        return test_pair(culprit.index);
      case Kind::block:
        return test(culprit.link, scene_.block[culprit.index]);
      case Kind::cylinder:
        return test(culprit.link, scene_.cylinder[culprit.index]);
      case Kind::plane:
        return test(culprit.link, scene_.plane[culprit.index]);
    }
  }

  void store(const BodyFrame<T>& f, int body) {
    double* out = frame_ + 12 * body * kWidth;
    store_placed(f.x, out);
    store_placed(f.y, out + 3 * kWidth);
    store_placed(f.z, out + 6 * kWidth);
    store_placed(f.p, out + 9 * kWidth);
  }
  [[nodiscard]] IKSEL_INLINE BodyFrame<T> frame(int body) const {
    const double* in = frame_ + 12 * body * kWidth;
    return {load_placed<T>(in), load_placed<T>(in + 3 * kWidth), load_placed<T>(in + 6 * kWidth),
            load_placed<T>(in + 9 * kWidth)};
  }
  /// All up to this one; parents come before what they carry.
  void place_bodies(int last) {
    for (; bodies_ <= last; ++bodies_) {
      const SceneBody& body = scene_.body[bodies_];
      store(place_body(body, frame(body.parent), q_), bodies_);
    }
  }
  void place_balls(int body, int first, int last) {
    const BodyFrame<T> f = frame(body);
    for (int b = first; b < last; ++b) {
      store_placed(f.p + in_base(f, scene_.ball[b].centre), centre_ + 3 * b * kWidth);
    }
  }
  /// A ball of a body; of one that moves it has to be placed.
  IKSEL_INLINE Placed<T> at(int body, int ball) const {
    if (body == 0) {
      const double(&c)[3] = scene_.ball[ball].centre;
      return {T(c[0]), T(c[1]), T(c[2])};
    }
    return load_placed<T>(centre_ + 3 * ball * kWidth);
  }
  /// The ball around a node.
  IKSEL_INLINE Placed<T> around(int body, int node) {
    const int ball = scene_.node[node].ball;
    if (body != 0 && placed_[node] == 0) {
      place_bodies(body);
      place_balls(body, ball, ball + 1);
      placed_[node] = 1;
    }
    return at(body, ball);
  }
  IKSEL_INLINE double radius_around(int node) const { return radius(scene_.node[node].ball); }
  /// The balls of a leaf, of which the one around is placed.
  void place_leaf(int body, int node) {
    if (body == 0 || placed_[node] == 2) return;
    const SceneNode& leaf = scene_.node[node];
    place_balls(body, leaf.first, leaf.first + leaf.count);
    placed_[node] = 2;
  }

  IKSEL_INLINE double radius(int ball) const { return scene_.ball[ball].radius; }

  void test_pair(int pair) {
    const SceneLink& a = scene_.link[scene_.pair[pair].a];
    const SceneLink& b = scene_.link[scene_.pair[pair].b];
    test_nodes(a.body, a.root, b.body, b.root);
  }
  void test_nodes(int body_a, int a, int body_b, int b) {
    const double ra = radius_around(a);
    const double rb = radius_around(b);
    // Of both balls of a pair.
    const double less = 2 * scene_.smaller;
    if (!any(clearance(around(body_a, a), around(body_b, b), ra + rb - less) <= T(0.0))) return;
    const SceneNode& of_a = scene_.node[a];
    const SceneNode& of_b = scene_.node[b];
    if (of_a.is_leaf && of_b.is_leaf) return test_leaves(body_a, a, body_b, b, less);
    // What is larger holds more that is far away.
    if (of_b.is_leaf || (!of_a.is_leaf && ra > rb)) {
      for (int i = of_a.first; i < of_a.first + of_a.count && is_open(); ++i) {
        test_nodes(body_a, i, body_b, b);
      }
    } else {
      for (int i = of_b.first; i < of_b.first + of_b.count && is_open(); ++i) {
        test_nodes(body_a, a, body_b, i);
      }
    }
  }
  void test_leaves(int body_a, int a, int body_b, int b, double less) {
    place_leaf(body_a, a);
    place_leaf(body_b, b);
    const SceneNode& of_a = scene_.node[a];
    const SceneNode& of_b = scene_.node[b];
    const Placed<T> around_b = at(body_b, of_b.ball);
    for (int k = of_a.first; k < of_a.first + of_a.count; ++k) {
      const Placed<T> c = at(body_a, k);
      const double r = radius(k) - less;
      if (!any(clearance(c, around_b, r + radius(of_b.ball)) <= T(0.0))) continue;
      for (int m = of_b.first; m < of_b.first + of_b.count; ++m) {
        least_ = min(least_, clearance(c, at(body_b, m), r + radius(m)));
      }
    }
  }

  template <typename Shape>
  void test(int body, int node, const Shape& shape) {
    if (is_clear(shape, around(body, node), radius_around(node) - scene_.smaller)) return;
    const SceneNode& of = scene_.node[node];
    if (!of.is_leaf) {
      for (int i = of.first; i < of.first + of.count && is_open(); ++i) test(body, i, shape);
      return;
    }
    place_leaf(body, node);
    for (int b = of.first; b < of.first + of.count; ++b) {
      least_ = min(least_, clearance(shape, at(body, b), radius(b) - scene_.smaller));
    }
  }
  /// A link that may touch a shape.
  template <typename Shape>
  IKSEL_INLINE void test(int link, const Shape& shape) {
    test(scene_.link[link].body, scene_.link[link].root, shape);
  }
  template <typename Shape>
  IKSEL_INLINE void test_all(int link, const Shape* shape, int count, Kind kind,
                             SceneCulprit& culprit) {
    for (int i = 0; i < count && is_open(); ++i) {
      test(link, shape[i]);
      if (!is_open()) culprit = {kind, i, link, false};
    }
  }
  void test_obstacles(int link, SceneCulprit& culprit) {
    test_all(link, scene_.block, scene_.blocks, Kind::block, culprit);
    test_all(link, scene_.cylinder, scene_.cylinders, Kind::cylinder, culprit);
    test_all(link, scene_.plane, scene_.planes, Kind::plane, culprit);
  }

  const SceneView& scene_;
  const double* q_;
  double* frame_;
  double* centre_;
  unsigned char* placed_;
  int bodies_ = 1;  ///< so many are placed
  T least_ = T(1.0);
};

template <typename T>
void find_clearance(const SceneView& scene, const double* q, int wanted, SceneRoom& room,
                    double* clearance) {
  bool is_sole = true;
  for (int first = 0; first < wanted; first += Lanes<T>::kCount) {
    const T least = PackOfScenes<T>(scene, room, q, first).find(room.culprit);
    Lanes<T>::store(least, clearance + first);
    is_sole = is_sole && room.culprit.is_sole;
  }
  room.culprit.is_sole = is_sole;
}

}  // namespace iksel::lanes
