// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/curve_walker.hpp"

#include <algorithm>
#include <cmath>

#include "simd/lane_chain.hpp"

namespace iksel {

double way_between(const CurveWalker::Joints& a, const CurveWalker::Joints& b) {
  double way2 = 0;
  for (std::size_t j = 0; j < a.size(); ++j) way2 += (b[j] - a[j]) * (b[j] - a[j]);
  return std::sqrt(way2);
}

CurveWalker::Place CurveWalker::Place::reversed() const {
  Place other = *this;
  for (double& part : other.tangent) part = -part;
  return other;
}

CurveWalker::CurveWalker(const ChainModel& model, const lanes::LaneKernels& kernels)
    : chain_(make_lane_chain(model)), kernels_(kernels) {
  model.joints.visit_limits([&](const Limit& limit) {
    if (limit.joint < 0 || !model.joints.is_periodic(limit.joint)) limits_.push_back(limit);
  });
}

void CurveWalker::set_target(const Pose& Y, double longest) {
  pack_.longest = longest;
  for (int row = 0; row < lanes::kFullPoseRows; ++row) {
    pack_.target[row] = probe_.target[row] = full_pose_row(Y, row);
  }
}

bool CurveWalker::is_inside(const Joints& q) const {
  return std::all_of(limits_.begin(), limits_.end(), [&](const Limit& limit) {
    const double at = limit.value(q.data());
    return at >= limit.lower - kAtLimit && at <= limit.upper + kAtLimit;
  });
}

void CurveWalker::orient(Place* places, std::size_t count) {
  for (std::size_t first = 0; first < count; first += lanes::kWidth) {
    const std::size_t used = std::min<std::size_t>(lanes::kWidth, count - first);
    for (std::size_t lane = 0; lane < lanes::kWidth; ++lane) {
      const Joints& q = places[first + std::min(lane, used - 1)].q;
      for (std::size_t j = 0; j < kCurveJoints; ++j) probe_.q[j][lane] = q[j];
    }
    kernels_.orient_curves(chain_, probe_);
    for (std::size_t lane = 0; lane < used; ++lane) {
      Place& place = places[first + lane];
      for (std::size_t j = 0; j < kCurveJoints; ++j) {
        place.q[j] = probe_.q[j][lane];
        place.tangent[j] = probe_.tangent[j][lane];
      }
    }
  }
}

void CurveWalker::start(int lane, bool is_reversed) {
  constexpr double kFirstStep = 0.05;
  const Place& at = at_[static_cast<std::size_t>(lane)];
  for (std::size_t j = 0; j < kCurveJoints; ++j) {
    pack_.q[j][lane] = at.q[j];
    pack_.tangent[j][lane] = at.tangent[j];
  }
  pack_.side[lane] = is_reversed ? -1 : 1;
  pack_.step[lane] = std::min(kFirstStep, pack_.longest);
}

CurveWalker::Place CurveWalker::place(int lane) const {
  Place at;
  for (std::size_t j = 0; j < kCurveJoints; ++j) {
    at.q[j] = pack_.q[j][lane];
    at.tangent[j] = pack_.tangent[j][lane];
  }
  return at;
}

void CurveWalker::turn_to(int lane, const Joints& image) {
  at_[static_cast<std::size_t>(lane)].q = image;
  for (std::size_t j = 0; j < kCurveJoints; ++j) pack_.q[j][lane] = image[j];
}

}  // namespace iksel
