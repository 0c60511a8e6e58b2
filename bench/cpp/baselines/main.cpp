// SPDX-License-Identifier: BSD-3-Clause
// baselines SOLVER PROBLEM ANSWERS [--tolerance X] [--time-limit S] [--starts N] [--seed N]
//
// Solves every target of a problem file (problem.hpp) one after another and writes one line for
// each: whether it was solved, the time [ns], the configuration. bench/rivals/kdl.py runs it.
#include <algorithm>
#include <cstdio>
#include <map>
#include <stdexcept>

#include "solver.hpp"

namespace {

using namespace baselines;
using Make = std::unique_ptr<Solver> (*)(const Problem&, const Settings&);

const std::map<std::string, Make> kSolvers = {{"newton", make_newton},
                                              {"slsqp", make_slsqp},
                                              {"race", make_race},
                                              {"kdl_lma", make_kdl_lma},
                                              {"kdl_nr_jl", make_kdl_nr_jl}};

Settings read_settings(int argc, char** argv) {
  Settings settings;
  for (int i = 4; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    const std::string value = argv[i + 1];
    if (option == "--tolerance") {
      settings.tolerance = std::stod(value);
    } else if (option == "--time-limit") {
      settings.time_limit = std::stod(value);
    } else if (option == "--starts") {
      settings.starts = std::stoi(value);
    } else if (option == "--seed") {
      settings.seed = std::stoull(value);
    } else {
      throw std::runtime_error("unknown option " + option);
    }
  }
  return settings;
}

int run(int argc, char** argv) {
  if (argc < 4) throw std::runtime_error("usage: baselines SOLVER PROBLEM ANSWERS [options]");
  const auto make = kSolvers.find(argv[1]);
  if (make == kSolvers.end()) {
    std::string names;
    for (const auto& [name, function] : kSolvers) names += ' ' + name;
    throw std::runtime_error(std::string("unknown solver ") + argv[1] + "; there are:" + names);
  }
  const Problem problem = read_problem(argv[2]);
  const Settings settings = read_settings(argc, argv);
  const auto solver = make->second(problem, settings);
  const auto limit = std::chrono::duration_cast<Clock::duration>(
      std::chrono::duration<double>(settings.time_limit));

  struct Answer {
    bool solved;
    long long nanoseconds;
    KDL::JntArray q;
  };
  std::vector<Answer> answers;
  answers.reserve(problem.targets.size());
  // The first targets twice: the first time warms the caches.
  const std::size_t warm_up = std::min<std::size_t>(problem.targets.size(), 5);
  for (std::size_t i = 0; i < warm_up; ++i) {
    KDL::JntArray q = problem.starts[i];
    solver->solve(problem.targets[i], q, Stop{Clock::now() + limit});
  }
  for (std::size_t i = 0; i < problem.targets.size(); ++i) {
    KDL::JntArray q = problem.starts[i];
    const auto begin = Clock::now();
    const bool solved = solver->solve(problem.targets[i], q, Stop{begin + limit});
    const auto time = std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin);
    answers.push_back({solved, time.count(), q});
  }

  std::FILE* out = std::fopen(argv[3], "w");
  if (out == nullptr) throw std::runtime_error(std::string("cannot write ") + argv[3]);
  for (const Answer& answer : answers) {
    std::fprintf(out, "%d %lld", answer.solved ? 1 : 0, answer.nanoseconds);
    for (unsigned i = 0; i < answer.q.rows(); ++i) std::fprintf(out, " %.17g", answer.q(i));
    std::fputc('\n', out);
  }
  if (std::fclose(out) != 0) throw std::runtime_error(std::string("cannot write ") + argv[3]);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "baselines: %s\n", error.what());
    return 2;
  }
}
