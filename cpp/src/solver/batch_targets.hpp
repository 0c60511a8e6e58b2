// SPDX-License-Identifier: BSD-3-Clause
// The rows of a batch whose targets are poses, one for each tip.
#pragma once

#include <cstddef>
#include <vector>

#include "base/pose_check.hpp"
#include "iksel/request.hpp"

namespace iksel {

/// The targets of a batch that are poses, numbered without gaps. Those of one tip are not copied as
/// long as all are rigid to rounding.
template <typename PoseAt>
class BatchTargets {
 public:
  /// `pose_at(i)`: of all tips in row 0, in row 1, ... to count - 1. Throws about the first that is
  /// no pose, if asked to.
  BatchTargets(std::size_t count, int tips, const PoseAt& pose_at, OnInvalidPose on_invalid)
      : pose_at_(pose_at), tips_(static_cast<std::size_t>(tips)), size_(count) {
    std::size_t row = 0;
    while (tips_ == 1 && row < count && rigidity_of(pose_at(row)) == Rigidity::exact) ++row;
    if (row == count) return;
    copied_ = true;
    own_.reserve(count * tips_);
    rows_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) take(i, on_invalid);
    size_ = rows_.size();
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Rows that have no pose.
  [[nodiscard]] const std::vector<std::size_t>& invalid_rows() const { return invalid_; }
  [[nodiscard]] std::size_t row_of(std::size_t i) const { return copied_ ? rows_[i] : i; }
  /// Of one tip.
  [[nodiscard]] decltype(auto) operator()(std::size_t i) const {
    return copied_ ? own_[i] : pose_at_(i);
  }
  /// Of several: one for each.
  [[nodiscard]] const Pose* of_tips(std::size_t i) const { return &own_[i * tips_]; }

 private:
  void take(std::size_t row, OnInvalidPose on_invalid) {
    for (std::size_t i = row * tips_; i < (row + 1) * tips_; ++i) {
      own_.push_back(pose_at_(i));
      const Rigidity rigidity = rigidity_of(own_.back());
      if (rigidity == Rigidity::close) make_rigid(own_.back());
      if (rigidity != Rigidity::none) continue;
      if (on_invalid == OnInvalidPose::raise) {
        throw_not_rigid(own_.back(), "poses", static_cast<std::ptrdiff_t>(i));
      }
      own_.resize(rows_.size() * tips_);
      invalid_.push_back(row);
      return;
    }
    rows_.push_back(row);
  }

  const PoseAt& pose_at_;
  std::size_t tips_;
  std::size_t size_;
  bool copied_ = false;
  std::vector<Pose> own_;
  std::vector<std::size_t> rows_;
  std::vector<std::size_t> invalid_;
};

}  // namespace iksel
