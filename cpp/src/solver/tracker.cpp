// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/tracker.hpp"

#include <algorithm>
#include <cmath>

#include "base/message_text.hpp"
#include "base/pose_check.hpp"
#include "goal/objective_cost.hpp"
#include "iksel/error.hpp"
#include "iksel/pose.hpp"
#include "kinematics/tips_model.hpp"
#include "refine/closest_descent.hpp"
#include "refine/self_motion.hpp"
#include "search/closest.hpp"
#include "solver/solver_impl.hpp"

namespace iksel {

namespace {

/// From q a little towards `to` [rad or m]: an arm that was stretched out bends to that side.
JointVector lean(const JointVector& q, const JointVector& to) {
  constexpr double kLean = 0.02;
  const JointVector way = to - q;
  const double longest = way.cwiseAbs().maxCoeff();
  return longest > kLean ? JointVector(q + kLean / longest * way) : to;
}

/// How much of a move no joint is too slow for.
double part_in_time(const JointVector& move, const JointVector& longest) {
  double part = 1;
  for (Eigen::Index j = 0; j < move.size(); ++j) {
    // A joint that stands still has no need of time.
    if (part * std::abs(move[j]) > longest[j]) part = longest[j] / std::abs(move[j]);
  }
  return part;
}

/// How long it would take from q to the goal with these joint velocities, to first order [s].
template <typename Linear>
double time_to(const Goal& goal, const JointVector& q, const JointVector& velocity) {
  Linear at;
  goal.linearize(q, /*exact=*/true, at);
  at.to_unit(goal.unit());
  const typename Linear::Vector twist = at.J * velocity;
  const double speed2 = twist.squaredNorm();
  return speed2 > 0 ? at.missing.dot(twist) / speed2 : 0;
}

/// How far a pose is from another, by the largest of the weights of position and of rotation.
double distance(const Pose& a, const Pose& b, const Vector6& weights) {
  const double position = (a.translation() - b.translation()).norm();
  const double rotation = Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
  return std::hypot(weights.head<3>().maxCoeff() * position,
                    weights.tail<3>().maxCoeff() * rotation);
}

}  // namespace

Tracker::Tracker(const Solver& solver, const JointVector& start,
                 const std::optional<PoseWeights>& closest, const TargetCriteria& criteria,
                 const Objective& objective, const TrackerState& state)
    : solver_(solver),
      q_(start),
      closest_(closest),
      criteria_(criteria),
      objective_(objective),
      state_(state) {
  if (!state_.reached) state_.reached = start;
  const Robot& robot = solver.robot();
  if (state_.velocity.size() == 0) state_.velocity = JointVector::Zero(robot.dof());
  check_joints(state_.velocity, robot.dof(), "velocity");
  for (JointVector* q : {&q_, &*state_.reached}) {
    const char* name = q == &q_ ? "start" : "reached";
    check_joints(*q, robot.dof(), name);
    solver.impl_->angles.check(*q, name);
  }
  if (closest) closest->validate();
  criteria.validate(robot.tips());
  objective.validate(robot.dof());
  // Throws if tips follow one another in a circle.
  const std::vector<Pose> anywhere(static_cast<std::size_t>(robot.tips()), Pose::Identity());
  solver.impl_->with_goal(anywhere.data(), criteria, nullptr, [](const Goal&) {});
  if (!state.last.empty()) solver.impl_->check_tips(state.last.size());
  for (const StoredPose& last : state.last) check_pose(Pose(last));
  if (!(state.speed >= 0) || !std::isfinite(state.speed)) {
    throw InvalidArgumentError("speed: " + number_text(state.speed) + " is not 0 or more");
  }
}

Pose Tracker::seen(int tip, const JointVector& q) const {
  const Robot& robot = solver_.robot();
  const auto pose = [&](int i) {
    return Pose(robot.chain(i).model().fk(picked(q, robot.joints_of(i)).data()));
  };
  const int frame =
      criteria_.in_frame_of.empty() ? -1 : criteria_.in_frame_of[static_cast<std::size_t>(tip)];
  return frame < 0 ? pose(tip) : Pose(pose(frame).inverse() * pose(tip));
}

Vector6 Tracker::weights_of(int tip) const {
  const Vector6 weights = to_vector(*closest_, solver_.impl_->rotation_weight());
  return solver_.impl_->task_of(criteria_, tip).without_free(weights);
}

double Tracker::tool_way(const JointVector& from, const JointVector& to) const {
  double most = 0;
  for (int i = 0; i < solver_.robot().tips(); ++i) {
    most = std::max(most, distance(seen(i, from), seen(i, to), weights_of(i)));
  }
  return most;
}

double Tracker::part_for_tool(const JointVector& move, double part, double dt) const {
  if (!closest_ || !(state_.speed > 0)) return part;
  const double most = kFastestTool * state_.speed * dt;
  while (part > 0) {
    const double way = tool_way(q_, q_ + part * move);
    if (way <= most) break;
    part *= std::max(0.9 * most / way, 1e-3);
  }
  return part;
}

void Tracker::stream_on(const Pose* targets, double dt) {
  const int tips = solver_.robot().tips();
  const bool is_first = state_.last.empty();
  if (is_first) state_.last.resize(static_cast<std::size_t>(tips));
  double way = 0;
  for (int i = 0; i < tips; ++i) {
    StoredPose& last = state_.last[static_cast<std::size_t>(i)];
    if (is_first) last = seen(i, q_);
    way = std::max(way, distance(Pose(last), targets[i], weights_of(i)));
    last = targets[i];
  }
  if (way > 0) state_.speed = way / dt;
}

Result Tracker::track(const Pose& T_base_tip, double dt, const Scene* scene) {
  solver_.impl_->check_tips(1);
  Pose nearest;
  return follow(&to_rigid(T_base_tip, nearest), dt, scene);
}

Result Tracker::track(const std::vector<Pose>& T_base_tip, double dt, const Scene* scene) {
  return follow(solver_.impl_->check_targets(T_base_tip).data(), dt, scene);
}

Result Tracker::follow(const Pose* targets, double dt, const Scene* scene) {
  if (!(dt > 0)) {
    throw InvalidArgumentError("dt: " + number_text(dt) + " s is not above 0");
  }
  if (scene != nullptr) scene->check_fits(solver_.robot());
  if (closest_) stream_on(targets, dt);
  const JointVector before = q_;
  Result result = solver_.impl_->with_goal(targets, criteria_, scene,
                                           [&](const Goal& goal) { return approach(goal, dt); });
  state_.velocity = (q_ - before) / dt;
  return result;
}

bool Tracker::continue_to(const Goal& goal, double dt, JointVector& q, int& steps) const {
  const JointVector from = q;
  const bool is_reached = converge(goal, kStepsToNext, q, steps);
  // Redundant arms would go on along their self-motions; one that is there has no way to go.
  if (state_.is_at_edge || goal.is_redundant() || q == from) return is_reached;
  // No farther than the pose has moved, whatever the time: it may have stopped.
  const double time = goal.tips() == nullptr
                          ? time_to<Goal::Linear>(goal, from, state_.velocity)
                          : time_to<TipsGoal::Linear>(goal, from, state_.velocity);
  const JointVector move = std::clamp(time, -dt, dt) * state_.velocity;
  const double length = move.norm();
  const JointVector ahead = from + move;
  // Where there is no other, none that would be a turn back, or a jump.
  const double aside = is_reached ? (q - ahead).norm() : length;
  // What is farther from straight on may be the other of two. Of 900 motions of random arms 2 end
  // elsewhere, with 0.1 it were 6 (as in test_tracker_laws.py).
  if (!(aside > 0.01 * length)) return is_reached;
  JointVector straight = solver_.robot().all().joints.clamp(ahead);
  if (!converge(goal, kStepsToNext, straight, steps)) return is_reached;
  if (!((straight - ahead).norm() < aside)) return is_reached;
  q = straight;
  return true;
}

void Tracker::improve(const Goal& goal, const JointVector& longest, double dt, JointVector& end,
                      int& steps) const {
  const RobotModel& model = solver_.robot().all();
  const ObjectiveCost cost(model, objective_);
  JointVector better = end;
  steps += descend_self_motion(goal, JointCost(cost), /*most=*/1, better);
  const JointVector way = better - end;
  const JointVector room = longest - (end - q_).cwiseAbs();
  const double part = std::min(dt / kObjectiveTime, part_in_time(way, room));
  // The way is straight, the self-motion is not.
  for (const double share : {1.0, 0.5, 0.25, 0.125}) {
    JointVector next = end + share * part * way;
    if (!converge(goal, kStepsToNext, next, steps) || part_in_time(next - q_, longest) < 1 ||
        !(cost.value(next) < cost.value(end))) {
      continue;
    }
    end = next;
    return;
  }
}

double Tracker::part_of_way(const Goal& goal, double dt, JointVector& end, int& steps) const {
  const JointVector longest = goal.joints().longest_moves(dt);
  double part = part_in_time(end - q_, longest);
  if (part < 1 && goal.is_redundant()) {
    // Along the self-motion to where the joint that is latest is least so.
    JointVector other = end;
    steps += descend_in_time(goal, longest, q_, other);
    const double of_other = part_in_time(other - q_, longest);
    if (of_other > part) end = other;
    part = std::max(part, of_other);
  }
  if (part == 1 && goal.is_redundant() && objective_.is_set()) {
    improve(goal, longest, dt, end, steps);
  }
  return part_for_tool(end - q_, part, dt);
}

double Tracker::come_closer(const Goal& goal, const JointVector& from, double dt, double part,
                            JointVector& end, int& steps) const {
  const Remainder remainder(goal, to_vector(*closest_, solver_.impl_->rotation_weight()));
  const JointVector longest = goal.joints().longest_moves(dt);
  const JointVector inside = goal.joints().clamp(q_);
  // The way back inside the limits may be up.
  const bool is_inside = (q_ - inside).cwiseAbs().maxCoeff() < kRounding;
  const double here = is_inside ? remainder.value(q_) : kInfinity;
  // By more than a part of it, or the arm rests: rounding is 1e-16 of it, and a step of 1 mm
  // towards a target 1e5 m away 2e-8.
  const double less = (1 - 1e-12) * here;
  const auto falls = [&] {
    // With one, ur5e stays where its nearest place has vanished (test_closest.cpp).
    for (int halving = 0; halving < 5; ++halving, part /= 2) {
      if (part > 0 && remainder.value(q_ + part * (end - q_)) < less) return true;
    }
    return false;
  };
  const auto descends = [&](const JointVector& start, int most, double longest_part) {
    end = start;
    descend_to_closest(remainder, most, end, steps);
    part = std::min(longest_part, part_in_time(end - q_, longest));
    part = part_for_tool(end - q_, part, dt);
    return falls();
  };
  // The straight way to where a descent ends may rise, but its first step falls where it begins:
  // half of that, for it is not the end.
  if (falls() || descends(from, kStepsToNext, 1) ||
      (from != inside && descends(inside, kStepsToNext, 1)) || descends(inside, 1, 0.5)) {
    return part;
  }
  end = q_;
  return 1;
}

Result Tracker::approach(const Goal& goal, double dt) {
  Result result;
  const JointVector from = goal.joints().clamp(state_.is_at_edge ? lean(q_, reached()) : q_);
  JointVector end = from;
  result.attempts = 1;
  bool is_reached = continue_to(goal, dt, end, result.iterations);
  if (!is_reached && !closest_) return result;
  double part = is_reached ? part_of_way(goal, dt, end, result.iterations) : 0;
  if (closest_ && part < 1) {
    part = come_closer(goal, from, dt, part, end, result.iterations);
    is_reached = false;
  }
  const JointVector move = end - q_;
  if (part < 1) {
    result.status = Status::too_fast;
    end = q_ + part * move;
  } else if (!is_reached) {
    set_closest(goal, end, result);
  } else if (!goal.check(end, result)) {
    return result;
  }
  if (!goal.is_free(end)) {
    Result refused;
    refused.status = Status::in_collision;
    refused.attempts = 1;
    refused.iterations = result.iterations;
    return refused;
  }
  q_ = end;
  state_.is_at_edge = result.status == Status::closest;
  if (result.success()) state_.reached = q_;
  result.move = part * move.norm();
  return result;
}

}  // namespace iksel
