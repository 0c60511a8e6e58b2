// SPDX-License-Identifier: BSD-3-Clause
// Joints in a row that turn about one axis: they may share what they turn as they like, and all of
// it may be whole turns more. Moves along a self-motion do not lead from one to the other where
// limits lie between.
#pragma once

#include <array>
#include <vector>

#include "goal/joint_move.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {

class CoaxialJoints {
 public:
  explicit CoaxialJoints(const ChainModel& model);

  [[nodiscard]] bool has_any() const { return !groups_.empty(); }
  /// Brings q to the configuration of its pose nearest to `near` to which such joints alone lead.
  void bring_nearest(const JointVector& near, const JointMove& move, JointVector& q) const;

 private:
  struct Group {
    int first, count;
    std::array<double, kMaxDof> side;  ///< 1, or -1 of those that turn the other way round

    [[nodiscard]] int last() const { return first + count - 1; }
    [[nodiscard]] double side_of(int j) const { return side[static_cast<std::size_t>(j - first)]; }
  };

  /// Lets a group turn by `sum` altogether, with the least move from `near`.
  void share(const Group& group, double sum, const JointVector& near, const JointMove& move,
             JointVector& q) const;

  const JointSpace& joints_;
  std::vector<Group> groups_;
};

}  // namespace iksel
