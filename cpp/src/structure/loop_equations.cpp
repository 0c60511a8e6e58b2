// SPDX-License-Identifier: BSD-3-Clause
#include "structure/loop_equations.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "base/constants.hpp"
#include "base/plain_vector.hpp"
#include "base/rotation.hpp"
#include "structure/closed_form.hpp"

namespace iksel {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kAngles = 3;
constexpr int kInvariant = 14;

double node(int i) { return kTwoPi / kAngles * i; }

/// From values at the three angles to what is constant, goes by cosine, and by sine.
Matrix3d by_harmonics() {
  Matrix3d F;
  for (int i = 0; i < kAngles; ++i) {
    F(0, i) = 1.0 / kAngles;
    F(1, i) = 2.0 / kAngles * std::cos(node(i));
    F(2, i) = 2.0 / kAngles * std::sin(node(i));
  }
  return F;
}

int power_of_three(int n) { return n == 0 ? 1 : 3 * power_of_three(n - 1); }

/// What is linear in itself under a motion, and 1.
Eigen::Matrix<double, kInvariant + 1, 1> features(const Vector3d& p, const Vector3d& l) {
  Eigen::Matrix<double, kInvariant + 1, 1> x;
  const double p2 = p.squaredNorm();
  const double along = p.dot(l);
  x << p, p2, l, along, p.cross(l), p2 * l - 2 * along * p, 1;
  return x;
}

/// Features behind a motion, without the 1, of those before it.
Eigen::Matrix<double, kInvariant, kInvariant + 1> moved(const Pose& motion) {
  constexpr int kP = 0, kP2 = 3, kL = 4, kAlong = 7, kMoment = 8, kN = 11, kOne = 14;
  const Matrix3d R = motion.linear();
  const Vector3d t = motion.translation();
  const Eigen::RowVector3d row = t.transpose() * R;
  Eigen::Matrix<double, kInvariant, kInvariant + 1> out;
  out.setZero();
  out.block<3, 3>(kP, kP) = R;
  out.block<3, 1>(kP, kOne) = t;
  out(kP2, kP2) = 1;
  out.block<1, 3>(kP2, kP) = 2 * row;
  out(kP2, kOne) = t.squaredNorm();
  out.block<3, 3>(kL, kL) = R;
  out(kAlong, kAlong) = 1;
  out.block<1, 3>(kAlong, kL) = row;
  out.block<3, 3>(kMoment, kMoment) = R;
  out.block<3, 3>(kMoment, kL) = cross_matrix(t) * R;
  out.block<3, 3>(kN, kN) = R;
  out.block<3, 3>(kN, kMoment) = -2 * cross_matrix(t) * R;
  out.block<3, 3>(kN, kL) = t.squaredNorm() * R - 2 * t * row;
  out.block<3, 1>(kN, kAlong) = -2 * t;
  return out;
}

/// What three axes from one on are to each other.
lanes::LoopForm::Rest rest_of(const AxisPattern& pattern, std::size_t first) {
  using Rest = lanes::LoopForm::Rest;
  if (pattern.has({AxisRun::Lie::meet, first, 3})) return Rest::meet;
  return pattern.has({AxisRun::Lie::parallel, first, 3}) ? Rest::parallel : Rest::anyhow;
}

}  // namespace

LoopEquations::LoopEquations(const ScrewAxes& axes, double unit, int swept)
    : unit_(unit), end_(axes.end), kernels_(&lanes::choose_kernels()) {
  end_.translation() /= unit;
  form_.before = (kPoseJoints - swept) % kPoseJoints;
  for (int i = 0; i < kPoseJoints; ++i) {
    const auto joint = static_cast<std::size_t>((swept + i) % kPoseJoints);
    copy_vector(axes.h[joint], form_.h[i]);
    copy_vector(axes.p[joint] / unit, form_.p[i]);
  }
  // The target does not stand between these.
  const auto last_three = static_cast<std::size_t>((swept + 3) % kPoseJoints);
  form_.rest = rest_of(AxisPattern(axes, unit, kStructureTolerance), last_three);
  copy_vector(Vector3d(form_.h[3]).unitOrthogonal(), form_.across);
  make_points();
  make_equations();
  const auto n = static_cast<int>(points_.cols());
  for (int k = 0; k < n; ++k) {
    for (int row = 0; row < kCoefficients / n; ++row) {
      // The three angles' harmonics as one number of base 3, and the equation between them.
      const int of = row / lanes::kEquations * n + k;
      const int place = of / 9 * 9 * lanes::kEquations + row % lanes::kEquations * 9 + of % 9;
      place_[static_cast<std::size_t>(kCoefficients / n * k + row)] =
          static_cast<unsigned char>(place);
    }
  }
}

Pose LoopEquations::motion(int joint, double angle) const {
  const Vector3d p(form_.p[joint]);
  Pose turn = Pose::Identity();
  turn.linear() = Eigen::AngleAxisd(angle, Vector3d(form_.h[joint])).toRotationMatrix();
  turn.translation() = p - turn.linear() * p;
  return turn;
}

void LoopEquations::make_points() {
  const int count = power_of_three(3 - form_.before);
  points_.setZero(kFeatures, count);
  for (int i = 0; i < count; ++i) {
    Vector3d p(form_.p[3]);
    Vector3d l(form_.h[3]);
    for (int j = 2, rest = i; j >= form_.before; --j, rest /= kAngles) {
      const Pose turn = motion(j, node(rest % kAngles));
      p = turn * p;
      l = turn.linear() * l;
    }
    points_.col(i).head<kInvariant + 1>() = features(p, l);
  }
  // By the angles, one after the other, in place of the values.
  const Matrix3d F = by_harmonics();
  for (int stride = 1; stride < count; stride *= kAngles) {
    for (int i = 0; i < count; ++i) {
      if (i / stride % kAngles != 0) continue;
      Eigen::Matrix<double, kFeatures, kAngles> values;
      for (int k = 0; k < kAngles; ++k) values.col(k) = points_.col(i + k * stride);
      for (int k = 0; k < kAngles; ++k) points_.col(i + k * stride) = values * F.row(k).transpose();
    }
  }
}

