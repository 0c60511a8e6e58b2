// SPDX-License-Identifier: BSD-3-Clause
// Seeds brought nearer to their goals in SIMD lanes, by Levenberg-Marquardt.
#pragma once

#include <limits>

#include "base/constants.hpp"
#include "goal/task_space.hpp"
#include "iksel/options.hpp"
#include "kinematics/chain_model.hpp"
#include "simd/kernels.hpp"
#include "simd/lane_chain.hpp"

namespace iksel {

/// When a lane is given up.
struct Patience {
  /// A seed that is still far off after so many iterations is given up: few such seeds
  /// converge later.
  int far_off;
  /// Any seed is, after so many.
  int most;
  /// Every so many iterations it may be looked where a seed is heading; 0: never.
  int look = 0;
  /// A seed that almost arrived is given up when so often in a row its error did not fall by half;
  /// 0: never.
  int stalls = 0;
};

inline constexpr int kMostIterations = std::numeric_limits<int>::max();
/// Of a seed that is held by a limit beside an answer the error stays as it is: beside a fold,
/// where steps are slowest, its square falls to a sixteenth each time.
inline constexpr int kStalled = 2;
/// Where any answer will do.
inline constexpr Patience kFirst{8, kMostIterations};
/// The same before roots or a sweep, which find what a slow seed would have: a pose of random arms
/// without an answer waits an eighth less, one that can be reached as long, and none is lost
/// (python -m bench lost --random 20 --targets 20000).
inline constexpr Patience kBeforeFamilies{5, kMostIterations, 0, kStalled};
/// Where a seed more or less does not matter: solutions arrive after 4 iterations in the mean, and
/// what is far off after 6 costs more than what it finds.
inline constexpr Patience kAll{6, kMostIterations, 2};
/// Where seeds were iterated before in single precision.
inline constexpr Patience kScreened{4, kMostIterations, 0, kStalled};
/// Where seeds are answers, or as near to one as a singularity or a limit lets it be told.
inline constexpr Patience kNearAnswer{8, 64, 0, kStalled};

/// Whether as few lanes as give an answer soonest, or as many as do most (lane_types.hpp).
enum class Width { narrow, wide };

class LaneRefiner {
 public:
  LaneRefiner(const ChainModel& model, const SolverOptions& options,
              const lanes::LaneKernels& kernels);

  [[nodiscard]] int width() const { return packs_->lanes; }
  /// Before a search for goals of one task, which has to outlive it.
  void begin(const TaskSpace& task, const Patience& patience, Width width);

  /// What all lanes are to reach, or one of them: of a full pose Y (reduction.hpp) is read, of a
  /// task the pose of the TCP.
  void set_target(const Pose& Y, const Pose& T_base_tcp);
  void set_target(int lane, const Pose& Y, const Pose& T_base_tcp);

  /// Starts a lane at `value(joint)`, inside the limits.
  template <typename Value>
  void load(int lane, const Value& value) {
    for (int j = 0; j < chain_.n; ++j) {
      pack_.q[j][lane] = chain_.to_lane(j, value(j));
    }
    if (chain_.sums > 0) hold_sums(lane);
    there_ &= ~(1U << static_cast<unsigned>(lane));  // of a search that ended before advance()
    pack_.error2[lane] = kInfinity;                  // not measured yet
    age_[lane] = 0;
    next_look_[lane] = patience_.look > 0 ? patience_.look : kMostIterations;
    refused_error2_[lane] = kInfinity;
    stalls_[lane] = 0;
  }
  /// Starts a lane at a configuration that came from elsewhere, held to the limits.
  void load_seed(int lane, const double* q);
  /// Starts a lane at an answer, which is there already as far as its seed's maker can tell.
  void load_answer(int lane, const double* q) {
    load_seed(lane, q);
    there_ |= 1U << static_cast<unsigned>(lane);
  }
  /// The lane's seed is followed to its end wherever it is heading.
  void follow(int lane) { next_look_[lane] = kMostIterations; }

  /// Iterates the lanes of the mask `busy` until one arrives, or is to be looked at or given up.
  /// Returns the iterations.
  int advance(unsigned busy);
  [[nodiscard]] bool has_arrived(int lane) const {
    return (arrived_ >> static_cast<unsigned>(lane) & 1U) != 0;
  }
  /// What arrived is no answer yet: notes it, and returns whether it stays there.
  bool stays(int lane) {
    const double error2 = pack_.error2[lane];
    stalls_[lane] = error2 > 0.25 * refused_error2_[lane] ? stalls_[lane] + 1 : 0;
    refused_error2_[lane] = error2;
    return patience_.stalls > 0 && stalls_[lane] >= patience_.stalls;
  }
  [[nodiscard]] bool is_spent(int lane) const {
    return age_[lane] >= patience_.most ||
           (age_[lane] >= patience_.far_off && !(pack_.error2[lane] < kFarOff2));
  }
  /// Whether it is time to look where the lane is heading.
  bool is_to_be_looked_at(int lane) {
    if (age_[lane] < next_look_[lane]) return false;
    next_look_[lane] = age_[lane] + patience_.look;
    return true;
  }
  /// Iterations of the lane's seed.
  [[nodiscard]] int age(int lane) const { return age_[lane]; }

  /// The joint values of a lane.
  struct Column {
    const double (&rows)[lanes::kMaxJoints][lanes::kWidth];
    const lanes::LaneChain& chain;
    int lane;
    double operator[](int joint) const { return chain.from_lane(joint, rows[joint][lane]); }
  };
  [[nodiscard]] Column at(int lane) const { return {pack_.q, chain_, lane}; }
  [[nodiscard]] JointVector q(int lane) const {
    JointVector q(chain_.n);
    for (int j = 0; j < chain_.n; ++j) q[j] = at(lane)[j];
    return q;
  }

 private:
  template <typename Write>
  void make_rows(const Pose& Y, const Pose& T_base_tcp, const Write& write) const;
  /// Brings a lane's seed inside the limits, by whole turns and along sums.
  void hold_sums(int lane);
  void make_task(const TaskSpace& task);

  const lanes::LaneKernels& kernels_;
  const lanes::PackKernels* packs_;
  int max_iterations_;
  const JointSpace& joints_;
  Pose base_inverse_, tip_;  ///< of the kernel chain; the tip is the TCP
  double per_metre_;         ///< of the unit of all lengths that lanes work on
  lanes::LaneChain chain_;
  lanes::LaneOptions options_, task_options_;
  const TaskSpace* task_ = nullptr;  ///< null: full poses
  lanes::LaneTask lane_task_{};
  lanes::LanePack pack_;
  Patience patience_{};
  int age_[lanes::kWidth] = {};
  int next_look_[lanes::kWidth] = {};
  double refused_error2_[lanes::kWidth] = {};
  int stalls_[lanes::kWidth] = {};
  unsigned arrived_ = 0;
  unsigned there_ = 0;  ///< lanes loaded with answers since the last advance()
};

}  // namespace iksel
