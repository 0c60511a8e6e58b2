// SPDX-License-Identifier: BSD-3-Clause
// The bodies of an arm of balls in one configuration, and the balls around its links.
#pragma once

#include "simd/lane_math.hpp"
#include "simd/lane_vector.hpp"
#include "simd/scene_types.hpp"

namespace iksel::lanes {

/// A body's frame in another.
struct BodyFrame {
  Vec<double> x, y, z, p;
};

/// v, in axes of the frame, in those that the frame is seen from.
template <typename T>
IKSEL_INLINE Vec<T> turned(const BodyFrame& f, const Vec<T>& v) {
  return {T(f.x.x) * v.x + T(f.y.x) * v.y + T(f.z.x) * v.z,
          T(f.x.y) * v.x + T(f.y.y) * v.y + T(f.z.y) * v.z,
          T(f.x.z) * v.x + T(f.y.z) * v.y + T(f.z.z) * v.z};
}
template <typename T>
IKSEL_INLINE Vec<T> placed(const BodyFrame& f, const Vec<T>& v) {
  const Vec<T> on = turned(f, v);
  return {T(f.p.x) + on.x, T(f.p.y) + on.y, T(f.p.z) + on.z};
}
/// v in axes of the frame.
IKSEL_INLINE Vec<double> turned_back(const BodyFrame& f, const Vec<double>& v) {
  return {dot(f.x, v), dot(f.y, v), dot(f.z, v)};
}
/// a seen from b, both in the base frame.
IKSEL_INLINE BodyFrame seen_from(const BodyFrame& b, const BodyFrame& a) {
  return {turned_back(b, a.x), turned_back(b, a.y), turned_back(b, a.z), turned_back(b, a.p - b.p)};
}

/// The frames of a scene's bodies in the base frame, and the balls around its links, kept in a
/// room.
template <typename T>
class SceneBodies {
 public:
  SceneBodies(const SceneView& scene, const SceneRoom& room)
      : scene_(scene),
        room_(room),
        x_(room.centre),
        y_(x_ + room.link_stride),
        z_(y_ + room.link_stride),
        radius_(z_ + room.link_stride) {}

  /// Places the bodies as they are at q. False if some are nowhere, since a motion is not finite.
  [[nodiscard]] bool place_bodies(const double* q) {
    double motion[kMaxBodies];
    double s[kMaxBodies];
    double c[kMaxBodies];
    // The base has none, nor have lanes without a body.
    motion[0] = 0;
    for (int i = 1; i < scene_.bodies; ++i) {
      const SceneBody& body = scene_.body[i];
      const double value = q[body.variable];
      const double followed = body.curve == nullptr ? value : body.curve->at(value).value;
      motion[i] = followed * body.multiplier + body.offset;
    }
    for (int i = scene_.bodies; i % Lanes<T>::kCount != 0; ++i) motion[i] = 0;
    for (int i = 0; i < scene_.bodies; i += Lanes<T>::kCount) {
      T sine;
      T cosine;
      sincos(Lanes<T>::load(motion + i), sine, cosine);
      Lanes<T>::store(sine, s + i);
      Lanes<T>::store(cosine, c + i);
    }
    for (int k = 0; k < kFrameNumbers; ++k) room_.frame[k] = k % (kFrameRows + 1) == 0 ? 1.0 : 0.0;
    for (int i = 1; i < scene_.bodies; ++i) {
      if (!(abs(motion[i]) <= kSincosRange)) {
        s[i] = __builtin_sin(motion[i]);
        c[i] = __builtin_cos(motion[i]);
        if (s[i] != s[i]) return false;
      }
      place_body(i, motion[i], s[i], c[i]);
    }
    return true;
  }
  [[nodiscard]] IKSEL_INLINE BodyFrame frame(int body) const {
    const double* in = room_.frame + kFrameNumbers * body;
    const auto column = [in](int k) {
      const double* c = in + k * kFrameRows;
      return Vec<double>{c[0], c[1], c[2]};
    };
    return {column(0), column(1), column(2), column(3)};
  }
  /// Places the balls around links, of placed bodies.
  void place_links() {
    for (int run = 0; run < scene_.link_runs; ++run) {
      const SceneLinkRun& links = scene_.link_run[run];
      const BodyFrame body = frame(links.body);
      // What lies beyond the last link is written again by the next run.
      for (int i = links.first; i < links.first + links.count; i += Lanes<T>::kCount) {
        const Vec<T> centre = placed(
            body, Vec<T>{Lanes<T>::load(scene_.around[0] + i), Lanes<T>::load(scene_.around[1] + i),
                         Lanes<T>::load(scene_.around[2] + i)});
        Lanes<T>::store(centre.x, x_ + i);
        Lanes<T>::store(centre.y, y_ + i);
        Lanes<T>::store(centre.z, z_ + i);
        Lanes<T>::store(Lanes<T>::load(scene_.around[3] + i) - T(scene_.smaller), radius_ + i);
      }
    }
  }
  /// The centres and radii of the balls around links from `first` on.
  [[nodiscard]] IKSEL_INLINE Vec<T> link_centres(int first) const {
    return {Lanes<T>::load(x_ + first), Lanes<T>::load(y_ + first), Lanes<T>::load(z_ + first)};
  }
  [[nodiscard]] IKSEL_INLINE T link_radii(int first) const {
    return Lanes<T>::load(radius_ + first);
  }

