// SPDX-License-Identifier: BSD-3-Clause
// The best of what a search collected, by what a request asks for: nearest, cheapest, or the first
// that the scene and the filter let through.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "goal/joint_move.hpp"
#include "goal/screen.hpp"
#include "search/collector.hpp"

namespace iksel {

/// Seeds where solutions come in families, which never end, and the best is wanted.
inline constexpr int kRedundantSeeds = 64;

class AnswerSelector {
 public:
  /// All must outlive this.
  AnswerSelector(const Goal& goal, const SolveRequest& request, const SolutionSet& found,
                 Screen& screen);

  /// Screens what was found since the last look. True if the best of all that passed
  /// is an answer.
  bool is_satisfied(const Collector& search);
  /// Whether the best is known only when all are.
  [[nodiscard]] bool wants_all() const { return ranks_ && !goal_.is_redundant(); }
  /// So many solutions spread over a self-motion lead to the best, where that is not the nearest to
  /// some configuration; else 0.
  [[nodiscard]] int spread() const {
    return ranks_ && goal_.is_redundant() && !nearest_to_ ? kRedundantSeeds : 0;
  }
  /// The best of what passed of a search; false if nothing did.
  bool select(const Collector& search, JointVector& q);
  /// Whether what was refused may have images that nobody was asked about: there are too many.
  [[nodiscard]] bool leaves_out() const { return leaves_out_; }
  /// Steps along self-motions so far.
  [[nodiscard]] int steps() const { return steps_; }

 private:
  /// Whether the nearest is wanted of a task that leaves axes free.
  [[nodiscard]] bool is_nearest_of_task() const {
    return nearest_to_ && goal_.tips() == nullptr && !goal_.is_full_pose();
  }
  /// Of a redundant goal, so many of the best are brought to a least cost.
  [[nodiscard]] std::size_t descents_of_redundant(const Collector& search) const;
  struct Ranked {
    double cost;
    std::size_t index;
    friend bool operator<(const Ranked& a, const Ranked& b) {
      return a.cost != b.cost ? a.cost < b.cost : a.index < b.index;
    }
  };

  /// Smaller is better; 0 where nothing is.
  [[nodiscard]] double cost_of(const JointVector& q) const;
  /// Screens what was found since the last time; all, if some were replaced.
  void screen_new();
  /// Goes from a solution along its self-motion to the least cost; q is the best before, and after,
  /// and `best` its cost.
  void descend_from(JointVector end, double& best, JointVector& q);
  /// As select, among the images whose cost is less than `best`. False if there is none, and q is
  /// what it was.
  bool select_image(double best, JointVector& q);

  const Goal& goal_;
  const SolveRequest& request_;
  /// Whether some answers are better than others.
  bool ranks_;
  const SolutionSet& found_;
  std::optional<NearestTo> nearest_to_;
  Screen& screen_;
  /// What the scene lets through, and what of it the filter keeps.
  std::array<bool, SolutionSet::kMost> free_{};
  std::array<bool, SolutionSet::kMost> kept_{};
  std::size_t asked_ = 0;
  int replacements_ = 0;  ///< of solutions that were screened
  std::size_t first_kept_ = 0;
  int steps_ = 0;
  bool leaves_out_ = false;
};

}  // namespace iksel
