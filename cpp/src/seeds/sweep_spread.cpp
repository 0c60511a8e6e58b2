// SPDX-License-Identifier: BSD-3-Clause
// Solutions spread over a self-motion.
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "seeds/farthest_first.hpp"
#include "seeds/move_bounds.hpp"
#include "seeds/sweep.hpp"

namespace iksel {
class Sweep::Spread {
 public:
  Spread(Sweep& sweep, const JointSpace& joints, std::vector<double>& q)
      : sweep_(sweep), joints_(joints), q_(q) {
    q.clear();
  }

  /// Looks at so many samples; how many branches are inside the limits there.
  int find_runs(int samples) {
    sweep_.places_ = sweep_.branches_.places(samples);
    sweep_.rate_samples();
    runs_.clear();
    int inside = 0;
    for (int branch = 0; branch < lanes::kWidth; ++branch) {
      bool goes_on = false;
      for (int i = 0; i < samples; ++i) {
        const SweptBranches::Row& row = sweep_.rows_[static_cast<std::size_t>(i)];
        const bool is_inside = row[static_cast<std::size_t>(branch)] <= 0;
        if (is_inside && !goes_on) runs_.push_back({branch, i, i});
        if (is_inside) runs_.back().last = i;
        inside += is_inside ? 1 : 0;
        goes_on = is_inside;
      }
    }
    return inside;
  }

  /// Adds both ends of each run, places between them, so many for each sample, and one on the way
  /// to either sample beside.
  void add_runs(double each) {
    for (const Run& run : runs_) {
      const int steps = static_cast<int>(std::ceil(each * (run.last - run.first)));
      const double step = steps > 0 ? static_cast<double>(run.last - run.first) / steps : 0;
      add(run.branch, steps + 3, [&](int i) {
        if (i == 0) return run.first - 0.5;
        return i > steps + 1 ? run.last + 0.5 : run.first + step * (i - 1);
      });
    }
  }

  /// Adds what is inside the limits between two samples only.
  void add_between() {
    const Places& places = sweep_.places_;
    sweep_.visit_between([&](const double* q, int branch) {
      q_.insert(q_.end(), q, q + kCurveJoints);
      const double place = (q[sweep_.joint()] - places.lower) / places.step;
      add(branch, lanes::kWidth, [&](int i) { return place - 0.5 + i / (lanes::kWidth - 1.0); });
    });
  }

  /// Solves what was added, and places in gaps: beside singular poses joints move far between two
  /// samples.
  void solve() {
    constexpr int kRounds = 3;
    solve_places();
    for (int round = 0; round < kRounds && !gaps_.empty(); ++round) {
      for (const Gap& gap : std::exchange(gaps_, {})) {
        // With its ends, from which the next may still be far.
        const double step = (gap.to - gap.from) / (lanes::kWidth - 1);
        add(gap.branch, lanes::kWidth, [&](int i) { return gap.from + step * i; });
      }
      solve_places();
    }
  }

  /// Keeps `count` that are far from each other, and no nearer than `least`.
  void thin_out(std::size_t count, double least) {
    const std::vector<std::size_t> chosen = farthest_first(
        sweep_.branches_.kernels(), joints_, q_.data(), q_.size() / kCurveJoints, count, least);
    std::vector<double> kept;
    kept.reserve(count * kCurveJoints);
    for (const std::size_t i : chosen) {
      kept.insert(kept.end(), &q_[i * kCurveJoints], &q_[i * kCurveJoints] + kCurveJoints);
    }
    q_ = std::move(kept);
  }

 private:
  /// A branch that is inside the limits at samples from `first` to `last`.
  struct Run {
    int branch, first, last;
  };
  /// Between two places of a branch, which may lie between samples.
  struct Gap {
    int branch;
    double from, to;
  };

  /// A place of a branch, which may lie between samples.
  struct Spot {
    int branch;
    double place;
    bool is_first;  ///< not behind the one before
  };

  /// Adds so many places of a branch, one behind the other.
  template <typename At>
  void add(int branch, int count, const At& at) {
    for (int i = 0; i < count; ++i) spots_.push_back({branch, at(i), i == 0});
  }
  /// Keeps those places that are inside the limits; and what is beside such and far from it as
  /// gaps.
  void solve_places() {
    std::array<double, kCurveJoints> before{};
    bool was_inside = false;
    for (std::size_t i = 0; i < spots_.size(); i += lanes::kWidth) {
      const std::size_t lanes = std::min<std::size_t>(lanes::kWidth, spots_.size() - i);
      const auto spot = [&](int lane) -> const Spot& {
        return spots_[i + std::min(static_cast<std::size_t>(lane), lanes - 1)];
      };
      sweep_.branches_.solve_each(
          [&](int lane) { return spot(lane).branch; },
          [&](int lane) {
            return sweep_.branches_.clamp(sweep_.places_.lower +
                                          sweep_.places_.step * spot(lane).place);
          });
      for (int lane = 0; lane < static_cast<int>(lanes); ++lane) {
        const Spot& here = spot(lane);
        std::array<double, kCurveJoints> q{};
        sweep_.branches_.copy_joints(lane, q.data());
        const bool is_inside = sweep_.branches_.off(lane) <= 0;
        if (is_inside) q_.insert(q_.end(), q.begin(), q.end());
        if (!here.is_first && (was_inside || is_inside)) {
          const Gap gap{here.branch, (&here - 1)->place, here.place};
          if (is_wide(gap, before, q)) gaps_.push_back(gap);
        }
        before = q;
        was_inside = is_inside;
      }
    }
    spots_.clear();
  }
  [[nodiscard]] bool is_wide(const Gap& gap, const std::array<double, kCurveJoints>& from,
                             const std::array<double, kCurveJoints>& to) const {
    // Far is farther than that, and than so many times what the swept joint turns.
    constexpr double kSteeper = 4;
    const double wide =
        std::max(MoveBounds::kWide, kSteeper * sweep_.places_.step * (gap.to - gap.from));
    return !joints_.are_near(from, to, wide);
  }

  Sweep& sweep_;
  const JointSpace& joints_;
  std::vector<double>& q_;
  std::vector<Run> runs_;
  std::vector<Spot> spots_;
  std::vector<Gap> gaps_;
};

void Sweep::find_spread(const Pose& Y, std::size_t count, double least, std::vector<double>& q) {
  // Half as many again are looked at as are wanted.
  const auto places = static_cast<int>(count + count / 2);
  set_target(Y);
  Spread spread(*this, joints_, q);
  int samples = 2 * places < kSamples ? kSamples / 2 : kSamples;
  int inside = spread.find_runs(samples);
  if (samples < kSamples && 2 * inside < places) inside = spread.find_runs(kSamples);
  if (inside == 0) return;
  spread.add_runs(static_cast<double>(places) / inside);
  spread.add_between();
  spread.solve();
  spread.thin_out(count, least);
}

}  // namespace iksel
