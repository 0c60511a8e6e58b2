// SPDX-License-Identifier: BSD-3-Clause
// Two doubles worked on at once, which needs no more than every x86-64 or Arm64 processor has.
#pragma once

namespace iksel {

struct DoublePair {
  using value_type = double;
  using Vector = double __attribute__((vector_size(16)));

  DoublePair() = default;
  explicit DoublePair(double both) : v{both, both} {}
  DoublePair(double first, double second) : v{first, second} {}

  friend DoublePair operator+(DoublePair a, DoublePair b) { return DoublePair(a.v + b.v); }
  friend DoublePair operator-(DoublePair a, DoublePair b) { return DoublePair(a.v - b.v); }
  friend DoublePair operator*(DoublePair a, DoublePair b) { return DoublePair(a.v * b.v); }

  Vector v;

 private:
  explicit DoublePair(Vector vector) : v(vector) {}
};

}  // namespace iksel
