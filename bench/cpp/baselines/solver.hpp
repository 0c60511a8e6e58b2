// SPDX-License-Identifier: BSD-3-Clause
// The baselines behind one interface. Each is for one thread: KDL's objects memoise.
#pragma once

#include <atomic>
#include <chrono>
#include <memory>
#include <string>

#include "problem.hpp"

namespace baselines {

using Clock = std::chrono::steady_clock;

struct Settings {
  /// Position [m] and rotation [rad] error of an answer at most.
  double tolerance = 1e-6;
  /// Time per target [s], for the solvers that have no limit on their restarts.
  double time_limit = 5e-3;
  /// Starts per target, for the solvers that have no time limit.
  int starts = 20;
  std::uint64_t seed = 1;
};

/// Tells a search when to give up.
struct Stop {
  Clock::time_point deadline;
  /// Set by whoever found an answer first; may be null.
  const std::atomic<bool>* other_won = nullptr;

  [[nodiscard]] bool now() const {
    return (other_won != nullptr && other_won->load(std::memory_order_relaxed)) ||
           Clock::now() >= deadline;
  }
};

class Solver {
 public:
  Solver() = default;
  Solver(const Solver&) = delete;
  Solver& operator=(const Solver&) = delete;
  virtual ~Solver() = default;

  /// Searches from `q`; true and the answer in `q`, or false.
  virtual bool solve(const KDL::Frame& target, KDL::JntArray& q, const Stop& stop) = 0;
};

/// KDL's Newton step, kept inside the limits, with a random restart where it gets stuck.
std::unique_ptr<Solver> make_newton(const Problem& problem, const Settings& settings);
/// SLSQP on the squared pose error with the limits as bounds, with random restarts.
std::unique_ptr<Solver> make_slsqp(const Problem& problem, const Settings& settings);
/// Both at once on two threads; the first answer wins.
std::unique_ptr<Solver> make_race(const Problem& problem, const Settings& settings);
/// KDL::ChainIkSolverPos_LMA with random restarts and joint wrapping.
std::unique_ptr<Solver> make_kdl_lma(const Problem& problem, const Settings& settings);
/// KDL::ChainIkSolverPos_NR_JL with random restarts and joint wrapping.
std::unique_ptr<Solver> make_kdl_nr_jl(const Problem& problem, const Settings& settings);

}  // namespace baselines
