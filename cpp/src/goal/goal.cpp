// SPDX-License-Identifier: BSD-3-Clause
#include "goal/goal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/constants.hpp"
#include "base/plain_vector.hpp"
#include "iksel/pose.hpp"
#include "scene/scene_data.hpp"

namespace iksel {
namespace {

/// Uniform over all rotations (Shoemake: "Uniform random rotations", Graphics Gems III, 1992).
Eigen::Matrix3d random_rotation(Random& random) {
  const double u = random.uniform();
  const double a = random.uniform(-kPi, kPi);
  const double b = random.uniform(-kPi, kPi);
  const double root = std::sqrt(1 - u);
  return Eigen::Quaterniond(std::sqrt(u) * std::cos(b), root * std::sin(a), root * std::cos(a),
                            std::sqrt(u) * std::sin(b))
      .toRotationMatrix();
}

}  // namespace

Pose Goal::nearest_pose() const {
  if (is_full_pose()) return target_;
  return task_.pose_at(target_, Vector6::Zero().cwiseMax(task_.lower()).cwiseMin(task_.upper()));
}

Pose Goal::random_pose(Random& random) const {
  const double reach = model_.reach_of_tcp();
  Pose any = Pose::Identity();
  any.linear() = random_rotation(random);
  for (int i = 0; i < 3; ++i) {
    any.translation()[i] = model_.reach_centre[i] + random.uniform(-reach, reach);
  }
  const Vector6 drawn = task_.deviation(target_, any);
  Vector6 d;
  for (int i = 0; i < 6; ++i) {
    const double lower = task_.lower()[i];
    const double upper = task_.upper()[i];
    d[i] = std::isfinite(upper - lower) ? random.uniform(lower, upper)
                                        : std::min(std::max(drawn[i], lower), upper);
  }
  Pose pose = task_.pose_at(target_, d);
  if (task_.rotation_is_free()) pose.linear() = any.linear();
  return pose;
}

bool Goal::is_out_of_reach() const {
  if (tips_ != nullptr) return tips_->first_out_of_reach() >= 0;
  const double distance = is_full_pose() ? (target_.translation() - model_.reach_centre).norm()
                                         : task_.distance_from(target_, model_.reach_centre);
  // What rounding leaves of a stretched arm's length, which is more than the tolerance of a huge
  // one.
  if (distance > (1 + kRounding) * model_.reach_of_tcp() + task_.position_tolerance()) return true;
  if (model_.unmoved.is_empty()) return false;
  const Vector6 allowed = task_.lower().cwiseAbs().cwiseMax(task_.upper().cwiseAbs());
  return model_.unmoved.excludes(target_, task_.position_tolerance() + allowed.head<3>().sum(),
                                 task_.rotation_tolerance() + allowed.tail<3>().sum());
}

void Goal::measure(const JointVector& q, double& position, double& rotation,
                   Jacobian* jacobian) const {
  if (tips_ != nullptr) {
    tips_->measure(q, position, rotation);
  } else if (!is_full_pose()) {
    task_.measure(target_, model_.fk(q.data()), position, rotation);
  } else if (jacobian != nullptr) {
    measure_error(target_, model_.fk_jacobian(q.data(), *jacobian), position, rotation);
  } else {
    measure_error(target_, model_.fk_frame(q.data()), position, rotation);
  }
}

void Goal::linearize(const JointVector& q, bool exact, Linear& at) const {
  Jacobian of_pose;
  const Pose pose = to_pose(model_.fk_jacobian(q.data(), of_pose));
  at.J = of_pose;
  linearize(pose, exact, at);
}

void Goal::linearize(const Pose& pose, bool exact, Linear& at) const {
  at.lower = task_.aim_lower();
  at.upper = task_.aim_upper();
  if (is_full_pose() && !exact) {
    at.missing = pose_error(target_, pose);
    at.deviation = -at.missing;
  } else {
    at.deviation = task_.deviation(target_, pose, at.J);
    at.missing = task_.missing(at.deviation);
  }
}

bool Goal::check(const JointVector& q, Result& result) const {
  if (!joints().contains(q.data())) return false;
  double position = std::numeric_limits<double>::quiet_NaN();
  double rotation = position;
  measure(q, position, rotation);
  if (!is_reached(position, rotation)) return false;
  result.status = Status::solved;
  result.proof = Proof::answer;
  result.q = q;
  result.position_error = position;
  result.rotation_error = rotation;
  return true;
}

bool Goal::is_free(const JointVector& q) const {
  bool free = true;
  if (scene_ != nullptr) scene_->find_free(q.data(), 1, &free);
  return free;
}

bool Goal::is_never_free() const {
  return scene_ != nullptr && is_full_pose() &&
         scene_->data().touches_at(tip_target(), task_.position_tolerance(),
                                   task_.rotation_tolerance());
}

void measure_error(const Pose& target, const Frame& f, double& position_error,
                   double& rotation_error) {
  double square = 0;
  double sine2 = 0;  // |R_target R^T - its transpose|^2 / 4: sine of the angle, squared
  double trace = 0;
  for (int i = 0; i < 3; ++i) {
    const int a = (i + 1) % 3;
    const int b = (i + 2) % 3;
    const double d = target(i, 3) - f.p[i];
    const double v = 0.5 * (f.x[a] * target(b, 0) - f.x[b] * target(a, 0) + f.y[a] * target(b, 1) -
                            f.y[b] * target(a, 1) + f.z[a] * target(b, 2) - f.z[b] * target(a, 2));
    square += d * d;
    sine2 += v * v;
    trace += f.x[i] * target(i, 0) + f.y[i] * target(i, 1) + f.z[i] * target(i, 2);
  }
  const double sine = std::sqrt(sine2);
  position_error =
      square < kInfinity ? std::sqrt(square) : length_of(target.translation() - to_vector(f.p));
  // asin by its series where that is exact to the last digit; it also spares an arc tangent.
  const bool small = sine < 1e-4 && trace > 1;
  rotation_error = small ? sine * (1 + sine2 / 6) : std::atan2(sine, 0.5 * (trace - 1));
}

}  // namespace iksel
