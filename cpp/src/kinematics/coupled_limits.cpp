// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {
namespace {

/// Less than this between the ends of a sum, in parts of its numbers, is no room to search in.
constexpr double kLeastRoom = 1e-6;

[[noreturn]] void refuse(const CoupledLimit& limit, std::size_t index, const std::string& what) {
  const std::string name = limit.coefficients.empty() ? "" : " (" + to_string(limit) + ")";
  throw InvalidArgumentError("coupled_limits[" + std::to_string(index) + "]" + name + ": " + what);
}

void check_numbers(const CoupledLimit& limit, std::size_t index) {
  if (limit.coefficients.empty()) refuse(limit, index, "it names no joint");
  for (const auto& [name, coefficient] : limit.coefficients) {
    if (std::abs(coefficient) <= kMaxCoordinate && coefficient != 0) continue;
    refuse(limit, index,
           "the coefficient of '" + name + "' is " +
               (coefficient == 0 ? "0" : too_large_text(coefficient)));
  }
  const auto ends = [&] {
    return "lower " + number_text(limit.lower) + ", upper " + number_text(limit.upper);
  };
  if (std::isnan(limit.lower) || std::isnan(limit.upper)) {
    refuse(limit, index, ends() + ": not a number");
  }
  if (limit.lower == -kInfinity && limit.upper == kInfinity) {
    refuse(limit, index, "it has neither a lower nor an upper end");
  }
  if (limit.lower < limit.upper) return;
  refuse(limit, index,
         ends() + (limit.lower == limit.upper
                       ? ": nothing is left between them; a joint that follows another is a mimic "
                         "joint of the URDF"
                       : ": the upper has to be above the lower"));
}

/// The names that a limit may have.
std::vector<std::string> names_in(const ChainSpec& spec) {
  std::vector<std::string> names;
  for (const ChainJoint& joint : spec.joints) {
    if (joint.has_value()) names.push_back(joint.name);
  }
  return names;
}

/// Adds a joint's part of a sum; returns what of it does not change.
double add_joint(const CoupledLimit& limit, std::size_t index, const std::string& name,
                 double coefficient, const ChainSpec& spec, const JointSpace& joints, Limit& row) {
  const auto refuse_endless = [&](int variable) {
    if (joints.type(variable) != JointType::continuous) return;
    refuse(limit, index,
           "joint '" + name +
               "' turns without limits, so that whole turns would take its sum "
               "anywhere: make it revolute, with limits");
  };
  const auto joint =
      std::find_if(spec.joints.begin(), spec.joints.end(),
                   [&](const ChainJoint& each) { return each.name == name && each.has_value(); });
  if (joint != spec.joints.end()) {
    if (joint->is_locked) return coefficient * joint->locked_at;
    refuse_endless(joint->variable);
    if (joint->curve) {
      refuse(limit, index,
             "joint '" + name + "' follows '" + joints.name(joint->variable) +
                 "' by a curve, so that there is no sum: name the joint that it follows");
    }
    row.c[joint->variable] += coefficient * joint->multiplier;
    return coefficient * joint->offset;
  }
  // What a mimic joint of the chain follows need not be on it.
  if (const int j = joints.find(name); j >= 0) {
    refuse_endless(j);
    row.c[j] += coefficient;
    return 0;
  }
  throw_unknown_name("coupled_limits[" + std::to_string(index) + "] (" + to_string(limit) +
                         "): joint '" + name + "' does not move on the chain",
                     name, names_in(spec));
}

/// Narrows a row's ends to where the joints let its sum go.
void narrow_to_joints(const CoupledLimit& limit, std::size_t index, const JointSpace& joints,
                      Limit& row) {
  double least = 0;
  double most = 0;
  double numbers = 0;
  for (int j = 0; j < joints.dof(); ++j) {
    if (row.c[j] == 0) continue;
    const double a = row.c[j] * joints.lower[j];
    const double b = row.c[j] * joints.upper[j];
    least += std::min(a, b);
    most += std::max(a, b);
    numbers += std::max(std::abs(a), std::abs(b));
  }
  row.rounding = 1e-12 * numbers;  // what rounding may take the sum off by, and more
  const double lower = std::max(row.lower, least - 2 * row.rounding);
  const double upper = std::min(row.upper, most + 2 * row.rounding);
  if (!(upper - lower > kLeastRoom * numbers)) {
    refuse(limit, index,
           "the joints' own limits take the sum from " + number_text(least) + " to " +
               number_text(most) + ", which leaves nothing between its lower " +
               number_text(row.lower) + " and upper " + number_text(row.upper));
  }
  row.lower = lower;
  row.upper = upper;
}

/// The images of the joints in coupled limits together.
void add_images(JointSpace& joints) {
  joints.images = {JointVector::Zero(joints.dof())};
  for (int j = 0; j < joints.dof(); ++j) {
    const bool is_coupled = std::any_of(joints.sums.begin(), joints.sums.end(),
                                        [j](const Limit& row) { return row.c[j] != 0; });
    if (!is_coupled || !joints.is_periodic(j)) continue;
    joints.turning.push_back(j);
    // From the image nearest to the middle of the limits so many to both sides.
    const double half = 0.5 * (joints.upper[j] - joints.lower[j]);
    const double turns = std::floor(half / kTwoPi + 0.5);
    const auto before = static_cast<double>(joints.images.size());
    if (before * (2 * turns + 1) > kMostImagesInSums) {
      throw InvalidArgumentError(
          "coupled_limits: joint '" + joints.name(j) + "' has " + number_text(2 * turns + 1) +
          " whole turns inside its limits, and those of coupled joints together more than " +
          std::to_string(kMostImagesInSums) + ": narrow them");
    }
    std::vector<JointVector> images;
    for (const JointVector& image : joints.images) {
      for (double turn = -turns; turn <= turns; ++turn) {
        images.push_back(image);
        images.back()[j] = turn;
      }
    }
    joints.images = std::move(images);
  }
}

/// A configuration as far inside of all limits as can be had in parts of their widths.
bool find_interior(JointSpace& joints) {
  const auto narrowed = [](double lower, double upper, double part, double& low, double& high) {
    low = lower + part * (upper - lower);
    high = upper - part * (upper - lower);
  };
  for (double part = 0.45; part > kLeastRoom; part *= 0.8) {
    JointSpace narrow = joints;
    for (int j = 0; j < joints.dof(); ++j) {
      if (joints.type(j) == JointType::continuous) continue;
      narrowed(joints.lower[j], joints.upper[j], part, narrow.lower[j], narrow.upper[j]);
    }
    for (Limit& row : narrow.sums) {
      narrowed(row.lower, row.upper, part, row.lower, row.upper);
    }
    joints.interior = narrow.clamp(narrow.interior);
    if (narrow.contains(joints.interior.data())) return true;
  }
  return false;
}

}  // namespace

