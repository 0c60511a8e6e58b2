// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/nearest_on_arcs.hpp"

#include <algorithm>
#include <cmath>

namespace iksel {
namespace {

/// A straight line between two points of an arc.
class Line {
 public:
  Line(const JointSpace& joints, const Curve::Joints& from, const Curve::Joints& to)
      : joints_(joints),
        from_(Eigen::Map<const Eigen::VectorXd>(from.data(), kCurveJoints)),
        way_(joints.difference(from, to)) {}

  /// The place on it nearest to `near`.
  [[nodiscard]] NearPlace nearest(const JointVector& near, const JointMove& move) const {
    NearPlace best{kInfinity, from_};
    // Between these the images that are nearest inside the limits stay the same.
    std::vector<double> parts{0, 1};
    for (int j = 0; j < kCurveJoints; ++j) add_turns(j, parts);
    std::sort(parts.begin(), parts.end());
    for (std::size_t i = 1; i < parts.size(); ++i) {
      NearPlace place = nearest_between(parts[i - 1], parts[i], near, move);
      if (place.move < best.move) best = std::move(place);
    }
    return best;
  }

 private:
  /// Where an image of a joint goes through a limit.
  void add_turns(int j, std::vector<double>& parts) const {
    if (!joints_.is_periodic(j) || joints_.type(j) == JointType::continuous || way_[j] == 0) return;
    for (const double limit : {joints_.lower[j], joints_.upper[j]}) {
      const double part = without_turns(limit - from_[j]) / way_[j];
      if (part > 0 && part < 1) parts.push_back(part);
    }
  }
  [[nodiscard]] NearPlace nearest_between(double begin, double end, const JointVector& near,
                                          const JointMove& move) const {
    const JointVector middle = from_ + 0.5 * (begin + end) * way_;
    JointVector image = middle;
    joints_.wrap_nearest(near, 0, image);
    const JointVector start = from_ + (image - middle);
    const JointVector off = move.weights().cwiseProduct(near - start);
    const JointVector way = move.weights().cwiseProduct(way_);
    const double part = off.dot(way) / std::max(way.squaredNorm(), 1e-30);
    NearPlace place{0, start + std::min(std::max(part, begin), end) * way_};
    place.move = move.length(place.q - near);
    return place;
  }

  const JointSpace& joints_;
  JointVector from_, way_;
};

/// Adds the places beside points to which the move is no longer than to those before and behind.
void add_least(const Curve::Arc& arc, const JointSpace& joints, const JointVector& near,
               const JointMove& move, std::vector<NearPlace>& least) {
  const std::size_t points = arc.q.size();
  std::vector<NearPlace> places(points);
  for (std::size_t i = 0; i < points; ++i) {
    JointVector& image = places[i].q;
    image = Eigen::Map<const Eigen::VectorXd>(arc.q[i].data(), kCurveJoints);
    joints.wrap_nearest(near, 0, image);
    places[i].move = move.length(image - near);
  }
  for (std::size_t i = 0; i < points; ++i) {
    const bool has_before = i > 0 || arc.is_closed();
    const bool has_behind = i + 1 < points || arc.is_closed();
    const std::size_t before = (i + points - 1) % points;
    const std::size_t behind = (i + 1) % points;
    if (has_before && places[before].move < places[i].move) continue;
    if (has_behind && places[behind].move < places[i].move) continue;
    NearPlace nearest = places[i];
    const auto look_at_line = [&](std::size_t to) {
      NearPlace on_line = Line(joints, arc.q[i], arc.q[to]).nearest(near, move);
      if (on_line.move < nearest.move) nearest = std::move(on_line);
    };
    if (has_before) look_at_line(before);
    if (has_behind) look_at_line(behind);
    least.push_back(std::move(nearest));
  }
}

}  // namespace

std::vector<NearPlace> find_nearest_on_arcs(const std::vector<Curve::Arc>& arcs,
                                            const JointSpace& joints, const JointVector& near,
                                            const JointMove& move) {
  std::vector<NearPlace> least;
  for (const Curve::Arc& arc : arcs) add_least(arc, joints, near, move, least);
  std::sort(least.begin(), least.end(),
            [](const NearPlace& a, const NearPlace& b) { return a.move < b.move; });
  const auto is_farther = [&](const NearPlace& place) {
    return place.move > least[0].move + 2 * off_lines(move);
  };
  least.erase(std::find_if(least.begin(), least.end(), is_farther), least.end());
  return least;
}

}  // namespace iksel
