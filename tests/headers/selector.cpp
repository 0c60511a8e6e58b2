// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/selector.hpp>

namespace iksel_headers {

void use_selector(const iksel::Database& database, const iksel::Pose& pose) {
  iksel::Selector selector(database, iksel::Paper());
  selector = iksel::Selector(selector.database(), selector.scheme());
  const iksel::Candidates best = selector.candidates(pose);
  static_cast<void>(selector.candidates(pose, 5, iksel::Ranking::nearest).q.size());
  static_cast<void>(selector.rank(iksel::Ranking::joint_adjustment).distances.size());
  static_cast<void>(selector.next(best.indices).has_value());
}

}  // namespace iksel_headers
