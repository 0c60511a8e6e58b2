// SPDX-License-Identifier: BSD-3-Clause
// What refuses answers: a scene, unless a second opinion differs, and a filter, which is asked
// about what these let through.
#pragma once

#include <algorithm>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "iksel/request.hpp"
#include "iksel/result.hpp"

namespace iksel {

/// Whether answers may be refused.
inline bool screens_answers(const AnswerCriteria& criteria) {
  return criteria.scene || static_cast<bool>(criteria.filter);
}

/// The filter for several threads, which ask one after the other; both must outlive it.
inline Filter in_turn(const Filter& filter, std::mutex& turn) {
  if (!filter) return {};
  return [&](const double* q, std::size_t count, bool* keep) {
    const std::lock_guard<std::mutex> held(turn);
    filter(q, count, keep);
  };
}

/// The same of all that a request has.
inline SolveRequest in_turn(const SolveRequest& request, std::mutex& turn) {
  SolveRequest locked = request;
  locked.filter = in_turn(request.filter, turn);
  locked.exact = in_turn(request.exact, turn);
  return locked;
}

/// The joint values `q` of all, one after the other.
template <typename Each>
std::vector<double> joint_values(const std::vector<Each>& all) {
  std::vector<double> q;
  for (const Each& each : all) q.insert(q.end(), each.q.begin(), each.q.end());
  return q;
}

class Screen {
 public:
  /// `criteria` must outlive this.
  Screen(const AnswerCriteria& criteria, int dof)
      : scene_(criteria.scene),
        exact_(criteria.exact),
        filter_(criteria.filter),
        dof_(static_cast<std::size_t>(dof)) {}

  [[nodiscard]] bool is_set() const { return scene_ || static_cast<bool>(filter_); }

  /// Which of `count` configurations the scene lets through.
  void find_free(const double* q, std::size_t count, bool* free) const {
    if (scene_) {
      scene_->find_free(q, count, free);
      // About what is free by the scene's spheres there is no doubt.
      if (exact_) ask(exact_, q, count, false, free);
    } else {
      std::fill_n(free, count, true);
    }
  }
  /// Asks the filter about those that are still kept.
  void ask_filter(const double* q, std::size_t count, bool* keep) {
    if (!filter_) return;
    const auto kept = std::count(keep, keep + count, true);
    ask(filter_, q, count, true, keep);
    filter_refused_ = filter_refused_ || std::count(keep, keep + count, true) < kept;
  }
  void apply(const double* q, std::size_t count, bool* keep) {
    find_free(q, count, keep);
    ask_filter(q, count, keep);
  }
  /// Leaves what the filter lets through, and with `by_scene` the scene too.
  template <typename Each>
  void keep_passed(std::vector<Each>& all, bool by_scene) {
    if (all.empty() || !(filter_ || (by_scene && scene_))) return;
    const std::vector<double> q = joint_values(all);
    const std::unique_ptr<bool[]> keep(new bool[all.size()]);
    std::fill_n(keep.get(), all.size(), true);
    if (by_scene) find_free(q.data(), all.size(), keep.get());
    ask_filter(q.data(), all.size(), keep.get());
    std::size_t i = 0;
    all.erase(std::remove_if(all.begin(), all.end(), [&](const Each&) { return !keep[i++]; }),
              all.end());
  }
  /// Why there is no answer, where all that were found were refused.
  [[nodiscard]] Status refusal() const {
    return filter_refused_ || !scene_ ? Status::rejected : Status::in_collision;
  }

 private:
  /// Asks about those whose flag is `of`, and sets it to the answer.
  void ask(const Filter& whom, const double* q, std::size_t count, bool of, bool* flag) const {
    if (std::all_of(flag, flag + count, [of](bool each) { return each == of; })) {
      // As they lie, without memory for others; about none nobody is asked.
      if (count > 0) whom(q, count, flag);
      return;
    }
    std::vector<double> asked;
    for (std::size_t i = 0; i < count; ++i) {
      if (flag[i] == of) asked.insert(asked.end(), q + i * dof_, q + (i + 1) * dof_);
    }
    const std::size_t n = asked.size() / dof_;
    if (n == 0) return;
    const std::unique_ptr<bool[]> answer(new bool[n]());
    whom(asked.data(), n, answer.get());
    std::size_t at = 0;
    for (std::size_t i = 0; i < count; ++i) {
      if (flag[i] == of) flag[i] = answer[at++];
    }
  }

  const std::optional<Scene>& scene_;
  const Filter& exact_;
  const Filter& filter_;
  std::size_t dof_;
  bool filter_refused_ = false;
};

}  // namespace iksel
