// SPDX-License-Identifier: BSD-3-Clause
#include "structure/closed_form.hpp"

namespace iksel {
namespace {

using Eigen::Vector3d;

/// The rotations that a point does not feel.
constexpr int kAboutPoint = 3;

class Completion {
 public:
  Completion(const ChainModel& model, double tolerance)
      : chain_(ScrewAxes::of(model)),
        joints_(chain_.h.size()),
        tcp_(chain_.end * to_pose(model.kernel.tip)),
        reach_(model.reach),
        tolerance_(tolerance) {}

  /// By axes that are locked, and `free` ones behind them.
  [[nodiscard]] std::vector<CompletedAxes> with(const std::vector<Vector3d>& free) const {
    std::vector<CompletedAxes> ways;
    for (const Vector3d& point : places_of_locked()) {
      CompletedAxes way{chain_, free_};
      while (way.axes.h.size() + free.size() < kPoseJoints) append_across(way.axes, point);
      for (const Vector3d& direction : free) {
        way.free |= 1U << way.axes.h.size();
        way.axes.h.push_back(direction);
        way.axes.p.emplace_back(tcp_.translation());
      }
      if (way.axes.h.size() == kPoseJoints) ways.push_back(std::move(way));
    }
    return ways;
  }

  [[nodiscard]] std::vector<CompletedAxes> for_spin(int axis) {
    const Vector3d spin = tcp_.linear().col(axis);
    if (chain_.h.back().cross(spin).norm() > tolerance_ || !passes_tcp(joints_ - 1)) {
      return with({spin});
    }
    free_ |= 1U << (joints_ - 1);
    return with({});
  }

  /// The last joints of which the axes pass the TCP turn it, but do not move it.
  [[nodiscard]] std::vector<CompletedAxes> for_position() {
    std::size_t moving = joints_;
    while (moving > 0 && joints_ - moving < kAboutPoint && passes_tcp(moving - 1)) {
      free_ |= 1U << --moving;
    }
    if (moving != kPoseJoints - kAboutPoint) return {};
    ScrewAxes wrist = chain_;
    while (wrist.h.size() < kPoseJoints) append_across(wrist, tcp_.translation());
    return with({wrist.h.begin() + static_cast<std::ptrdiff_t>(joints_), wrist.h.end()});
  }

 private:
  [[nodiscard]] bool passes_tcp(std::size_t j) const {
    return chain_.distance(j, tcp_.translation()) <= tolerance_ * reach_;
  }

  /// An axis through the point, across the last one and the one before that.
  static void append_across(ScrewAxes& axes, const Vector3d& point) {
    const std::size_t n = axes.h.size();
    const Vector3d across = axes.h[n - 1].cross(axes.h[n - 2]);
    axes.h.push_back(across.norm() > 0.1 ? Vector3d(across.normalized())
                                         : axes.h[n - 1].unitOrthogonal());
    axes.p.push_back(point);
  }

  /// Where locked axes help: where the last two axes meet, so that three do; anywhere on the last
  /// one; and behind three joints away from it, so that a wrist is at the end of an arm.
  [[nodiscard]] std::vector<Vector3d> places_of_locked() const {
    const std::size_t last = joints_ - 1;
    std::vector<Vector3d> places;
    if (joints_ == kPoseJoints - kAboutPoint) {
      places.emplace_back(chain_.p[last] + reach_ * chain_.h[last].unitOrthogonal());
      return places;
    }
    if (chain_.angle(last - 1, last) > kClearlyNotParallel) {
      places.push_back(chain_.middle(last - 1, last));
    }
    places.push_back(chain_.p[last]);
    return places;
  }

  ScrewAxes chain_;
  std::size_t joints_;
  Pose tcp_;
  double reach_;
  double tolerance_;
  unsigned free_ = 0;
};

}  // namespace

std::vector<CompletedAxes> complete_axes(const ChainModel& model, const Task& task,
                                         double tolerance) {
  if (model.dof < kPoseJoints - kAboutPoint || model.dof > kPoseJoints) return {};
  Completion completion(model, tolerance);
  if (task.is_full_pose()) return completion.with({});
  if (task == Task::position_only()) return completion.for_position();
  for (int axis = 0; axis < 3; ++axis) {
    if (task == Task::free_spin(static_cast<Axis>(axis))) return completion.for_spin(axis);
  }
  return {};
}

}  // namespace iksel