std::string to_string(const CoupledLimit& limit) {
  std::string text;
  for (const auto& [name, coefficient] : limit.coefficients) {
    const std::string sign = coefficient < 0 ? "-" : "+";
    text += text.empty() ? (coefficient < 0 ? "-" : "") : " " + sign + " ";
    if (std::abs(coefficient) != 1) text += number_text(std::abs(coefficient)) + " ";
    text += name;
  }
  return text;
}

void add_coupled_limits(const std::vector<CoupledLimit>& limits, const ChainSpec& spec,
                        JointSpace& joints) {
  if (limits.empty()) return;
  if (limits.size() > static_cast<std::size_t>(kMaxCoupledLimits)) {
    throw InvalidArgumentError("coupled_limits: " + std::to_string(limits.size()) +
                               " were given; at most " + std::to_string(kMaxCoupledLimits) +
                               " are possible");
  }
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const CoupledLimit& limit = limits[i];
    check_numbers(limit, i);
    Limit row;
    row.coupled_limit = static_cast<int>(i);
    row.c.setZero(joints.dof());
    double constant = 0;
    for (const auto& [name, coefficient] : limit.coefficients) {
      constant += add_joint(limit, i, name, coefficient, spec, joints, row);
    }
    row.lower = limit.lower - constant;
    row.upper = limit.upper - constant;
    row.size = row.c.cwiseAbs().sum();
    if (row.size == 0) {
      if (row.lower <= 0 && row.upper >= 0) continue;
      refuse(limit, i, "its joints are held so that the sum is " + number_text(constant));
    }
    narrow_to_joints(limit, i, joints, row);
    joints.sums.push_back(std::move(row));
  }
  if (joints.sums.empty()) return;
  add_images(joints);
  joints.interior = joints.middle();
  if (find_interior(joints)) return;
  std::string all;
  for (const CoupledLimit& limit : limits) all += (all.empty() ? "" : ", ") + to_string(limit);
  throw InvalidArgumentError("coupled_limits: no configuration was found inside of all of " + all);
}

}  // namespace iksel
