// SPDX-License-Identifier: BSD-3-Clause
// A control loop at 1 kHz: a Panda's hand follows a target that someone moves, now and then faster
// than the joints can, and out of the workspace and back. The seconds it runs may be given as
// argument. How late the answers came goes to stderr; python/examples/07_teleoperation.py prints
// the same otherwise.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <exception>
#include <iksel/iksel.hpp>
#include <string>
#include <thread>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;

constexpr double kDt = 0.001;

// Stands for the operator's device: a loop up to 0.3 m to the front and 0.2 m to the sides, twice a
// lap up and down.
iksel::Pose target_at(int tick, const iksel::Pose& start) {
  const double angle = 2 * kDt * tick;
  iksel::Pose target = start;
  target.translation() += Eigen::Vector3d(0.15 * (1 - std::cos(angle)), 0.2 * std::sin(angle),
                                          0.05 * std::sin(2 * angle));
  return target;
}

double us_since(Clock::time_point then) {
  return std::chrono::duration<double, std::micro>(Clock::now() - then).count();
}

// What the loop did. All memory is taken before it begins.
struct Record {
  explicit Record(std::size_t ticks) : solve_us(ticks), late_us(ticks) {}
  std::vector<double> solve_us;  // how long track took
  std::vector<double> late_us;   // from the tick to the answer
  int there = 0;
  int on_the_way = 0;
  int held = 0;
  iksel::Pose lost;      // the first target without a continuation
  double top_speed = 0;  // of a joint, relative to its limit
};

void follow(iksel::Tracker& tracker, const iksel::Pose& start, int ticks, Record& record) {
  const iksel::JointVector limit = tracker.solver().robot().velocity_limit();
  const auto begin = Clock::now();
  for (int tick = 1; tick <= ticks; ++tick) {
    // Ticks lie on a grid of their own: being late once moves none of those that follow.
    const auto due = begin + std::chrono::milliseconds(tick);
    std::this_thread::sleep_until(due);
    const iksel::Pose target = target_at(tick, start);
    const iksel::JointVector before = tracker.q();
    const auto woken = Clock::now();
    const iksel::Result result = tracker.track(target, kDt);
    // Here tracker.q() would go to the joints: it is where they can be by the next tick.
    const auto i = static_cast<std::size_t>(tick - 1);
    record.solve_us[i] = us_since(woken);
    record.late_us[i] = us_since(due);

    if (result.success()) {
      ++record.there;
    } else if (result.status == iksel::Status::too_fast) {
      ++record.on_the_way;
    } else if (record.held++ == 0) {
      record.lost = target;
    }
    const double speed = ((tracker.q() - before).cwiseAbs() / kDt).cwiseQuotient(limit).maxCoeff();
    record.top_speed = std::max(record.top_speed, speed);
  }
}

void print_times(const char* name, std::vector<double> us) {
  std::sort(us.begin(), us.end());
  const auto quantile = [&us](double part) {
    return us[static_cast<std::size_t>(part * static_cast<double>(us.size() - 1))];
  };
  std::fprintf(stderr, "%s [us]: median %.1f, 99 %% %.1f, 99.9 %% %.1f, worst %.1f\n", name,
               quantile(0.5), quantile(0.99), quantile(0.999), us.back());
}

int run(double seconds) {
  iksel::RobotOptions links;
  links.base_link = "panda_link0";
  links.tip_link = "panda_link8";
  const auto robot = iksel::Robot::from_urdf_file(IKSEL_ROBOTS_DIR "/panda.urdf", links);
  const iksel::Solver solver(robot);
  const auto here = (iksel::JointVector(7) << 0.0, -0.4, 0.0, -2.2, 0.0, 1.8, 0.8).finished();

  iksel::Tracker tracker(solver, here);
  const int ticks = std::max(1, static_cast<int>(std::lround(seconds / kDt)));
  Record record(static_cast<std::size_t>(ticks));
  follow(tracker, robot.fk(here), ticks, record);

  print_times("solving", record.solve_us);
  print_times("tick to answer", record.late_us);
  const auto missed = std::count_if(record.late_us.begin(), record.late_us.end(),
                                    [](double us) { return us > 1e6 * kDt; });
  std::fprintf(stderr, "answers after the next tick: %td of %d\n", missed, ticks);
  std::printf("ticks %d: %d on the target, %d on the way, %d held\n", ticks, record.there,
              record.on_the_way, record.held);
  // Searching for the reason takes milliseconds: not for the loop.
  if (record.held > 0) {
    std::printf("first held: %s\n", iksel::to_string(solver.diagnose(record.lost).cause));
  }
  std::printf("top speed %.3f of the limit, ends at q", record.top_speed);
  for (const double value : tracker.q()) std::printf(" %.4f", value);
  std::printf("\n");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc > 1 ? std::stod(argv[1]) : 3);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
