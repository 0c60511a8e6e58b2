// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/options.hpp"

#include <string>

#include "base/message_text.hpp"
#include "base/parallel.hpp"
#include "iksel/error.hpp"
#include "options/strategy.hpp"

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

/// The same for an enum whose last value is `last`.
template <typename Enum>
void check_enum(const char* name, Enum value, Enum last) {
  check_range(name, static_cast<int>(value), 0, static_cast<int>(last));
}

/// What both strategies have.
template <typename Strategy>
void check_common(const Strategy& strategy) {
  check_range("neighbours", strategy.neighbours, 1, 1'000'000);
  check_range("damping", strategy.damping, 0.0, 1e6);
}

/// Throws if an option that nothing reads is not at its default.
template <typename T>
void check_read(const char* name, bool is_read, const T& value, const T& standard,
                const char* readers) {
  if (is_read || value == standard) return;
  throw InvalidArgumentError("option " + std::string(name) + ": only read " + readers +
                             "; leave it at its default");
}

/// Throws unless there is such a setting of the paper's; whether it is the newer one.
bool is_newer(int year) {
  if (year == 2025 || year == 2026) return year == 2026;
  throw InvalidArgumentError("paper: year " + std::to_string(year) + " is none of 2025, 2026");
}

void check_ranges(const Paper& paper) {
  check_common(paper);
  check_range("neighbour_radius", paper.neighbour_radius, 0.0, 1e6);
  check_enum("ranking", paper.ranking, Ranking::joint_adjustment);
  check_enum("rotation_difference", paper.rotation_difference, RotationDifference::geodesic);
  check_range("candidates", paper.candidates, 1, 1'000'000);
  check_enum("reselection", paper.reselection, Reselection::farthest);
  check_enum("iteration", paper.iteration, Iteration::lm);
  check_range("pinv_cutoff", paper.pinv_cutoff, 0.0, 0.5);
  check_range("position_clamp", paper.position_clamp, 1e-6, 1e6);
  check_range("rotation_clamp", paper.rotation_clamp, 1e-6, 1e6);
  check_enum("growth_stop", paper.growth_stop, GrowthStop::off);
  check_range("min_step", paper.min_step, 0.0, 1.0);
  check_range("null_space_gain", paper.null_space_gain, 0.0, 1.0);
  check_range("limit_margin", paper.limit_margin, 1e-6, 0.5);
  check_enum("kinematics", paper.kinematics, Kinematics::kdl);
}

}  // namespace

void Lanes::validate() const { check_common(*this); }

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
  const bool inverts =
      is_one_of(Iteration::dls, Iteration::pinv, Iteration::pinv_rr, Iteration::cwpi);
  constexpr const char* kInverting = "by iteration 'dls', 'pinv', 'pinv_rr' and 'cwpi'";
  check_read("pinv_cutoff", inverts, pinv_cutoff, standard.pinv_cutoff, kInverting);
  check_read("position_clamp", !is_lm, position_clamp, standard.position_clamp,
             "by all iterations but 'lm'");
  check_read("rotation_clamp", !is_lm, rotation_clamp, standard.rotation_clamp,
             "by all iterations but 'lm'");
  check_read("min_step", inverts, min_step, standard.min_step, kInverting);
  check_read("limits_stop", inverts, limits_stop, standard.limits_stop, kInverting);
  check_read("null_space_gain", inverts && !is_one_of(Iteration::cwpi), null_space_gain,
             standard.null_space_gain, "by iteration 'dls', 'pinv' and 'pinv_rr'");
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
  paper.kinematics = Kinematics::kernel;
  return paper;
}

DatabaseOptions DatabaseOptions::paper(int year) {
  DatabaseOptions options;
  options.sampling = Sampling::grid;
  options.scale = Scale::medium;
  if (is_newer(year)) {
    options.sampling = Sampling::kmeans;
    options.samples = 2'048;
  }
  options.key_scheme = KeyScheme::full;
  options.rotation_key = RotationKey::rotation_vector;
  options.rotation_weight = 1.0;
  options.pinv_cutoff = 1e-4;
  return options;
}

void DatabaseOptions::validate() const {
  check_enum("sampling", sampling, Sampling::kmeans);
  check_enum("scale", scale, Scale::large);
  check_enum("key_scheme", key_scheme, KeyScheme::reduced);
  check_enum("rotation_key", rotation_key, RotationKey::dual_quaternion);
  if (key_scheme == KeyScheme::reduced && rotation_key != RotationKey::rotation_vector) {
    throw InvalidArgumentError(
        "option rotation_key: only a full key writes rotations in different ways; set key_scheme "
        "to full with it");
  }
  check_range<std::size_t>("samples", samples, 0, 4'000'000'000U);
  check_range("rotation_weight", rotation_weight, 0.0, 1e6);
  check_range("pinv_cutoff", pinv_cutoff, 0.0, 0.5);
  check_range<std::size_t>("cvt_updates", cvt_updates, 0, 1'000'000'000U);
  check_range<std::size_t>("kmeans_pool", kmeans_pool, 1, 1'000'000'000U);
  check_range("kmeans_rounds", kmeans_rounds, 0, 1'000'000);
  const DatabaseOptions standard;
  check_read("cvt_updates", sampling == Sampling::cvt, cvt_updates, standard.cvt_updates,
             "by sampling 'cvt'");
  const bool is_kmeans = sampling == Sampling::kmeans;
  check_read("kmeans_pool", is_kmeans, kmeans_pool, standard.kmeans_pool, "by sampling 'kmeans'");
  check_read("kmeans_rounds", is_kmeans, kmeans_rounds, standard.kmeans_rounds,
             "by sampling 'kmeans'");
  resolve_threads(threads);
}

SolverOptions SolverOptions::paper(int year) {
  SolverOptions options;
  options.position_tolerance = 1e-4;
  options.rotation_tolerance = 1e-3;
  options.database = DatabaseOptions::paper(year);
  options.max_attempts = 2;
  // The reference implementation's "7 iterations" evaluate nine configurations, eight steps apart.
  options.max_iterations = 8;
  Paper paper;
  if (is_newer(year)) {
    options.max_attempts = 16;
    // Its 12 iterations end with a step that is not looked at any more.
    options.max_iterations = 11;
    paper.candidates = 16;
    paper.reselection = Reselection::next;
    paper.rotation_clamp = 0.3;
    // It compares the error with infinity: its variable for the last one is never written.
    paper.growth_stop = GrowthStop::off;
    paper.min_step = 0;
    paper.limits_stop = true;
    paper.null_space_gain = 0.2;
  }
  options.strategy = paper;
  return options;
}

void SolverOptions::validate() const {
  check_range("position_tolerance", position_tolerance, 1e-12, 1e3);
  check_range("rotation_tolerance", rotation_tolerance, 1e-12, 4.0);
  task.validate();
  check_range("max_attempts", max_attempts, 1, 1'000'000);
  check_range("max_iterations", max_iterations, 1, 100'000);
  database.validate();
  std::visit([](const auto& each) { each.validate(); }, strategy);
}

}  // namespace iksel
