// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/selector.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "database/data.hpp"
#include "iksel/error.hpp"
#include "iksel/pose.hpp"
#include "seeds/selection.hpp"

namespace iksel {

struct Selector::Impl {
  Impl(const Database& database_in, const Paper& scheme_in)
      : database(database_in),
        given(scheme_in),
        scheme(scheme_in),
        selection(nullptr, nullptr, database.data(), scheme) {}

  /// The neighbours of the last target, ranked.
  Candidates rank(Ranking ranking) {
    scheme.ranking = ranking;
    selection.rank();
    Candidates out;
    for (const Candidate& each : selection.queue().in_order()) {
      out.indices.push_back(each.index);
      out.distances.push_back(selection.distance(each));
      out.adjustments.push_back(std::sqrt(selection.squared_adjustment(each)));
      out.q.push_back(database.q(each.index));
    }
    return out;
  }

  void check_target(const char* call) const {
    if (!has_target) {
      throw InvalidArgumentError(std::string(call) + ": there is no target yet: call candidates");
    }
  }

  Database database;
  Paper given;   ///< as it was given
  Paper scheme;  ///< with the ranking and count of the last call
  Selection selection;
  bool has_target = false;
};

Selector::Selector(const Database& database, const Paper& scheme) {
  scheme.validate();
  if (database.data().reduction) {
    throw InvalidArgumentError(
        "database: its key is reduced, so that its samples are no seeds before a solver has filled "
        "in joints; build one with key_scheme full, as DatabaseOptions.paper() does");
  }
  if (scheme.limit_aware) {
    throw InvalidArgumentError("limit_aware: a database does not have the limits");
  }
  impl_ = std::make_unique<Impl>(database, scheme);
}

Selector::Selector(Selector&&) noexcept = default;
Selector& Selector::operator=(Selector&&) noexcept = default;
Selector::~Selector() = default;

Candidates Selector::candidates(const Pose& T_base_tip, std::size_t count, Ranking ranking) {
  const Pose target = check_pose(T_base_tip);
  if (count == 0) throw InvalidArgumentError("count: 0 is not 1 or more");
  database().data().check_intact();
  impl_->selection.make_room(count);
  impl_->selection.query(target);
  impl_->has_target = true;
  return impl_->rank(ranking);
}

Candidates Selector::candidates(const Pose& T_base_tip) {
  return candidates(T_base_tip, static_cast<std::size_t>(impl_->given.neighbours),
                    impl_->given.ranking);
}

Candidates Selector::rank(Ranking ranking) {
  impl_->check_target("rank");
  return impl_->rank(ranking);
}

std::optional<std::size_t> Selector::next(const std::vector<std::size_t>& failed) {
  impl_->check_target("next");
  CandidateQueue& queue = impl_->selection.queue();
  const auto q_of = [&](const Candidate& each) { return impl_->selection.seed_of(each); };
  queue.restart();
  for (std::size_t i = 0; i < failed.size(); ++i) {
    if (queue.take(failed[i], q_of)) continue;
    const auto until = failed.begin() + static_cast<std::ptrdiff_t>(i);
    const bool is_again = std::find(failed.begin(), until, failed[i]) != until;
    throw InvalidArgumentError(
        "failed: sample " + std::to_string(failed[i]) +
        (is_again ? " comes twice"
                  : " is none of the " + std::to_string(queue.kept()) + " best candidates"));
  }
  if (queue.next(q_of) == nullptr) return std::nullopt;
  return queue.last().index;
}

const Database& Selector::database() const { return impl_->database; }
const Paper& Selector::scheme() const { return impl_->given; }

}  // namespace iksel
