// SPDX-License-Identifier: BSD-3-Clause
// The roots of a residual (residual_kernel.hpp, loop_determinant.hpp) over a range of its angle.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include "base/function_ref.hpp"
#include "simd/kernels.hpp"

namespace iksel {

class RootFinder {
 public:
  /// Intervals between angles at which the residual is looked at first. It is a trigonometric
  /// polynomial, of degree 8 if axes 1 and 2 meet, or of a loop.
  static constexpr int kCells = 128;
  /// Roots that are kept, at most. There are 16 of degree 8.
  static constexpr std::size_t kMost = 48;

  struct Root {
    double angle;           ///< [rad]
    bool is_vague;          ///< there may be two near to here, or just none
    double apart = 0;       ///< so far away are these, real or not, if that is known [rad]
    bool is_faint = false;  ///< it turns here, hardly different from 0, and that is all
  };

  /// From `lower` on, over `range`, which is all if it is a whole turn or more [rad]. Where the
  /// residual turns and its two roots are at most `vague` away, real or not [rad], a root is vague.
  /// Others are found to within `precision` [rad].
  RootFinder(double lower, double range, double vague, double precision,
             const lanes::LaneKernels& kernels);

  /// Writes the residuals of `n` angles, a multiple of kWidth.
  using Residual = FunctionRef<void(const double* angles, int n, double* residuals)>;
  /// Where it turns and is at most `faint`, there is a vague root too.
  void find(const Residual& residual, double faint);
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] const Root& operator[](std::size_t i) const { return roots_[i]; }
  /// Of the larger of the residuals at both ends of a cell, the least.
  [[nodiscard]] double faintest() const;
  /// Whether these are all.
  [[nodiscard]] bool is_complete() const { return is_complete_; }

 private:
  /// Values before the first cell's left end, and after the last one's, that tell of the cell.
  static constexpr int kBefore = 3;
  static constexpr int kAfter = 4;

  /// Two angles between which there is a root, narrowed by Chandrupatla's method (1997).
  struct Bracket {
    double x1, x2, f1, f2;  ///< the latest, and that beyond the root
    double x3 = std::numeric_limits<double>::quiet_NaN(), f3 = 0;  ///< the one before

    [[nodiscard]] double next(double precision) const;
    void narrow(double x, double f);
    [[nodiscard]] bool is_narrow(double precision) const {
      return f1 == 0 || std::abs(x2 - x1) <= 2 * precision;
    }
    [[nodiscard]] double best() const { return std::abs(f1) < std::abs(f2) ? x1 : x2; }
  };
  /// Looks into the interval of this length from `left` on, at more angles; `depth` of those
  /// around.
  void look_closer(const Residual& residual, double left, double length, int depth);
  void add_bracket(double left, double length, const double* value);
  void add(const Root& root);
  /// Adds where the residual turns, but hardly differs from 0.
  void add_faint(double most);
  /// Narrows all brackets.
  void polish(const Residual& residual);

  const lanes::LaneKernels& kernels_;
  bool turns_;
  double vague_;
  double precision_;
  double step_;
  std::vector<double> angles_, values_;  ///< with those before and after
  std::array<Bracket, kMost> brackets_{};
  std::size_t brackets_size_ = 0;
  std::array<Root, kMost> roots_{};
  std::size_t size_ = 0;
  bool is_complete_ = false;
};

}  // namespace iksel
