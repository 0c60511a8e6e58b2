// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/options.hpp"
#include "options/option_check.hpp"

namespace iksel {

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

}  // namespace iksel
