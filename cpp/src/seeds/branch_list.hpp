// SPDX-License-Identifier: BSD-3-Clause
// Solutions of six joints as a list: in closed form (enumeration.hpp), or roots of a residual
// (root_sweep.hpp). They are seeds that are there already.
#pragma once

#include <array>
#include <cstddef>

#include "base/constants.hpp"
#include "seeds/row_seeds.hpp"

namespace iksel {

class BranchList {
 public:
  virtual ~BranchList() = default;
  /// Finds the solutions of a full pose that lie inside the limits, or so near to them that it
  /// cannot be told. Y as in reduction.hpp. `wants_all`: else any of them will do.
  virtual void find(const Pose& Y, bool wants_all) = 0;
  [[nodiscard]] int size() const { return size_; }
  /// Inside the limits, or nearly [rad].
  [[nodiscard]] const double* q(int i) const { return q_[static_cast<std::size_t>(i)].data(); }
  /// Whether they reach the goal without being refined, as a rule.
  [[nodiscard]] bool are_answers() const { return are_answers_; }
  /// Whether there are no solutions but these. Not where the arm is so close to a singularity that
  /// what the tolerances allow could make a difference.
  [[nodiscard]] bool is_certain() const { return certain_; }
  /// The same but for those so close to a limit, and away from singularities: such a one is a
  /// solution, or there is none beside it.
  [[nodiscard]] bool is_certain_but_for_limits() const { return certain_but_for_limits_; }
  /// Whether each solution is near to one of these, if they are not certain either.
  [[nodiscard]] bool has_all() const { return has_all_; }
  /// Whether each stands for many solutions.
  [[nodiscard]] bool has_families() const { return has_families_; }

 protected:
  using Joints = std::array<double, kPoseJoints>;
  static constexpr int kRoom = 96;

  /// Where the next one is written to.
  [[nodiscard]] Joints& next() { return q_[static_cast<std::size_t>(size_)]; }

  std::array<Joints, kRoom> q_{};
  int size_ = 0;
  bool are_answers_ = false;
  bool has_all_ = false;
  bool has_families_ = false;
  bool certain_ = false;
  bool certain_but_for_limits_ = false;
};

/// These as a source of seeds.
class EnumeratedSeeds : public RowSeeds {
 public:
  EnumeratedSeeds(BranchList& branches, const Pose& Y, bool wants_all, Work& work)
      : RowSeeds(work, &Work::take), branches_(branches), Y_(Y), wants_all_(wants_all) {}

  bool next_stage() {
    if (done_ || !work_.has_left()) return false;
    done_ = true;
    branches_.find(Y_, wants_all_);
    before_ = work_.arrivals;
    give(branches_.q(0), static_cast<std::size_t>(branches_.size()), kPoseJoints,
         branches_.are_answers());
    work_.lap(&StageTimes::query);
    return true;
  }

  /// Whether each branch was tried.
  [[nodiscard]] bool was_tried() const { return done_ && is_through(); }
  /// Whether each led to the goal, if all were tried last.
  [[nodiscard]] bool has_arrived() const { return work_.arrivals - before_ == branches_.size(); }

 private:
  BranchList& branches_;
  const Pose& Y_;
  bool wants_all_;
  bool done_ = false;
  int before_ = 0;  ///< arrivals
};

}  // namespace iksel
