// SPDX-License-Identifier: BSD-3-Clause
// The rows of a batch that are poses.
#pragma once

#include <cstddef>
#include <vector>

#include "base/pose_check.hpp"
#include "iksel/request.hpp"

namespace iksel {

/// The targets of a batch that are poses, numbered without gaps. As long as all are rigid to
/// rounding, nothing is copied.
template <typename PoseAt>
class BatchTargets {
 public:
  /// `pose_at(row)` for rows 0 to count - 1. Throws about the first that is no pose, if asked to.
  BatchTargets(std::size_t count, const PoseAt& pose_at, OnInvalidPose on_invalid)
      : pose_at_(pose_at), size_(count) {
    std::size_t row = 0;
    while (row < count && rigidity_of(pose_at(row)) == Rigidity::exact) ++row;
    if (row == count) return;
    copied_ = true;
    own_.reserve(count);
    rows_.reserve(count);
    for (std::size_t i = 0; i < count; ++i) take(i, on_invalid);
    size_ = own_.size();
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  /// Rows that have no pose.
  [[nodiscard]] const std::vector<std::size_t>& invalid_rows() const { return invalid_; }
  [[nodiscard]] std::size_t row_of(std::size_t i) const { return copied_ ? rows_[i] : i; }
  [[nodiscard]] decltype(auto) operator()(std::size_t i) const {
    return copied_ ? own_[i] : pose_at_(i);
  }

 private:
  void take(std::size_t row, OnInvalidPose on_invalid) {
    const Pose& pose = pose_at_(row);
    const Rigidity rigidity = rigidity_of(pose);
    if (rigidity == Rigidity::none) {
      if (on_invalid == OnInvalidPose::raise) {
        throw_not_rigid(pose, "poses", static_cast<std::ptrdiff_t>(row));
      }
      invalid_.push_back(row);
      return;
    }
    own_.push_back(pose);
    rows_.push_back(row);
    if (rigidity == Rigidity::close) make_rigid(own_.back());
  }

  const PoseAt& pose_at_;
  std::size_t size_;
  bool copied_ = false;
  std::vector<Pose> own_;
  std::vector<std::size_t> rows_;
  std::vector<std::size_t> invalid_;
};

}  // namespace iksel
