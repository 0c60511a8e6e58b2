// SPDX-License-Identifier: BSD-3-Clause
// Seeds in the order of their ranks, re-selected after each that failed (paper, section III-D).
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "iksel/options.hpp"
#include "iksel/types.hpp"

namespace iksel {

/// A seed with its rank; the lowest comes first.
struct Candidate {
  double score;         ///< squared norm of Eq. (2) or Eq. (5)
  std::uint32_t index;  ///< of the sample, or of the seed among those given
  std::uint32_t place;  ///< among the neighbours
  bool leaves_limits;   ///< q + J^+ e is outside (only asked if limit_aware)

  friend bool operator<(const Candidate& a, const Candidate& b) {
    if (a.leaves_limits != b.leaves_limits) return b.leaves_limits;
    return a.score != b.score ? a.score < b.score : a.index < b.index;
  }
};

class CandidateQueue {
 public:
  /// Memory is taken here for that many, none later for as many.
  CandidateQueue(int dof, const Paper& scheme, std::size_t room) : dof_(dof), scheme_(scheme) {
    candidates_.reserve(room);
  }

  void clear(std::size_t room) {
    candidates_.clear();
    candidates_.reserve(room);
    kept_ = taken_ = 0;
  }
  void push(const Candidate& candidate) { candidates_.push_back(candidate); }
  /// Puts the best `most` in order; the others are dropped.
  void sort(std::size_t most) {
    kept_ = std::min(most, candidates_.size());
    std::partial_sort(candidates_.begin(), at(kept_), candidates_.end());
  }
  /// The candidates in order, those that were dropped too. To be asked before any is taken.
  const std::vector<Candidate>& in_order() {
    std::sort(at(kept_), candidates_.end());
    return candidates_;
  }
  /// How many were not dropped.
  [[nodiscard]] std::size_t kept() const { return kept_; }

  /// Joint values of the next seed, which `q_of(candidate)` gives; null if there is none left. Only
  /// the scheme's `candidates` best are re-selected; what is kept beyond follows by rank.
  template <typename QOf>
  const double* next(const QOf& q_of) {
    if (taken_ >= kept_) return nullptr;
    if (taken_ > 0 && scheme_.reselection == Reselection::none) return nullptr;
    if (taken_ > 0 && scheme_.reselection == Reselection::farthest) bring_farthest_forward(q_of);
    return take_first(q_of);
  }
  /// The one that was taken last.
  [[nodiscard]] const Candidate& last() const { return candidates_[taken_ - 1]; }

  /// Takes none as taken so far.
  void restart() {
    std::sort(candidates_.begin(), at(kept_));
    taken_ = 0;
  }
  /// Takes a candidate out of turn; false if it was taken already, or is none that was kept.
  template <typename QOf>
  bool take(std::size_t index, const QOf& q_of) {
    const auto found = std::find_if(at(taken_), at(kept_),
                                    [&](const Candidate& each) { return each.index == index; });
    if (found == at(kept_)) return false;
    std::rotate(at(taken_), found, found + 1);
    take_first(q_of);
    return true;
  }

 private:
  using Iterator = std::vector<Candidate>::iterator;

  Iterator at(std::size_t i) { return candidates_.begin() + static_cast<std::ptrdiff_t>(i); }

  /// The first of those not taken yet.
  template <typename QOf>
  const double* take_first(const QOf& q_of) {
    const double* q = q_of(candidates_[taken_]);
    if (taken_ == 0) std::fill_n(sum_of_taken_, dof_, 0.0);
    for (int j = 0; j < dof_; ++j) sum_of_taken_[j] += q[j];
    ++taken_;
    return q;
  }

  /// Of those not tried yet, the one with the largest |m q - sum of the m failed q|; the others
  /// keep their order.
  template <typename QOf>
  void bring_farthest_forward(const QOf& q_of) {
    const std::size_t end = std::min(kept_, static_cast<std::size_t>(scheme_.candidates));
    if (taken_ >= end) return;
    const auto m = static_cast<double>(taken_);
    std::size_t best = taken_;
    double best_distance = -1;
    for (std::size_t i = taken_; i < end; ++i) {
      const double* q = q_of(candidates_[i]);
      double distance = 0;
      for (int j = 0; j < dof_; ++j) {
        const double d = m * q[j] - sum_of_taken_[j];
        distance += d * d;
      }
      if (distance > best_distance) {
        best_distance = distance;
        best = i;
      }
    }
    std::rotate(at(taken_), at(best), at(best) + 1);
  }

  int dof_;
  const Paper& scheme_;
  std::vector<Candidate> candidates_;
  std::size_t kept_ = 0;
  std::size_t taken_ = 0;
  double sum_of_taken_[kMaxDof];
};

}  // namespace iksel
