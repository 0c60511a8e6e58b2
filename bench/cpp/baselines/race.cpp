// SPDX-License-Identifier: BSD-3-Clause
// Newton and SLSQP at once, each on a thread of its own; the first answer ends both (Beeson and
// Ames 2015). The second thread is kept between targets, so that its start is not in anybody's
// time.
#include <condition_variable>
#include <mutex>
#include <thread>

#include "solver.hpp"

namespace baselines {
namespace {

class Race final : public Solver {
 public:
  Race(const Problem& problem, const Settings& settings)
      : newton_(make_newton(problem, settings)),
        slsqp_(make_slsqp(problem, settings)),
        other_q_(problem.dof()),
        helper_([this] { help(); }) {}

  Race(const Race&) = delete;
  Race& operator=(const Race&) = delete;

  ~Race() override {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      quit_ = true;
    }
    wake_.notify_one();
    helper_.join();
  }

  bool solve(const KDL::Frame& target, KDL::JntArray& q, const Stop& stop) override {
    won_.store(false, std::memory_order_relaxed);
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      target_ = target;
      other_q_ = q;
      deadline_ = stop.deadline;
      busy_ = true;
    }
    wake_.notify_one();
    const bool mine = newton_->solve(target, q, Stop{stop.deadline, &won_});
    if (mine) won_.store(true, std::memory_order_relaxed);
    std::unique_lock<std::mutex> lock(mutex_);
    done_.wait(lock, [this] { return !busy_; });
    if (!mine && other_found_) q = other_q_;
    return mine || other_found_;
  }

 private:
  void help() {
    std::unique_lock<std::mutex> lock(mutex_);
    for (;;) {
      wake_.wait(lock, [this] { return busy_ || quit_; });
      if (quit_) return;
      lock.unlock();
      const bool found = slsqp_->solve(target_, other_q_, Stop{deadline_, &won_});
      if (found) won_.store(true, std::memory_order_relaxed);
      lock.lock();
      other_found_ = found;
      busy_ = false;
      done_.notify_one();
    }
  }

  std::unique_ptr<Solver> newton_, slsqp_;
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  std::atomic<bool> won_{false};
  bool busy_ = false, quit_ = false, other_found_ = false;
  KDL::Frame target_;
  KDL::JntArray other_q_;
  Clock::time_point deadline_;
  // Last, so that everything it uses is there before it starts.
  std::thread helper_;
};

}  // namespace

std::unique_ptr<Solver> make_race(const Problem& problem, const Settings& settings) {
  return std::make_unique<Race>(problem, settings);
}

}  // namespace baselines
