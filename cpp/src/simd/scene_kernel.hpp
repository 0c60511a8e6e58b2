// SPDX-License-Identifier: BSD-3-Clause
// Whether a configuration of an arm of balls is free: one configuration at a time, with the balls
// of a node in lanes.
//
// What tells is the clearance (scene_types.hpp). Of links that may touch, the trees are descended
// together: those of two links in the frame of the second's body, where its balls stand still.
#pragma once

#include "simd/scene_bodies.hpp"
#include "simd/scene_shapes.hpp"

namespace iksel::lanes {

/// One configuration, and what touches in it.
template <typename T>
class SceneCheck {
 public:
  using Kind = SceneCulprit::Kind;

  SceneCheck(const SceneView& scene, const SceneRoom& room, const double* q)
      : scene_(scene), room_(room), bodies_(scene, room), are_placed_(bodies_.place_bodies(q)) {}

  /// Returns the clearance. Begins with the culprit, which is that of this configuration afterwards
  /// if it collides.
  double find(SceneCulprit& culprit) {
    if (!are_placed_) return 0;
    bool touches = touches_again(culprit);
    if (!touches) {
      bodies_.place_links();
      touches = test_pairs(culprit) ||
                test_all(scene_.block, scene_.blocks, Kind::block, culprit) ||
                test_all(scene_.cylinder, scene_.cylinders, Kind::cylinder, culprit) ||
                test_all(scene_.plane, scene_.planes, Kind::plane, culprit);
    }
    if (touches) {
      culprit.leaf = leaf_;
      culprit.ball = ball_;
      culprit.other = other_;
    }
    return clearance_;
  }

 private:
  /// A ball, and the node that it is around.
  struct Around {
    Vec<double> centre;
    double radius;
    int node;
  };

  [[nodiscard]] IKSEL_INLINE Around around(const SceneLink& link) const {
    return {constant<double>(link.around.centre), link.around.radius, link.root};
  }
  /// Keeps the least clearance of the lanes of a mask, which is not empty.
  IKSEL_INLINE bool touch(const T& found, unsigned mask) {
    double of_lane[Lanes<T>::kCount];
    Lanes<T>::store(found, of_lane);
    clearance_ = min(clearance_, of_lane[take_least(of_lane, mask)]);
    return true;
  }
  /// Takes the lane of a mask that has the least clearance: it most likely touches.
  static IKSEL_INLINE int take_least(const double* found, unsigned& mask) {
    int least = -1;
    for (int lane = 0; lane < Lanes<T>::kCount; ++lane) {
      if ((mask >> static_cast<unsigned>(lane) & 1U) == 0) continue;
      if (least < 0 || found[lane] < found[least]) least = lane;
    }
    mask &= ~(1U << static_cast<unsigned>(least));
    return least;
  }
  /// Lanes from `first` on that there are.
  static IKSEL_INLINE unsigned lanes_up_to(int count, int first) {
    return (1U << static_cast<unsigned>(min_of(count - first, Lanes<T>::kCount))) - 1U;
  }
  static IKSEL_INLINE int min_of(int a, int b) { return a < b ? a : b; }

  bool touches_again(const SceneCulprit& culprit) {
    switch (culprit.kind) {
      case Kind::none:
        return false;
      case Kind::pair:
        return touches_again(culprit, scene_.pair[culprit.index]);
      case Kind::block:
        return touches_again(culprit, scene_.block[culprit.index]);
      case Kind::cylinder:
        return touches_again(culprit, scene_.cylinder[culprit.index]);
      case Kind::plane:
        return touches_again(culprit, scene_.plane[culprit.index]);
    }
    return false;
  }
  template <typename Shape>
  bool touches_again(const SceneCulprit& culprit, const Shape& shape) {
    const BodyFrame body = bodies_.frame(scene_.link[culprit.link].body);
    return test_node(body, culprit.leaf, shape) || test_link(culprit.link, shape);
  }
  bool touches_again(const SceneCulprit& culprit, const ScenePair& pair) {
    const BodyFrame from_b = a_from_b(pair);
    const SceneNode& leaf = scene_.node[culprit.leaf];
    const int k = culprit.ball;
    const Vec<double> centre{leaf.x[k], leaf.y[k], leaf.z[k]};
    const Around ball{placed(from_b, centre), leaf.radius[k], 0};
    if (test_leaf(culprit.other, ball)) {
      leaf_ = culprit.leaf;
      ball_ = k;
      return true;
    }
    return test_pair(pair, from_b);
  }

  bool test_pairs(SceneCulprit& culprit) {
    const int count = bodies_.find_near_pairs();
    for (const int* i = room_.near; i != room_.near + count; ++i) {
      const ScenePair& pair = scene_.pair[*i];
      if (!test_pair(pair, a_from_b(pair))) continue;
      culprit = {Kind::pair, *i, 0, 0, 0, 0};
      return true;
    }
    return false;
  }
  /// The frame of a pair's first link, seen from its second's.
  [[nodiscard]] BodyFrame a_from_b(const ScenePair& pair) const {
    return seen_from(bodies_.frame(scene_.link[pair.b].body),
                     bodies_.frame(scene_.link[pair.a].body));
  }
  bool test_pair(const ScenePair& pair, const BodyFrame& from_b) {
    Around of_a = around(scene_.link[pair.a]);
    of_a.centre = placed(from_b, of_a.centre);
    return test_nodes(from_b, of_a, around(scene_.link[pair.b]));
  }
  /// The clearances of a node's balls, which stand in lanes, from one.
  [[nodiscard]] IKSEL_INLINE T clearance_from(const SceneNode& node, int first,
                                              const Vec<T>& centres, const Around& one) const {
    // Both balls of a pair are smaller.
    const T radii = Lanes<T>::load(node.radius + first) + T(one.radius - 2 * scene_.smaller);
    return clearance(centres, {T(one.centre.x), T(one.centre.y), T(one.centre.z)}, radii);
  }
  static IKSEL_INLINE Vec<T> centres(const SceneNode& node, int first) {
    return {Lanes<T>::load(node.x + first), Lanes<T>::load(node.y + first),
            Lanes<T>::load(node.z + first)};
  }

