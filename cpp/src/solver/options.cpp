// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/options.hpp"

#include <cmath>

#include "iksel/error.hpp"
#include "iksel/result.hpp"
#include "message_text.hpp"
#include "util/parallel.hpp"

namespace iksel {
namespace {

/// Throws unless low <= value <= high; NaN fails.
template <typename T>
void check_range(const char* name, T value, T low, T high) {
  if (value >= low && value <= high) return;
  MessageStream text;
  text << "option " << name << ": " << value << " is not in " << low << " .. " << high;
  throw InvalidArgumentError(text.str());
}

template <typename Enum>
void check_enum(const char* name, Enum value, Enum last) {
  check_range(name, static_cast<int>(value), 0, static_cast<int>(last));
}

}  // namespace

DatabaseOptions DatabaseOptions::paper() {
  DatabaseOptions options;
  options.sampling = Sampling::grid;
  options.scale = Scale::medium;
  options.key_scheme = KeyScheme::full;
  options.rotation_key = RotationKey::rotation_vector;
  options.rotation_weight = 1.0;
  options.pinv_cutoff = 1e-4;
  return options;
}

void DatabaseOptions::validate() const {
  check_enum("sampling", sampling, Sampling::random);
  check_enum("scale", scale, Scale::large);
  check_enum("key_scheme", key_scheme, KeyScheme::reduced);
  check_enum("rotation_key", rotation_key, RotationKey::euler);
  if (key_scheme == KeyScheme::reduced && rotation_key != RotationKey::rotation_vector) {
    throw InvalidArgumentError(
        "option rotation_key: only a full key writes rotations in different ways; set key_scheme "
        "to full with it");
  }
  check_range<std::size_t>("samples", samples, 0, 4'000'000'000U);
  check_range("rotation_weight", rotation_weight, 0.0, 1e6);
  check_range("pinv_cutoff", pinv_cutoff, 0.0, 0.5);
  check_range<std::size_t>("cvt_updates", cvt_updates, 0, 1'000'000'000U);
  resolve_threads(threads);
}

SolverOptions SolverOptions::paper() {
  SolverOptions options;
  options.position_tolerance = 1e-4;
  options.rotation_tolerance = 1e-3;
  options.database = DatabaseOptions::paper();
  options.neighbours = 200;
  options.ranking = Ranking::joint_adjustment;
  options.rotation_difference = RotationDifference::rotation_vector;
  options.limit_aware = false;
  options.candidates = 20;
  options.reselection = Reselection::farthest;
  options.max_attempts = 2;
  options.iteration = Iteration::dls;
  // The reference implementation's "7 iterations" evaluate nine configurations, eight steps apart.
  options.max_iterations = 8;
  options.damping = 0;
  options.pinv_cutoff = 1e-4;
  options.position_clamp = 0.1;
  options.rotation_clamp = 3.14159265358979323846 / 10;
  options.growth_stop = GrowthStop::by_scheme;
  options.min_step = 1e-6;
  options.limit_margin = 0.1;
  options.whole_turns = false;
  return options;
}

void SolverOptions::validate() const {
  check_range("position_tolerance", position_tolerance, 1e-12, 1e3);
  check_range("rotation_tolerance", rotation_tolerance, 1e-12, 4.0);
  task.validate();
  database.validate();
  check_range("neighbours", neighbours, 1, 1'000'000);
  check_enum("ranking", ranking, Ranking::joint_adjustment);
  check_enum("rotation_difference", rotation_difference, RotationDifference::geodesic);
  check_range("candidates", candidates, 1, 1'000'000);
  check_enum("reselection", reselection, Reselection::farthest);
  check_range("max_attempts", max_attempts, 1, 1'000'000);
  check_enum("iteration", iteration, Iteration::lm);
  check_range("max_iterations", max_iterations, 1, 100'000);
  check_range("damping", damping, 0.0, 1e6);
  check_range("pinv_cutoff", pinv_cutoff, 0.0, 0.5);
  check_range("position_clamp", position_clamp, 1e-6, 1e6);
  check_range("rotation_clamp", rotation_clamp, 1e-6, 1e6);
  check_enum("growth_stop", growth_stop, GrowthStop::off);
  check_range("min_step", min_step, 0.0, 1.0);
  check_range("limit_margin", limit_margin, 1e-6, 0.5);
  check_enum("kinematics", kinematics, Kinematics::kdl);
}

const char* to_string(Status status) {
  switch (status) {
    case Status::solved:
      return "solved";
    case Status::not_converged:
      return "not_converged";
    case Status::outside_limits:
      return "outside_limits";
    case Status::out_of_reach:
      return "out_of_reach";
    case Status::rejected:
      return "rejected";
    case Status::out_of_time:
      return "out_of_time";
    case Status::too_fast:
      return "too_fast";
    case Status::invalid_pose:
      return "invalid_pose";
  }
  return "unknown";
}

}  // namespace iksel
