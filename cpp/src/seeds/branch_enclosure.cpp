// SPDX-License-Identifier: BSD-3-Clause
#include "seeds/branch_enclosure.hpp"

#include <algorithm>
#include <utility>

namespace iksel {
namespace {

using lanes::kWidth;

/// Pieces to begin with.
constexpr int kPieces = 4 * kWidth;
/// Pieces that are halved so often are beside something that the tolerances do not tell apart.
constexpr double kLeastPiece = 1e-7;
/// More are not halved where that closes less than a fifth of them: with half as many, ten of
/// 22,835 proofs are lost, with twice as many none is won (python -m bench random
/// shoulder_elbow_offset).
constexpr std::size_t kMany = 128;
constexpr double kMostLeft = 0.8;
constexpr std::size_t kMostPieces = 512;

}  // namespace

BranchEnclosure::BranchEnclosure(const ChainModel& model, const ClosedFormChain& chain,
                                 double position_tolerance, double rotation_tolerance,
                                 const lanes::LaneKernels& kernels)
    : chain_(chain), kernels_(kernels) {
  const double offset = model.kernel.joints[static_cast<std::size_t>(chain.held)].offset;
  lower_ = model.joints.sample_lower(chain.held) + offset;
  upper_ = model.joints.sample_upper(chain.held) + offset;
  chain_.use_limits(model);
  chain_.form.error = chain.error_of_target(model, position_tolerance, rotation_tolerance);
  // Memory is taken here, and none while solving.
  open_.reserve(2 * kMostPieces);
  halves_.reserve(2 * kMostPieces);
}

bool BranchEnclosure::rules_out(const Pose& Y) {
  begin(Y);
  for (close(); !is_through(); close()) halve();
  return open_.empty();
}

void BranchEnclosure::begin(const Pose& Y) {
  chain_.set_target(Y, pack_);
  half_ = 0.5 * (upper_ - lower_) / kPieces;
  open_.clear();
  for (int arm = 0; arm < 4; ++arm) {
    for (int i = 0; i < kPieces; ++i) {
      open_.push_back({lower_ + (2 * i + 1) * half_, arm, {true, true}});
    }
  }
}

void BranchEnclosure::close() {
  std::size_t left = 0;
  for (std::size_t first = 0; first < open_.size(); first += kWidth) {
    const std::size_t count = std::min<std::size_t>(kWidth, open_.size() - first);
    for (std::size_t lane = 0; lane < kWidth; ++lane) {
      const Piece& piece = open_[first + std::min(lane, count - 1)];
      pack_.held[lane] = piece.middle;
      for (int i = 0; i < 2; ++i) pack_.sign[i][lane] = branch_sign(piece.arm, i);
    }
    double room[2][kWidth];
    // What rounding leaves between two pieces solves a target beside this one, within form.error.
    kernels_.enclose_branches(chain_.form, pack_, half_, room);
    for (std::size_t lane = 0; lane < count; ++lane) {
      Piece piece = open_[first + lane];
      for (std::size_t i = 0; i < 2; ++i) piece.with[i] = piece.with[i] && !(room[i][lane] < 0);
      if (piece.with[0] || piece.with[1]) open_[left++] = piece;
    }
  }
  helps_ =
      static_cast<double>(left) <= kMostLeft * static_cast<double>(open_.size()) || left <= kMany;
  open_.resize(left);
}

bool BranchEnclosure::is_through() const {
  return open_.empty() || !helps_ || open_.size() > kMostPieces || half_ < kLeastPiece;
}

void BranchEnclosure::halve() {
  half_ *= 0.5;
  std::swap(open_, halves_);
  open_.clear();
  for (Piece piece : halves_) {
    piece.middle -= half_;
    open_.push_back(piece);
    piece.middle += 2 * half_;
    open_.push_back(piece);
  }
}

}  // namespace iksel