void LoopEquations::make_equations() {
  const Matrix3d F = by_harmonics();
  Eigen::Matrix<double, kInvariant, 9> products;
  products.setZero();
  for (int i = 0; i < 9; ++i) {
    const Pose back = motion(5, -node(i / 3)) * motion(4, -node(i % 3));
    const auto x = features(back * Vector3d(form_.p[3]), back.linear() * Vector3d(form_.h[3]));
    for (int k = 0; k < 9; ++k) {
      products.col(k) += F(k / 3, i / 3) * F(k % 3, i % 3) * x.head<kInvariant>();
    }
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(products.rightCols<8>(), Eigen::ComputeFullU);
  const Eigen::Matrix<double, lanes::kEquations, kInvariant> left =
      svd.matrixU().rightCols<lanes::kEquations>().transpose();
  const int count = power_of_three(form_.before);
  const int rows = lanes::kEquations * count;
  equations_.setZero((rows + lanes::kWidth - 1) / lanes::kWidth * lanes::kWidth, kFeatures);
  for (int i = 0; i < count; ++i) {
    Pose turn = Pose::Identity();
    for (int j = form_.before - 1, rest = i; j >= 0; --j, rest /= kAngles) {
      turn = motion(j, node(rest % kAngles)) * turn;
    }
    const Eigen::Matrix<double, lanes::kEquations, kInvariant + 1> at = left * moved(turn);
    for (int k = 0; k < count; ++k) {
      double share = 1;
      for (int j = 0, a = i, b = k; j < form_.before; ++j, a /= kAngles, b /= kAngles) {
        share *= F(b % kAngles, a % kAngles);
      }
      equations_.block<lanes::kEquations, kInvariant + 1>(lanes::kEquations * k, 0) += share * at;
    }
  }
  equations_.block<lanes::kEquations, 1>(0, kInvariant) -= left * products.col(0);
}

void LoopEquations::set_target(const Pose& Y, lanes::LoopTarget& target) const {
  const Matrix3d R = end_.linear() * Y.linear().transpose();
  const Vector3d t = end_.translation() - R * (Y.translation() / unit_);
  for (int k = 0; k < 3; ++k) copy_vector(R.col(k), target.R[k]);
  copy_vector(t, target.t);
  Pose motion = Pose::Identity();
  motion.linear() = R;
  motion.translation() = t;
  alignas(64) double by_motion[kFeatures * kFeatures];
  Eigen::Map<Eigen::Matrix<double, kFeatures, kFeatures>> map(by_motion);
  map.setZero();
  map.topLeftCorner<kInvariant, kInvariant + 1>() = moved(motion);
  map(kInvariant, kInvariant) = 1;
  const auto n = static_cast<int>(points_.cols());
  const auto rows = static_cast<int>(equations_.rows());
  // 27 columns at most; of 3, 9 and 27 times six equations with zeros 9, 3 and 1.
  alignas(64) double at[kFeatures * 27];
  alignas(64) double products[27 * lanes::kWidth];
  kernels_->multiply(by_motion, kFeatures, points_.data(), kFeatures, n, at);
  kernels_->multiply(equations_.data(), rows, at, kFeatures, n, products);
  double* coefficients = &target.equation[0][0][0][0];
  const int used = kCoefficients / n;
  for (int k = 0, i = 0; k < n; ++k) {
    for (int row = 0; row < used; ++row, ++i) {
      coefficients[place_[static_cast<std::size_t>(i)]] = products[k * rows + row];
    }
  }
}

LoopPolynomial::LoopPolynomial(const lanes::LaneKernels& kernels) : kernels_(kernels) {
  for (int i = 0; i < kSamples; ++i) {
    const double angle = kTwoPi / kSamples * i;
    angles_[static_cast<std::size_t>(i)] = angle;
    for (int k = 0; k < kHarmonics; ++k) {
      const double share = (k == 0 ? 1.0 : 2.0) / kSamples;
      by_harmonics_(2 * k, i) = share * std::cos(k * angle);
      by_harmonics_(2 * k + 1, i) = share * std::sin(k * angle);
    }
  }
}

void LoopPolynomial::find(const lanes::LoopTarget& target) {
  std::array<double, kSamples> values;
  kernels_.find_determinants(target, angles_.data(), kSamples, values.data());
  const Harmonics harmonics = by_harmonics_.lazyProduct(
      Eigen::Map<const Eigen::Matrix<double, kSamples, 1>>(values.data()));
  noise_ = 0;
  double squares = 0;
  for (int k = 0; k < kHarmonics; ++k) {
    const double a = harmonics[2 * k];
    const double b = harmonics[2 * k + 1];
    if (k > lanes::TrigonometricPolynomial::kDegree) {
      noise_ = std::max({noise_, std::abs(a), std::abs(b)});
      continue;
    }
    squares += a * a + b * b;
    polynomial_.a[k] = a;
    polynomial_.b[k] = b;
  }
  size_ = std::sqrt(squares);
}

double LoopPolynomial::slope(double angle) const {
  double slope = 0;
  for (int k = 1; k <= lanes::TrigonometricPolynomial::kDegree; ++k) {
    slope += k * (polynomial_.b[k] * std::cos(k * angle) - polynomial_.a[k] * std::sin(k * angle));
  }
  return slope;
}

}  // namespace iksel
