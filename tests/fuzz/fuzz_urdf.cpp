// SPDX-License-Identifier: BSD-3-Clause
// Text as a URDF: a typed error, or a robot that solves without a false success.
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iksel/iksel.hpp>
#include <random>
#include <string>

#include "check_answer.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t room);

namespace {

/// Values that numbers in a URDF are replaced by.
constexpr std::array kOddNumbers = {
    "0",      "-0",    "1",     "-1",   "1e-9", "-1e-300", "4.9e-324", "1e9",  "1e160",
    "-1e200", "1e308", "1e400", "nan",  "-inf", "inf",     "100",      "-100", "3.141592653589793",
    "6.3",    "1e3",   "1e-3",  "0x10", "",
};

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Replaces one number of the text; false where there is none, or no room.
bool replace_number(std::string& text, std::mt19937& random, std::size_t room) {
  std::size_t at = random() % (text.size() + 1);
  while (at < text.size() && !is_digit(text[at])) ++at;
  if (at >= text.size()) return false;
  std::size_t end = at;
  while (end < text.size() && (is_digit(text[end]) || std::strchr(".eE+-", text[end]) != nullptr)) {
    ++end;
  }
  text.replace(at, end - at, kOddNumbers[random() % kOddNumbers.size()]);
  return text.size() <= room;
}

void solve_once(const iksel::Robot& robot) {
  iksel::SolverOptions options;
  options.database.samples = 20;
  options.database.threads = 1;
  options.max_attempts = 8;
  const iksel::Solver solver(robot, options);
  const iksel::Pose target = robot.fk(robot.random_configurations(1, 1).row(0));
  iksel_fuzz::check_answer(solver, target, solver.solve(target));
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t room, unsigned seed) {
  std::mt19937 random(seed);
  if (random() % 3 != 0) return LLVMFuzzerMutate(data, size, room);
  std::string text(reinterpret_cast<const char*>(data), size);
  if (!replace_number(text, random, room)) return LLVMFuzzerMutate(data, size, room);
  std::memcpy(data, text.data(), text.size());
  return text.size();
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string text(reinterpret_cast<const char*>(data), size);
  try {
    iksel::RobotOptions options;
    options.soft_limits = size % 2 == 1;
    solve_once(iksel::Robot::from_urdf_string(text, options));
  } catch (const iksel::Error&) {
    // Any other exception is a finding.
  }
  return 0;
}
