// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/branch_trials.hpp"

#include <algorithm>
#include <bitset>
#include <cmath>

#include "base/constants.hpp"
#include "base/random.hpp"
#include "database/key.hpp"
#include "seeds/swept_branches.hpp"

namespace iksel {
namespace {

constexpr int kMostLevels = 8;
/// Examples of a cell in the mean, and at most.
constexpr std::size_t kPerCell = 12;
constexpr std::size_t kMostExamples = 32;
constexpr std::size_t kMostTrials = 6;

using Solved = std::bitset<kMostExamples>;

/// The branch that has the joint values q at their value of the held joint; -1 if none does.
int branch_at(SweptBranches& branches, const JointVector& q) {
  branches.solve_all(q[branches.joint()]);
  JointVector found(q.size());
  for (int lane = 0; lane < lanes::kWidth; ++lane) {
    if (branches.off(lane) > 0) continue;
    branches.copy_joints(lane, found.data());
    if ((found - q).cwiseAbs().maxCoeff() < kSameAnswer) return lane;
  }
  return -1;
}

}  // namespace

struct BranchTrials::Example {
  std::size_t cell;
  Pose Y;
  double turn;
  BranchTrial own;
};

BranchTrials::BranchTrials(const ChainModel& model, const ClosedFormChain& chain,
                           const DatabaseData& data, const TaskSpace& task,
                           const lanes::LaneKernels& kernels)
    : data_(data), held_(chain.held), slides_(chain.form.held_slide != 0), first_{0} {
  if (held_ < 0) {
    for (int branch = 0; branch < lanes::kWidth; ++branch) trials_.push_back({branch, 0});
    first_.push_back(trials_.size());
    return;
  }
  levels_ = std::min(data.leaves.depth(), kMostLevels);
  const std::vector<Example> examples = make_examples(model, chain, task, kernels);
  const TrialForm form(model, chain, kernels);
  const std::size_t cells = std::size_t{1} << static_cast<unsigned>(levels_);
  std::size_t next = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::size_t begin = next;
    while (next < examples.size() && examples[next].cell == cell) ++next;
    add_cell(form, examples.data() + begin, std::min(next - begin, kMostExamples));
    first_.push_back(trials_.size());
  }
}

std::vector<BranchTrials::Example> BranchTrials::make_examples(
    const ChainModel& model, const ClosedFormChain& chain, const TaskSpace& task,
    const lanes::LaneKernels& kernels) const {
  SweptBranches branches(model, chain, kernels);
  const Pose base_inverse = to_pose(model.kernel.base).inverse();
  const Pose flange_inverse = to_pose(model.kernel.flange).inverse();
  Random random(1);
  std::vector<Example> examples;
  for (std::size_t i = 0; i < kPerCell << static_cast<unsigned>(levels_); ++i) {
    JointVector q = model.joints.sample(random);
    const Pose target = to_pose(model.fk_frame(q.data()));
    const Goal goal(model, task, target);
    Example example;
    example.Y = base_inverse * goal.tip_target() * flange_inverse;
    branches.set_target(example.Y);
    const int branch = branch_at(branches, q);
    if (branch < 0) continue;
    branches.copy_joints(branch, q.data());
    if (!goal.is_solution(model.joints.clamp(q))) continue;
    example.cell = cell(example.Y);
    example.turn = turn(example.Y);
    example.own = {branch, q[held_] - example.turn};
    examples.push_back(example);
  }
  std::stable_sort(examples.begin(), examples.end(),
                   [](const Example& a, const Example& b) { return a.cell < b.cell; });
  return examples;
}

void BranchTrials::add_cell(const TrialForm& form, const Example* examples, std::size_t count) {
  // Which examples each one's own branch solves.
  std::vector<Solved> solves(count);
  lanes::BranchPack pack{};
  for (std::size_t i = 0; i < count; ++i) {
    form.chain.set_target(examples[i].Y, pack);
    for (std::size_t first = 0; first < count; first += lanes::kWidth) {
      const std::size_t n = std::min<std::size_t>(lanes::kWidth, count - first);
      for (std::size_t lane = 0; lane < n; ++lane) {
        const BranchTrial& trial = examples[first + lane].own;
        form.set_trial(trial, examples[i].turn, static_cast<int>(lane), pack);
      }
      form.kernels.find_branches(form.chain.form, pack);
      for (std::size_t lane = 0; lane < n; ++lane) {
        solves[first + lane][i] = form.is_inside(pack, static_cast<int>(lane));
      }
    }
  }
  Solved left;
  for (std::size_t i = 0; i < count; ++i) left.set(i);
  for (std::size_t k = 0; k < kMostTrials && left.any(); ++k) {
    const auto fewer = [&](const Solved& a, const Solved& b) {
      return (a & left).count() < (b & left).count();
    };
    const auto best = std::max_element(solves.begin(), solves.end(), fewer);
    trials_.push_back(examples[best - solves.begin()].own);
    if ((*best & left).none()) break;
    left &= ~*best;
  }
}

BranchTrials::Range BranchTrials::of(const Pose& Y) const {
  const std::size_t at = held_ < 0 ? 0 : cell(Y);
  return {trials_.data() + first_[at], trials_.data() + first_[at + 1]};
}

double BranchTrials::turn(const Pose& Y) const {
  if (held_ < 0) return 0;
  const Eigen::Vector3d c = Y.translation();
  if (slides_) return held_ == 0 ? c[2] : Y.linear().col(2).dot(c);
  if (held_ == 0) return std::atan2(c[1], c[0]);
  const Eigen::Matrix3d R = Y.linear();
  return -std::atan2(R.col(1).dot(c), R.col(0).dot(c));
}

std::size_t BranchTrials::cell(const Pose& Y) const {
  double key[kMaxKeyDimension];
  data_.reduction->make_key(Y, key);
  return data_.leaves.descend(key, levels_);
}

TrialForm::TrialForm(const ChainModel& model, const ClosedFormChain& chain_in,
                     const lanes::LaneKernels& kernels_in)
    : chain(chain_in), kernels(kernels_in) {
  chain.use_limits(model);
  if (chain.held < 0) return;
  lower_ = model.joints.sample_lower(chain.held);
  upper_ = model.joints.sample_upper(chain.held);
  offset_ = model.kernel.joints[static_cast<std::size_t>(chain.held)].offset;
  slides_ = model.joints.is_slide(chain.held);
}

void TrialForm::set_trial(const BranchTrial& trial, double turn, int lane,
                          lanes::BranchPack& pack) const {
  for (int s = 0; s < 3; ++s) pack.sign[s][lane] = branch_sign(trial.branch, s);
  if (chain.held < 0) return;
  double value = trial.held + turn;
  if (slides_) {
    value = std::min(std::max(value, lower_), upper_);
  } else {
    if (value < lower_) value += kTwoPi;
    if (value > upper_) value -= kTwoPi;
  }
  pack.held[lane] = value + offset_;
}

bool TrialForm::is_inside(const lanes::BranchPack& pack, int lane) const {
  const double value = held(pack, lane);
  return pack.least[lane] >= 0 && pack.beyond[lane] <= 0 && value >= lower_ && value <= upper_;
}

}  // namespace iksel