  /// Pairs of which the balls around the links touch, into the room; returns how many. First the
  /// one where they do so most: if any pair touches, it most likely does.
  int find_near_pairs() {
    int count = 0;
    int* const near = room_.near;
    const ScenePairBlock* const end = scene_.pair_block + scene_.pair_blocks;
    for (const ScenePairBlock* block = scene_.pair_block; block != end; ++block) {
      unsigned mask = find_near(*block) & block->mask;
      for (const int* pair = block->pair; mask != 0; ++pair, mask >>= 1U) {
        if ((mask & 1U) != 0) near[count++] = *pair;
      }
    }
    double least = 1;
    for (int i = 0; i < count; ++i) {
      const int pair = near[i];
      const double part = nearness(scene_.pair[pair]);
      if (!(part < least)) continue;
      least = part;
      near[i] = near[0];
      near[0] = pair;
    }
    return count;
  }

 private:
  /// Lanes of a block in which the balls around the links touch, whether they may or not.
  [[nodiscard]] IKSEL_INLINE unsigned find_near(const ScenePairBlock& block) const {
    const int one = block.one;
    const Vec<T> centre{T(x_[one]), T(y_[one]), T(z_[one])};
    unsigned mask = 0;
    for (int lane = 0; lane < kWidth; lane += Lanes<T>::kCount) {
      const int others = block.first + lane;
      const Vec<T> d = link_centres(others) - centre;
      const T reach = link_radii(others) + T(radius_[one]);
      mask |= to_bits<T>(dot(d, d) <= reach * reach) << static_cast<unsigned>(lane);
    }
    return mask;
  }
  /// Distance^2 of the centres of the balls around two links, by that where they touch.
  [[nodiscard]] double nearness(const ScenePair& pair) const {
    const int a = pair.a;
    const int b = pair.b;
    const Vec<double> d{x_[a] - x_[b], y_[a] - y_[b], z_[a] - z_[b]};
    const double reach = radius_[a] + radius_[b];
    return dot(d, d) / (reach * reach);
  }
  /// Places a body on its parent, the rows of a column in lanes; `motion` [rad or m] has such a
  /// sine and cosine.
  IKSEL_INLINE void place_body(int i, double motion, double sine, double cosine) {
    const SceneBody& body = scene_.body[i];
    const double* parent = room_.frame + kFrameNumbers * body.parent;
    double* to = room_.frame + kFrameNumbers * i;
    for (int row = 0; row < kFrameRows; row += Lanes<T>::kCount) {
      const T x = Lanes<T>::load(parent + row);
      const T y = Lanes<T>::load(parent + row + kFrameRows);
      const T z = Lanes<T>::load(parent + row + 2 * kFrameRows);
      const auto turned = [&](const double(&v)[3]) {
        return x * T(v[0]) + y * T(v[1]) + z * T(v[2]);
      };
      T of_x = turned(body.x);
      T of_y = turned(body.y);
      const T of_z = turned(body.z);
      T of_p = Lanes<T>::load(parent + row + 3 * kFrameRows) + turned(body.p);
      if (body.prismatic) {
        of_p = of_p + of_z * T(motion);
      } else {
        const T before = of_x;
        of_x = before * T(cosine) + of_y * T(sine);
        of_y = of_y * T(cosine) - before * T(sine);
      }
      Lanes<T>::store(of_x, to + row);
      Lanes<T>::store(of_y, to + row + kFrameRows);
      Lanes<T>::store(of_z, to + row + 2 * kFrameRows);
      Lanes<T>::store(of_p, to + row + 3 * kFrameRows);
    }
  }

  const SceneView& scene_;
  const SceneRoom& room_;
  double *x_, *y_, *z_, *radius_;  ///< of the balls around links, in the room
};

}  // namespace iksel::lanes