  /// Whether balls of two links touch; a's frame is seen from b's, as its balls are. Nothing is
  /// said of a ball whose node is a leaf's.
  bool test_nodes(const BodyFrame& from_b, const Around& a, const Around& b) {
    const SceneNode& of_a = scene_.node[a.node];
    const SceneNode& of_b = scene_.node[b.node];
    // What is larger holds more that is far away.
    const bool into_b = !of_b.is_leaf && (of_a.is_leaf || a.radius <= b.radius);
    const SceneNode& of = into_b ? of_b : of_a;
    for (int first = 0; first < of.count; first += Lanes<T>::kCount) {
      const Vec<T> on_body = centres(of, first);
      const Vec<T> at = into_b ? on_body : placed(from_b, on_body);
      const T found = clearance_from(of, first, at, into_b ? a : b);
      unsigned mask = to_bits<T>(found <= T(0.0)) & lanes_up_to(of.count, first);
      if (mask == 0) continue;
      double x[Lanes<T>::kCount];
      double y[Lanes<T>::kCount];
      double z[Lanes<T>::kCount];
      double of_lane[Lanes<T>::kCount];
      Lanes<T>::store(found, of_lane);
      Lanes<T>::store(at.x, x);
      Lanes<T>::store(at.y, y);
      Lanes<T>::store(at.z, z);
      while (mask != 0) {
        const int lane = take_least(of_lane, mask);
        const int k = first + lane;
        const Around below{{x[lane], y[lane], z[lane]}, of.radius[k], of.first + k};
        if (into_b) {
          if (test_nodes(from_b, a, below)) return true;
        } else if (!(of_a.is_leaf && of_b.is_leaf)) {
          if (test_nodes(from_b, below, b)) return true;
        } else if (test_leaf(b.node, below)) {
          leaf_ = a.node;
          ball_ = k;
          return true;
        }
      }
    }
    return false;
  }
  bool test_leaf(int at, const Around& ball) {
    const SceneNode& leaf = scene_.node[at];
    for (int first = 0; first < leaf.count; first += Lanes<T>::kCount) {
      const T found = clearance_from(leaf, first, centres(leaf, first), ball);
      const unsigned mask = to_bits<T>(found <= T(0.0)) & lanes_up_to(leaf.count, first);
      if (mask == 0) continue;
      other_ = at;
      return touch(found, mask);
    }
    return false;
  }

  /// Whether balls below a node touch a shape.
  template <typename Shape>
  bool test_node(const BodyFrame& body, int at, const Shape& shape) {
    const SceneNode& node = scene_.node[at];
    for (int first = 0; first < node.count; first += Lanes<T>::kCount) {
      const Vec<T> centre = placed(body, centres(node, first));
      const T radius = Lanes<T>::load(node.radius + first) - T(scene_.smaller);
      if (is_far(shape, centre, radius)) continue;
      const T found = clearance(shape, centre, radius);
      unsigned mask = to_bits<T>(found <= T(0.0)) & lanes_up_to(node.count, first);
      if (mask != 0 && node.is_leaf) {
        leaf_ = at;
        return touch(found, mask);
      }
      for (int k = first; mask != 0; ++k, mask >>= 1U) {
        if ((mask & 1U) != 0 && test_node(body, node.first + k, shape)) return true;
      }
    }
    return false;
  }
  template <typename Shape>
  bool test_link(int link, const Shape& shape) {
    const SceneLink& of = scene_.link[link];
    return test_node(bodies_.frame(of.body), of.root, shape);
  }
  template <typename Shape>
  bool test_all(const Shape* shape, int count, Kind kind, SceneCulprit& culprit) {
    for (int first = 0; first < scene_.links; first += Lanes<T>::kCount) {
      const unsigned may = lanes_that_may(first);
      if (may == 0) continue;
      const Vec<T> centre = bodies_.link_centres(first);
      const T radius = bodies_.link_radii(first);
      for (int i = 0; i < count; ++i) {
        if (is_far(shape[i], centre, radius)) continue;
        unsigned mask = may & to_bits<T>(clearance(shape[i], centre, radius) <= T(0.0));
        for (int link = first; mask != 0; ++link, mask >>= 1U) {
          if ((mask & 1U) == 0 || !test_link(link, shape[i])) continue;
          culprit = {kind, i, link, 0, 0, 0};
          return true;
        }
      }
    }
    return false;
  }
  /// Links from `first` on that may touch obstacles.
  [[nodiscard]] unsigned lanes_that_may(int first) const {
    unsigned mask = 0;
    for (int lane = 0; lane < min_of(Lanes<T>::kCount, scene_.links - first); ++lane) {
      const int body = scene_.link[first + lane].body;
      if (body != 0 && body != scene_.cleared) mask |= 1U << static_cast<unsigned>(lane);
    }
    return mask;
  }

  const SceneView& scene_;
  const SceneRoom& room_;
  SceneBodies<T> bodies_;
  bool are_placed_;
  double clearance_ = 1;
  /// What was found to touch (SceneCulprit).
  int leaf_ = 0, ball_ = 0, other_ = 0;
};

template <typename T>
double find_clearance(const SceneView& scene, const double* q, SceneRoom& room) {
  return SceneCheck<T>(scene, room, q).find(room.culprit);
}

}  // namespace iksel::lanes
