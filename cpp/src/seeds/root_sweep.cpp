// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/root_sweep.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/constants.hpp"
#include "seeds/beyond_limits.hpp"

namespace iksel {
namespace {

/// So many times the tolerances, and what the axes lie off, away from axis 1, joint 1 is known well
/// enough: one reachable target of a million of gen3_6dof, whose pi is rounded, had been lost.
constexpr double kBesideAxis = 1000;

/// So many times farther apart than those of a residual that changes as fast as the target roots
/// that all but meet are moved: by the tolerances, and by what the axes lie off.
struct Apart {
  double by_tolerances, by_axes;

  /// How far apart they may be [rad].
  [[nodiscard]] double of(double tolerance, double deviation) const {
    return 2 * std::sqrt(by_tolerances * by_tolerances * tolerance + by_axes * by_axes * deviation);
  }
};
/// Of four million reachable targets of gen3_6dof, whose axes lie off, three had been lost; of a
/// million poses of twenty random arms, off by up to 0.7 of the tolerances, 144 (python -m bench
/// lost --random 20 --targets 50000 --off 0.7 --seed 4000 --builds offset_wrist).
constexpr Apart kFartherApart{2, 8};
/// But here only what is as near to an answer as a single root: of 100,000 targets of gen3_6dof
/// near singularities two had been lost, where four roots all but meet.
constexpr Apart kFarthestApart{4, 32};

/// Where a product over all branches turns and is no more than this many times the square of what
/// all but double roots are off, there may be roots that are farther apart: elbow and wrist are
/// both all but straight. `near` of gen3_6dof had lost two of a million targets near singularities
/// (python -m bench lost gen3_6dof --targets 0 --hard 1000000).
constexpr double kFaint = 0.001;

/// Where neighbouring values of a loop's determinant are less than so many times its noise, or one
/// is at which it turns, there may be roots or none; elsewhere they are known to within this part
/// of a cell. With 30 two reachable targets of 50 million had been lost, 1,000 and more cost
/// nothing (python -m bench lost --random 500 --targets 100000 --seed 620260000 --builds
/// right_angles_6).
constexpr double kAboveNoise = 10000;
/// By how much a loop may stay open at a root of its determinant, which is known but to its noise.
constexpr double kOpen = 0.02;
/// And by how many tolerances, if what is concluded is to be certain. This and the next two:
/// python -m bench laws general middle_sphere right_angles_6 --arms 200 --poses 100.
constexpr double kClosed = 4;
/// Where an angle may be off by more than this, any would do [rad].
constexpr double kFreely = 0.1;
/// Where none is off by more than this, and no root is double, the arm is not singular [rad].
constexpr double kDelicate = 1e-3;

/// Roots are found to within this [rad], or to within this share of what the axes lie off; so many
/// times the tolerances, what they lie off counts as nothing.
constexpr double kPrecision = 5e-10;
constexpr double kShare = 0.1;
double precision_for(double deviation) { return std::max(kPrecision, kShare * deviation); }
/// A branch that only is within so many times that of a root may be one that has it: of 1.6 million
/// reachable targets one had been lost (python -m bench lost --random 80 --targets 20000 --seed
/// 201130100 --builds offset_wrist).
constexpr double kAtEnd = 10;

RootFinder make_finder(const ChainModel& model, int joint, double vague, double precision,
                       const lanes::LaneKernels& kernels) {
  constexpr double kBeyond = 0.05;
  const double offset = model.kernel.joints[static_cast<std::size_t>(joint)].offset;
  const double lower = model.joints.sample_lower(joint) - kBeyond;
  const double upper = model.joints.sample_upper(joint) + kBeyond;
  return {lower + offset, upper - lower, vague, precision, kernels};
}

}  // namespace

RootSweep::RootSweep(const ChainModel& model, const ClosedFormChain& chain, bool is_nominal,
                     double tolerance, const lanes::LaneKernels& kernels)
    : model_(model),
      chain_(chain),
      kernels_(kernels),
      tolerance_(tolerance),
      concludes_(concludes_from_branches(is_nominal, tolerance)),
      vague_(Apart{1, 1}.of(tolerance, chain.deviation)),
      farther_(kFartherApart.of(tolerance, chain.deviation)),
      vague_divisor_(std::pow(kBesideAxis * (tolerance + chain.deviation), 2)),
      at_end_(kAtEnd * precision_for(chain.deviation)),
      roots_(make_finder(model, chain.held, kFarthestApart.of(tolerance, chain.deviation),
                         precision_for(chain.deviation), kernels)),
      polynomial_(kernels) {
  are_answers_ = is_nominal && chain.deviation <= kShare * tolerance;
  chain_.use_limits(model);
  chain_.form.error = tolerance;
  for (int lane = 0; lane < lanes::kWidth; ++lane) pack_.sign[2][lane] = 1;
}

bool RootSweep::find_product_roots(const Pose& Y) {
  chain_.set_target(Y, pack_);
  const lanes::ResidualForm form = make_residual(chain_, pack_);
  double least_divisor = kInfinity;
  const auto residual = [&](const double* angles, int n, double* residuals) {
    least_divisor = std::min(least_divisor, kernels_.find_residuals(form, angles, n, residuals));
  };
  roots_.find(residual, kFaint * vague_ * vague_);
  return least_divisor > vague_divisor_;
}

bool RootSweep::find_loop_roots(const Pose& Y) {
  chain_.loop->set_target(chain_.reversed ? Y.inverse() : Y, loop_);
  polynomial_.find(loop_);
  const auto determinant = [&](const double* angles, int n, double* values) {
    kernels_.evaluate_polynomial(polynomial_.get(), angles, n, values);
  };
  const double faint = kAboveNoise * polynomial_.noise();
  roots_.find(determinant, faint);
  return roots_.faintest() > faint;
}

void RootSweep::find(const Pose& Y, bool wants_all) {
  const bool is_clear = chain_.loop ? find_loop_roots(Y) : find_product_roots(Y);
  certain_ = concludes_ && roots_.is_complete() && is_clear;
  is_at_limit_ = false;
  is_delicate_ = chain_.loop != nullptr;
  size_ = 0;
  if (chain_.loop) take_all(Y, /*are_pairs=*/true);
  take_all(Y, /*are_pairs=*/false);
  if (wants_all && certain_ && is_delicate_ && has_singular()) certain_ = false;
  certain_but_for_limits_ = certain_;
  // At a limit, what the tolerances allow decides.
  certain_ = certain_ && !is_at_limit_;
}

void RootSweep::take_all(const Pose& Y, bool are_pairs) {
  std::array<const RootFinder::Root*, RootFinder::kMost> roots{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < roots_.size(); ++i) {
    if (!chain_.loop || roots_[i].is_vague == are_pairs) roots[count++] = &roots_[i];
  }
  // Each root has a lane, or by the first one or two of the three signs two or four: two to this
  // power.
  const unsigned lanes_power =
      chain_.loop ? unsigned{chain_.loop->form().has_two_ways()} + unsigned{are_pairs} : 2;
  const std::size_t at_once = static_cast<std::size_t>(lanes::kWidth) >> lanes_power;
  for (std::size_t first = 0; first < count; first += at_once) {
    const std::size_t n = std::min(at_once, count - first) << lanes_power;
    for (std::size_t lane = 0; lane < lanes::kWidth; ++lane) {
      pack_.held[lane] = roots[first + (std::min(lane, n - 1) >> lanes_power)]->angle;
    }
    if (chain_.loop) {
      kernels_.close_loops(chain_.loop->form(), loop_, chain_.form, are_pairs, pack_);
    } else {
      kernels_.find_branches(chain_.form, pack_);
    }
    for (std::size_t lane = 0; lane < n; ++lane) {
      take(Y, *roots[first + (lane >> lanes_power)], static_cast<int>(lane));
    }
  }
}

bool RootSweep::has_singular() const {
  for (int i = 0; i < size_; ++i) {
    if (model_.is_almost_singular(q(i))) return true;
  }
  return false;
}

int RootSweep::find_crossing(double angle, int lane) {
  constexpr int kRounds = 3;
  crossing_ = pack_;
  for (auto& sign : crossing_.sign) std::fill_n(sign, lanes::kWidth, double{sign[lane]});
  int nearest = -1;
  double step = 2 * vague_ / (lanes::kWidth - 1);
  for (int round = 0; round < kRounds; ++round, step /= lanes::kWidth - 1) {
    for (int i = 0; i < lanes::kWidth; ++i) {
      crossing_.held[i] = angle + step * (i - 0.5 * (lanes::kWidth - 1));
    }
    kernels_.find_branches(chain_.form, crossing_);
    const double* residual = crossing_.residual;
    nearest = -1;
    double away = kInfinity;
    for (int i = 0; i + 1 < lanes::kWidth; ++i) {
      // Beyond its ends, which may be near to each other, its residual is as there.
      const bool exists = std::max(crossing_.least[i], crossing_.least[i + 1]) > -vague_ * vague_;
      const double middle = crossing_.held[i] + 0.5 * step;
      if (!exists || residual[i] * residual[i + 1] > 0 || std::abs(middle - angle) >= away)
        continue;
      away = std::abs(middle - angle);
      nearest = i;
    }
    if (nearest < 0) return -1;
    angle = crossing_.held[nearest] + 0.5 * step;
  }
  const double* residual = &crossing_.residual[nearest];
  return std::abs(residual[1]) < std::abs(residual[0]) ? nearest + 1 : nearest;
}

void RootSweep::take(const Pose& Y, const RootFinder::Root& root, int lane) {
  const bool is_vague = root.is_vague;
  // Roots are off by what the tolerances allow, many times over; but where there are two, by its
  // square root.
  const bool is_loose = is_vague && root.apart <= farther_;
  // Where a branch ends, its residual changes as the root of how far it is away.
  const bool ends = !chain_.loop && !is_vague && std::abs(pack_.least[lane]) < at_end_;
  const double slack = is_loose ? 4 * vague_ : 25 * vague_ * vague_;
  const bool only_just_is = ends || (is_loose && std::abs(pack_.least[lane]) < vague_ * vague_);
  const double most = chain_.loop ? std::max(slack, kOpen) : slack;
  // Of two solutions that all but share an angle of a loop's first joint, one or both are not
  // found.
  if (chain_.loop && is_vague) certain_ = false;
  if (!(pack_.least[lane] > -slack)) return;
  // Of a product that hardly differs from 0, only branches that all but meet tell of roots.
  if (!chain_.loop && root.is_faint && !(std::abs(pack_.least[lane]) < vague_ * vague_)) return;
  // Nor does the residual tell where such a branch may have any angles.
  const bool tells = !(only_just_is && pack_.error[lane] > kFreely);
  const lanes::BranchPack* at = &pack_;
  if (tells && !(std::abs(pack_.residual[lane]) < most)) {
    if (chain_.loop) certain_ = false;
    if (chain_.loop || !only_just_is) return;
    lane = find_crossing(root.angle, lane);
    if (lane < 0) return;
    at = &crossing_;
  }
  // A loop that closes nearly may do so beside the angles of another solution.
  const bool is_closed = !chain_.loop || std::abs(at->residual[lane]) < kClosed * tolerance_;
  if (!is_closed) certain_ = false;
  // Where any angle would do, or nearly, it need not be one outside the limits.
  const double beyond = at->beyond[lane];
  const bool is_free = beyond > 0 && !(at->error[lane] < std::max(beyond, kFreely));
  const bool is_sure = is_closed && !is_free && !only_just_is;
  const bool is_far = beyond > std::max(slack, kFirstOrder);
  if (is_far && is_sure) return;
  if (size_ == kRoom) {
    certain_ = false;
    return;
  }
  double* q = next().data();
  chain_.copy_joints(at->q, lane, q);
  if (beyond > 0) {
    const Pose T_base_tcp = to_pose(model_.kernel.base) * Y * to_pose(model_.kernel.tip);
    if (is_closed &&
        is_beyond_limits(model_, T_base_tcp, Eigen::Map<const Eigen::VectorXd>(q, model_.dof),
                         tolerance_ * chain_.unit, tolerance_, is_vague)) {
      return;
    }
    if (is_far) {
      const JointVector inside =
          model_.joints.clamp(Eigen::Map<const Eigen::VectorXd>(q, model_.dof));
      std::copy_n(inside.data(), model_.dof, q);
    }
    is_at_limit_ = true;
    if (!is_sure) certain_ = false;
  }
  is_delicate_ = is_delicate_ || is_vague || !(at->error[lane] < kDelicate);
  ++size_;
}

}  // namespace iksel
