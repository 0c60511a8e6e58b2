// SPDX-License-Identifier: BSD-3-Clause
// Sources of seeds one after the other.
#pragma once

#include <cstddef>
#include <tuple>
#include <utility>

namespace iksel {

template <typename... Sources>
class SeedSequence {
 public:
  /// All must outlive this. Those from number `end` on are not asked.
  explicit SeedSequence(std::size_t end, Sources&... sources) : end_(end), sources_(sources...) {}

  bool next_stage() {
    for (; at_ < end_; ++at_) {
      bool any = false;
      visit([&](auto& source) { any = source.next_stage(); }, kAll);
      if (any) return true;
    }
    return false;
  }

  template <typename Refiner>
  bool load(Refiner& refiner, int lane) {
    bool loaded = false;
    visit([&](auto& source) { loaded = source.load(refiner, lane); }, kAll);
    return loaded;
  }

 private:
  static constexpr auto kAll = std::index_sequence_for<Sources...>{};

  template <typename Action, std::size_t... kIndex>
  void visit(const Action& action, std::index_sequence<kIndex...> /*all*/) {
    ((kIndex == at_ ? action(std::get<kIndex>(sources_)) : void()), ...);
  }

  std::size_t at_ = 0;
  std::size_t end_;
  std::tuple<Sources&...> sources_;
};

}  // namespace iksel
