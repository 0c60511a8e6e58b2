// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/branch_enclosure.hpp"

#include <algorithm>

namespace iksel {
namespace {

using lanes::kWidth;

/// Pieces to begin with.
constexpr int kPieces = 4 * kWidth;
/// Pieces that are halved so often are beside something that the tolerances do not tell apart.
constexpr double kLeastPiece = 1e-7;
/// Packs of pieces, after which it is given up, some 0.5 ms. Nine of ten noes take 16 to 40, of
/// arms on rails up to 68; what is proven of random arms: python -m bench random.
constexpr int kMostPacks = 512;
/// Pieces overlap by this part, so that rounding leaves no gap between them.
constexpr double kOverlap = 1e-12;
/// What axes that lie off where the form has them may do to the target, by their deviation, which
/// counts each twice: it turns what is behind it back and forth, and moves it by as much at a lever
/// of 1.
constexpr double kAxesOff = 2;

}  // namespace

BranchEnclosure::BranchEnclosure(const ChainModel& model, const ClosedFormChain& chain,
                                 double position_tolerance, double rotation_tolerance,
                                 const lanes::LaneKernels& kernels)
    : joints_(model.joints),
      chain_(chain),
      kernels_(kernels),
      offset_(model.kernel.joints[static_cast<std::size_t>(chain.held)].offset),
      lower_(model.joints.sample_lower(chain.held) + offset_),
      upper_(model.joints.sample_upper(chain.held) + offset_),
      doubt_(JointVector::Zero(model.dof)) {
  chain_.use_limits(model);
  chain_.form.error = chain.tolerance_of_target(model, position_tolerance, rotation_tolerance) +
                      kAxesOff * chain.deviation * std::max(1.0, model.reach / chain.unit);
  // Memory is taken here, and none while solving: a piece is halved less than so often.
  constexpr std::size_t kHalvings = 32;
  open_.reserve(kPieces + kHalvings * kWidth);
}

bool BranchEnclosure::rules_out(const Pose& Y) {
  chain_.set_target(Y, target_);
  packs_left_ = kMostPacks;
  has_doubt_ = false;
  for (int arm = 0; arm < 4; ++arm) {
    if (!rules_out({branch_sign(arm, 0), branch_sign(arm, 1)})) return false;
  }
  return true;
}

bool BranchEnclosure::rules_out(const double (&sign)[2]) {
  const double part = 0.5 * (upper_ - lower_) / kPieces;
  open_.clear();
  for (int i = 0; i < kPieces; ++i) {
    open_.push_back({lower_ + (2 * i + 1) * part, part, {true, true}});
  }
  while (!open_.empty()) {
    if (packs_left_-- == 0) return false;
    const std::size_t count = std::min<std::size_t>(open_.size(), kWidth);
    const std::size_t first = open_.size() - count;
    double middle[kWidth], half[kWidth], room[2][kWidth];
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      const Piece& piece = open_[first + std::min(lane, count - 1)];
      middle[lane] = piece.middle;
      half[lane] = piece.half * (1 + kOverlap);
    }
    kernels_.enclose_branches(chain_.form, target_, sign, middle, half, room);
    std::array<Piece, kWidth> left;
    std::size_t size = 0;
    for (std::size_t lane = 0; lane < count; ++lane) {
      Piece piece = open_[first + lane];
      for (std::size_t i = 0; i < 2; ++i) piece.with[i] = piece.with[i] && !(room[i][lane] < 0);
      if (piece.with[0] || piece.with[1]) left[size++] = piece;
    }
    open_.resize(first);
    for (std::size_t i = 0; i < size; ++i) {
      const Piece& piece = left[i];
      const double quarter = 0.5 * piece.half;
      if (quarter < kLeastPiece) {
        keep_doubt(sign, piece);
        return false;
      }
      open_.push_back({piece.middle - quarter, quarter, piece.with});
      open_.push_back({piece.middle + quarter, quarter, piece.with});
    }
  }
  return true;
}

void BranchEnclosure::keep_doubt(const double (&sign)[2], const Piece& piece) {
  const double signs[3] = {sign[0], sign[1], piece.with[0] ? 1.0 : -1.0};
  for (int s = 0; s < 3; ++s) std::fill_n(target_.sign[s], kWidth, signs[s]);
  std::fill_n(target_.held, kWidth, piece.middle);
  kernels_.find_branches(chain_.form, target_);
  chain_.copy_joints(target_.q, 0, doubt_.data());
  doubt_[chain_.held] = piece.middle - offset_;
  doubt_ = joints_.clamp(doubt_);
  has_doubt_ = true;
}

}  // namespace iksel
