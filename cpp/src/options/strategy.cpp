// SPDX-License-Identifier: BSD-3-Clause
#include "options/strategy.hpp"

#include <string>

#include "iksel/error.hpp"
#include "options/option_check.hpp"

namespace iksel {
namespace {

constexpr int kMostNeighbours = 1'000'000;
constexpr double kMostDamping = 1e6;

/// Throws if an option that nothing reads is not at its default.
template <typename T>
void check_read(const char* name, bool is_read, const T& value, const T& standard,
                const char* readers) {
  if (is_read || value == standard) return;
  throw InvalidArgumentError("option " + std::string(name) + ": only read " + readers +
                             "; leave it at its default");
}

void check_ranges(const Paper& paper) {
  check_range("neighbours", paper.neighbours, 1, kMostNeighbours);
  check_enum("ranking", paper.ranking, Ranking::joint_adjustment);
  check_enum("rotation_difference", paper.rotation_difference, RotationDifference::geodesic);
  check_range("candidates", paper.candidates, 1, 1'000'000);
  check_enum("reselection", paper.reselection, Reselection::farthest);
  check_enum("iteration", paper.iteration, Iteration::lm);
  check_range("damping", paper.damping, 0.0, kMostDamping);
  check_range("pinv_cutoff", paper.pinv_cutoff, 0.0, 0.5);
  check_range("position_clamp", paper.position_clamp, 1e-6, 1e6);
  check_range("rotation_clamp", paper.rotation_clamp, 1e-6, 1e6);
  check_enum("growth_stop", paper.growth_stop, GrowthStop::off);
  check_range("min_step", paper.min_step, 0.0, 1.0);
  check_range("limit_margin", paper.limit_margin, 1e-6, 0.5);
  check_enum("kinematics", paper.kinematics, Kinematics::kdl);
}

}  // namespace

void Lanes::validate() const {
  check_range("neighbours", neighbours, 1, kMostNeighbours);
  check_range("damping", damping, 0.0, kMostDamping);
}

void Paper::validate() const {
  check_ranges(*this);
  const Paper standard;
  const auto is_one_of = [&](auto... schemes) { return ((iteration == schemes) || ...); };
  const bool is_lm = is_one_of(Iteration::lm);
  check_read("rotation_difference", ranking == Ranking::joint_adjustment || limit_aware,
             rotation_difference, standard.rotation_difference,
             "where seeds are ranked by 'joint_adjustment' or limit_aware");
  check_read("candidates", reselection != Reselection::none, candidates, standard.candidates,
             "where there is a re-selection");
  check_read("damping", is_one_of(Iteration::dls, Iteration::lm), damping, standard.damping,
             "by iteration 'dls' and 'lm'");
  check_read("pinv_cutoff",
             is_one_of(Iteration::dls, Iteration::pinv, Iteration::pinv_rr, Iteration::cwpi),
             pinv_cutoff, standard.pinv_cutoff, "by iteration 'dls', 'pinv', 'pinv_rr' and 'cwpi'");
  check_read("position_clamp", !is_lm, position_clamp, standard.position_clamp,
             "by all iterations but 'lm'");
  check_read("rotation_clamp", !is_lm, rotation_clamp, standard.rotation_clamp,
             "by all iterations but 'lm'");
  check_read("min_step", is_one_of(Iteration::dls, Iteration::pinv, Iteration::pinv_rr), min_step,
             standard.min_step, "by iteration 'dls', 'pinv' and 'pinv_rr'");
  check_read("limit_margin", is_one_of(Iteration::cwln, Iteration::cwpi), limit_margin,
             standard.limit_margin, "by iteration 'cwln' and 'cwpi'");
}

Paper one_at_a_time(const Strategy& strategy) {
  if (const auto* paper = std::get_if<Paper>(&strategy)) return *paper;
  const auto& lanes = std::get<Lanes>(strategy);
  Paper paper;
  paper.neighbours = lanes.neighbours;
  paper.rotation_difference = RotationDifference::geodesic;
  paper.limit_aware = true;
  paper.candidates = 100;
  paper.iteration = Iteration::lm;
  paper.damping = lanes.damping;
  paper.whole_turns = true;
  return paper;
}

}  // namespace iksel
