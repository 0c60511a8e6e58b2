// SPDX-License-Identifier: BSD-3-Clause
#include "structure/closed_form.hpp"

#include <cmath>

#include "base/constants.hpp"
#include "base/plain_vector.hpp"
#include "simd/lane_chain.hpp"

namespace iksel {
namespace {

using Eigen::Vector3d;
using lanes::Closure;

/// x . R(k, t) y.
lanes::Turned turned(const Vector3d& x, const Vector3d& k, const Vector3d& y) {
  const double c = k.dot(x) * k.dot(y);
  const double a = x.dot(y) - c;
  const double b = x.dot(k.cross(y));
  const double r2 = a * a + b * b;
  return {a, b, c, r2, 1 / std::max(r2, 1e-30)};
}

lanes::ClosedForm make_form(Closure closure, const ScrewAxes& axes, double unit) {
  const auto& h = axes.h;
  const auto way = [&](std::size_t j) { return Vector3d((axes.p[j + 1] - axes.p[j]) / unit); };
  const Vector3d p12 = way(0);
  const Vector3d p23 = way(1);
  const Vector3d p34 = way(2);
  const Vector3d p45 = way(3);
  const auto side_of = [&](std::size_t j) { return h[j].dot(h[1]) < 0 ? -1.0 : 1.0; };
  lanes::ClosedForm form{};
  form.closure = closure;
  for (std::size_t j = 0; j < kPoseJoints; ++j) copy_vector(h[j], form.h[j]);
  for (std::size_t j = 0; j < 5; ++j) copy_vector(way(j), form.p[j]);
  const Vector3d e1 = h[5].unitOrthogonal();
  copy_vector(e1, form.basis[0]);
  copy_vector(h[5].cross(e1), form.basis[1]);
  copy_vector(h[5], form.basis[2]);
  copy_vector(h[1].unitOrthogonal(), form.across);
  form.cross12 = h[0].dot(h[1]);
  form.cross23 = h[1].dot(h[2]);
  form.along45 = h[3].dot(h[4]);
  form.along56 = h[4].dot(h[5]);
  form.side3 = side_of(2);
  form.side4 = side_of(3);
  form.arm2 = p23.squaredNorm() + p34.squaredNorm();
  form.forearm = p34.norm();
  form.elbow = turned(p23, closure == Closure::three_parallel ? h[1] : h[2], p34);
  form.shoulder = turned(h[0], h[2], p34);
  form.wrist = turned(closure == Closure::three_parallel ? h[1] : h[3], h[4], h[5]);
  switch (closure) {
    case Closure::parallel_23:
      form.rest = h[1].dot(p12 + p23 + p34);
      break;
    case Closure::three_parallel:
      form.rest = h[1].dot(p12 + p23 + p34 + p45);
      break;
    case Closure::intersect_23:
      form.rest = p34.squaredNorm() - p12.squaredNorm();
      break;
    case Closure::parallel_12:
      form.rest = h[0].dot(p12 + p23);
      break;
    case Closure::sweep_4:
    case Closure::sweep_6:
      form.rest = h[1].dot(p12 + p23);
      break;
    case Closure::intersect_12:
    case Closure::loop:
      break;
  }
  return form;
}

}  // namespace

template <typename Write>
void ClosedFormChain::make_rows(const Pose& Y, const Write& write) const {
  const Pose target = reversed ? Y.inverse() : Y;
  const Eigen::Matrix3d columns = target.linear() * to_basis;
  const Vector3d w = (target.translation() - first - columns * tail) / unit;
  for (int i = 0; i < 9; ++i) write(i, columns(i % 3, i / 3));
  for (int i = 0; i < 3; ++i) write(9 + i, w[i]);
}

void ClosedFormChain::set_target(const Pose& Y, lanes::BranchPack& pack) const {
  make_rows(Y, [&](int row, double value) { std::fill_n(pack.target[row], lanes::kWidth, value); });
}

void ClosedFormChain::set_target(const Pose& Y, int lane, lanes::BranchPack& pack) const {
  make_rows(Y, [&](int row, double value) { pack.target[row][lane] = value; });
}

void ClosedFormChain::copy_joints(const double (&of_six)[6][lanes::kWidth], int lane,
                                  double* q) const {
  for (int i = 0; i < kPoseJoints; ++i) {
    if (joints[i] < dof) q[joints[i]] = of_six[i][lane];
  }
}

lanes::BranchPack all_branches() {
  lanes::BranchPack pack{};
  for (int lane = 0; lane < lanes::kWidth; ++lane) {
    for (int s = 0; s < 3; ++s) pack.sign[s][lane] = branch_sign(lane, s);
  }
  return pack;
}

void ClosedFormChain::use_limits(const ChainModel& model) {
  for (int i = 0; i < kPoseJoints; ++i) {
    const int j = joints[i];
    if (j >= dof || turns_freely(j)) {
      form.offset[i] = 0;
      form.middle[i] = 0;
      // A locked axis is held to what axes may be off.
      form.reach[i] = turns_freely(j) ? kPi : kStructureTolerance;
    } else {
      const bool ends = model.joints.type(j) != JointType::continuous;
      form.offset[i] = model.kernel.joints[static_cast<std::size_t>(j)].offset;
      form.middle[i] = ends ? 0.5 * (model.joints.lower[j] + model.joints.upper[j]) : 0;
      form.reach[i] = ends ? 0.5 * (model.joints.upper[j] - model.joints.lower[j]) : kPi;
    }
    const double middle = form.middle[i] + form.offset[i];
    const double reach = form.reach[i];
    form.arc[i] = {reach < kPi, std::cos(middle), std::sin(middle), std::cos(reach),
                   std::sin(reach)};
  }
  use_sums(model);
}

void ClosedFormChain::use_sums(const ChainModel& model) {
  const JointSpace& limits = model.joints;
  sums.reset();
  form.sums = nullptr;
  if (limits.sums.empty()) return;
  auto of = std::make_shared<lanes::SumForm>();
  for (const Limit& sum : limits.sums) {
    of->lower[of->rows] = sum.lower / sum.size;
    of->upper[of->rows++] = sum.upper / sum.size;
  }
  of->images = static_cast<int>(limits.images.size());
  for (int i = 0; i <= kPoseJoints; ++i) {
    const int j = i < kPoseJoints ? joints[i] : (form.is_held ? held : dof);
    if (j >= dof) continue;
    // What the held angle is more than its joint's value.
    const double offset =
        i < kPoseJoints ? 0 : model.kernel.joints[static_cast<std::size_t>(j)].offset;
    for (std::size_t r = 0; r < limits.sums.size(); ++r) {
      of->coefficient[r][i] = limits.sums[r].c[j] / limits.sums[r].size;
      of->lower[r] += of->coefficient[r][i] * offset;
      of->upper[r] += of->coefficient[r][i] * offset;
    }
    if (!limits.turns_in_sum(j)) continue;
    of->joint[of->turning++] = i;
    of->middle[i] = 0.5 * (limits.lower[j] + limits.upper[j]) + offset;
    of->reach[i] = 0.5 * (limits.upper[j] - limits.lower[j]);
    for (std::size_t k = 0; k < limits.images.size(); ++k) {
      of->turned[k][i] = kTwoPi * limits.images[k][j];
    }
  }
  sums = of;
  form.sums = sums.get();
}

bool ClosedFormChain::tells_inside(const JointSpace& limits) const {
  return std::none_of(limits.sums.begin(), limits.sums.end(), [&](const Limit& sum) {
    for (int j = 0; j < limits.dof(); ++j) {
      if (sum.c[j] != 0 && turns_freely(j)) return true;
    }
    return false;
  });
}

namespace {

/// How far the links reach, slides apart [m]: however long a slide is, an error means as much.
double reach_of_links(const ChainModel& model) {
  double reach = 0;
  for (const KernelJoint& joint : model.kernel.joints) reach += Vector3d(joint.p).norm();
  return reach + Vector3d(model.kernel.flange.p).norm();
}

/// What is looked for: that closes the form at once, or with a joint held before the six; or for an
/// angle of one of the six, but for a residual.
enum class Sought { closure, residual };

/// The last six axes, seen from one end.
std::optional<ClosedFormChain> look_from(const ChainModel& model, const CompletedAxes& completed,
                                         bool reversed, Sought sought, double tolerance) {
  ScrewAxes axes = reversed ? completed.axes.reversed() : completed.axes;
  ClosedFormChain chain;
  const int count = static_cast<int>(axes.h.size());
  const int before = count - kPoseJoints;
  const auto joint = [&](int i) { return reversed ? count - 1 - i : i; };
  const Vector3d held_axis = axes.h.front();
  const Vector3d held_point = axes.p.front();
  for (int i = before; i < count; ++i) {
    // Those from dof on complete the six, and turn.
    if (joint(i) >= model.dof) continue;
    if (model.kernel.joints[static_cast<std::size_t>(joint(i))].prismatic) return std::nullopt;
  }
  if (before > 0) {
    chain.held = joint(0);
    axes.h.erase(axes.h.begin());
    axes.p.erase(axes.p.begin());
  }
  AxisPattern pattern(std::move(axes), model.reach, tolerance);
  const bool has_residual = sought == Sought::residual;
  const auto closure = pattern.find_closure(has_residual);
  if (!closure) return std::nullopt;
  for (int i = 0; i < kPoseJoints; ++i) chain.joints[i] = joint(before + i);
  if (has_residual) {
    const bool is_4 = *closure == Closure::sweep_4;
    chain.held = chain.joints[is_4 ? 3 : 5];
    chain.deviation = pattern.deviation(is_4 ? 4 : 3);
  } else {
    chain.deviation = pattern.deviation();
  }
  chain.dof = model.dof;
  chain.free = completed.free;
  chain.reversed = reversed;
  chain.unit = reach_of_links(model);
  chain.form = make_form(*closure, pattern.axes(), chain.unit);
  Eigen::Matrix3d E;
  for (int k = 0; k < 3; ++k) E.col(k) = Vector3d(chain.form.basis[k]);
  chain.first = pattern.axes().p[0];
  chain.form.is_held = before > 0;
  copy_vector(held_axis, chain.form.held_axis);
  if (before > 0 && model.joints.is_slide(chain.held)) chain.form.held_slide = 1 / chain.unit;
  copy_vector((chain.first - held_point) / chain.unit, chain.form.held_from);
  chain.tail = E.transpose() * (pattern.axes().end.translation() - pattern.axes().p[5]);
  chain.to_basis = pattern.axes().end.linear().transpose() * E;
  return chain;
}

std::optional<ClosedFormChain> look_at(const ChainModel& model, const CompletedAxes& completed,
                                       Sought sought, double tolerance, bool is_full_pose = true) {
  for (const bool reversed : {false, true}) {
    auto chain = look_from(model, completed, reversed, sought, tolerance);
    if (chain && (!is_full_pose || finds_known_solutions(model, *chain))) return chain;
  }
  return std::nullopt;
}

/// Whether all joints turn, but for one of seven that may be held.
bool can_be_closed(const ChainModel& model) {
  const auto& joints = model.kernel.joints;
  return is_simple(model) &&
         std::count_if(joints.begin(), joints.end(), [](const KernelJoint& joint) {
           return joint.prismatic;
         }) <= (model.dof == kCurveJoints ? 1 : 0);
}

}  // namespace

std::optional<ClosedFormChain> find_closed_form(const ChainModel& model, const Task& task) {
  if (!can_be_closed(model)) return std::nullopt;
  for (const CompletedAxes& completed : complete_axes(model, task, kStructureTolerance)) {
    auto chain =
        look_at(model, completed, Sought::closure, kStructureTolerance, task.is_full_pose());
    if (chain) return chain;
  }
  const bool is_six = model.dof == kPoseJoints;
  if (!task.is_full_pose() || !(is_six || model.dof == kCurveJoints)) return std::nullopt;
  return look_at(model, {ScrewAxes::of(model)}, Sought::closure,
                 is_six ? kAlmostTolerance : kSweptTolerance);
}

std::optional<ClosedFormChain> find_residual(const ChainModel& model) {
  // With a lower rank solutions are no points, and residuals have no roots but for rounding.
  const bool is_six = model.dof == kPoseJoints && model.rank == kPoseJoints;
  if (!is_six || !can_be_closed(model)) return std::nullopt;
  const CompletedAxes axes{ScrewAxes::of(model)};
  auto chain = look_at(model, axes, Sought::residual, kStructureTolerance);
  if (!chain) chain = find_loop(model);
  return chain ? chain : look_at(model, axes, Sought::residual, kSweptTolerance);
}

ClosedForms ClosedForms::of(const ChainModel& model) {
  ClosedForms forms;
  forms.pose = find_closed_form(model);
  if (!forms.pose || forms.pose->is_almost()) forms.residual = find_residual(model);
  for (const Task& task : {Task::position_only(), Task::free_spin(Axis::x),
                           Task::free_spin(Axis::y), Task::free_spin(Axis::z)}) {
    if (const auto chain = find_closed_form(model, task)) forms.tasks.emplace_back(task, *chain);
  }
  return forms;
}

}  // namespace iksel
