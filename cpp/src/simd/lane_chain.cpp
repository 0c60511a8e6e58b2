// SPDX-License-Identifier: BSD-3-Clause
#include "simd/lane_chain.hpp"

#include "base/constants.hpp"

namespace iksel {

static_assert(lanes::kMaxJoints == kMaxDof);
static_assert(lanes::kMostSums == kMaxCoupledLimits);

bool is_simple(const ChainModel& model) {
  if (model.kernel.joints.size() != static_cast<std::size_t>(model.dof)) return false;
  for (int j = 0; j < model.dof; ++j) {
    const KernelJoint& joint = model.kernel.joints[static_cast<std::size_t>(j)];
    if (joint.variable != j || joint.multiplier != 1.0 || joint.curve) return false;
  }
  return true;
}

template <typename Number>
lanes::LaneChainOf<Number> make_lane_chain(const ChainModel& model, double unit) {
  const auto number = [](double x) { return static_cast<Number>(x); };
  lanes::LaneChainOf<Number> chain{};
  for (int j = 0; j < model.dof; ++j) {
    chain.unit[j] = model.joints.is_slide(j) ? unit : 1;
    chain.per_unit[j] = 1 / chain.unit[j];
  }
  for (const KernelJoint& from : model.kernel.joints) {
    auto& to = chain.joint[chain.joints++];
    for (int i = 0; i < 3; ++i) to.p[i] = number(from.p[i] / unit);
    to.cos_alpha = number(from.cos_alpha);
    to.sin_alpha = number(from.sin_alpha);
    to.cos_turn = number(from.cos_turn);
    to.sin_turn = number(from.sin_turn);
    const double unit_of_motion = from.prismatic ? unit : 1;
    to.multiplier = number(from.multiplier / unit_of_motion);
    to.unit = number(chain.unit[from.variable]);
    to.offset = number(from.offset / unit_of_motion);
    to.curve = from.curve.get();
    to.variable = from.variable;
    to.prismatic = from.prismatic;
  }
  chain.n = model.dof;
  chain.is_simple = is_simple(model);
  for (int j = 0; j < model.dof; ++j) {
    auto& to = chain.variable[j];
    const bool continuous = model.joints.type(j) == JointType::continuous;
    // A principal angle just off its interval is still the same angle.
    const double lower = continuous ? -kPi - 1e-9 : model.joints.lower[j];
    const double upper = continuous ? kPi + 1e-9 : model.joints.upper[j];
    to.lower = number(chain.to_lane(j, lower));
    to.upper = number(chain.to_lane(j, upper));
    to.limited = !continuous && !model.joints.winds(j);
  }
  for (const Limit& from : model.joints.sums) {
    // Beside a bound by less than this a lane stands at it; held to it, it does.
    constexpr Number kBeside = sizeof(Number) == sizeof(float) ? Number(1e-5) : Number(1e-9);
    lanes::LaneSumOf<Number>& to = chain.sum[chain.sums++];
    double norm2 = 0;
    for (int j = 0; j < chain.n; ++j) {
      const double c = chain.from_lane(j, from.c[j]);
      to.c[j] = number(c);
      norm2 += c * c;
    }
    to.lower = number(from.held_at(false));
    to.upper = number(from.held_at(true));
    to.low = to.lower + kBeside * number(from.size);
    to.high = to.upper - kBeside * number(from.size);
    to.least_norm2 = number(1e-12 * norm2);
  }
  return chain;
}

template lanes::LaneChain make_lane_chain<double>(const ChainModel& model, double unit);
template lanes::LaneChainOf<float> make_lane_chain<float>(const ChainModel& model, double unit);

}  // namespace iksel
