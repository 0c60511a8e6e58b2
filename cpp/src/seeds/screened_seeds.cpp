// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/screened_seeds.hpp"

#include <algorithm>

namespace iksel {

SeedScreen::SeedScreen(const ChainModel& model, const SolverOptions& options,
                       const lanes::LaneKernels& kernels)
    : per_metre_(1 / model.unit),
      chain_(make_lane_chain<float>(model, model.unit)),
      kernels_(kernels),
      iterations_(std::min(kIterations, options.max_iterations)) {
  options_.damping = std::get<Lanes>(options.strategy).damping;
  options_.least_damping = 1e-6;
}

void SeedScreen::begin(const Pose& Y) {
  visit_rows(Y, per_metre_,
             [&](int row, double number) { pack_.target[row] = static_cast<float>(number); });
  filled_ = 0;
}

int SeedScreen::run(double (*rows)[lanes::kMaxJoints], std::size_t& count) {
  if (iterations_ > 0) kernels_.advance_roughly(chain_, options_, iterations_, pack_);
  for (int place = 0; place < filled_; ++place) {
    if (iterations_ > 0 && !(pack_.error2[place] < kNear2)) continue;
    double* q = rows[count++];
    for (int j = 0; j < chain_.n; ++j) {
      q[j] = chain_.from_lane(j, static_cast<double>(pack_.q[j][place]));
    }
  }
  filled_ = 0;
  return iterations_;
}

ScreenedSeeds::ScreenedSeeds(LaneQuery& query, SeedScreen& screen, const Pose& Y,
                             const JointSpace& joints, std::uint64_t seed, Work& work)
    : RowSeeds(work, &Work::take_counted),
      query_(query),
      screen_(screen),
      joints_(joints),
      random_(seed) {
  query_.begin_blocks();
  screen_.begin(Y);
}

bool ScreenedSeeds::next_stage() {
  work_.lap(&StageTimes::iterate);
  if (!work_.has_left()) return false;
  near_count_ = 0;
  for (int pack = 1; pack <= kPacks && work_.has_left(); ++pack) screen_one_pack(pack == kPacks);
  give(near_[0], near_count_, lanes::kMaxJoints, /*are_answers=*/false);
  work_.lap(&StageTimes::rank);
  return true;
}

bool ScreenedSeeds::take_block() {
  if (left_ == 0) left_ = query_.next_blocks(kBlocksAtOnce);
  if (left_ == 0) return false;
  // Worse seeds of blocks farther away seldom lead anywhere else than the better ones.
  const std::size_t number = query_.blocks_given() - left_--;
  last_rank_ = number < query_.near_blocks() ? lanes::kBlock : lanes::kBlock / 2;
  rank_ = 0;
  block_ = &query_.packs[number % kBlocksAtOnce];
  return true;
}

void ScreenedSeeds::screen_one_pack(bool is_random) {
  while (!screen_.is_full() && work_.take()) {
    if (!is_random && (rank_ < last_rank_ || take_block())) {
      const int entry = block_->order[rank_++];
      screen_.add([&](int j) { return block_->q[j][entry]; });
    } else {
      const JointVector q = joints_.sample(random_);
      screen_.add([&](int j) { return q[j]; });
    }
  }
  work_.iterations += screen_.run(near_, near_count_);
}

}  // namespace iksel
