// SPDX-License-Identifier: BSD-3-Clause
// Every kind of request on odd chains: 1 to 32 joints, hardly any range or hundreds of radians,
// millimetres and kilometres, aligned axes, followers, locked joints. Nothing that says success is
// anything else by an independent judge; nothing crashes or hangs; ordinary arms are solved.
//
// A case is the answer to one target. IKSEL_TEST_CASES sets their number; chain i has the seed
// IKSEL_TEST_SEED + i, so that the seed in a message brings that chain back as the first.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <iksel/iksel.hpp>
#include <iostream>
#include <optional>

#include "odd_session.hpp"
#include "robots.hpp"

namespace {

using iksel_test::ChainMaker;
using iksel_test::Dice;
using iksel_test::OddChain;
using iksel_test::OddJoint;
using iksel_test::Session;
using iksel_test::Tally;

constexpr int kCasesPerChain = 100;
/// No chain takes nearly as long, even under sanitizers [s of the processor].
constexpr int kWatchdog = 300;

char watchdog_message[64];

void on_alarm(int /*signal*/) {
  const ssize_t written = ::write(2, watchdog_message, sizeof watchdog_message);
  ::_exit(written > 0 ? 3 : 4);
}

void set_watchdog(std::uint64_t seed) {
  std::snprintf(watchdog_message, sizeof watchdog_message, "hung: chain of IKSEL_TEST_SEED=%llu\n",
                static_cast<unsigned long long>(seed));
  ::signal(SIGPROF, on_alarm);
  const itimerval time{{0, 0}, {kWatchdog, 0}};
  ::setitimer(ITIMER_PROF, &time, nullptr);
}

/// Joints without any range and followers that leave none are refused by name.
bool is_refused(const OddChain& chain, const std::string& urdf) {
  bool empty = false;
  for (std::size_t v = 0; v < chain.lower.size(); ++v) {
    empty = empty || !(chain.lower[v] < chain.upper[v]);
  }
  iksel::RobotOptions options = robot_options(chain);
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    const OddJoint& joint = chain.joints[i];
    if (joint.lower == joint.upper) options.locked_joints.erase("j" + std::to_string(i));
  }
  const bool unlocked = options.locked_joints.size() != robot_options(chain).locked_joints.size();
  if (empty || unlocked) {
    EXPECT_THROW((void)iksel::Robot::from_urdf_string(urdf, options), iksel::UrdfError);
  }
  return empty;
}

/// Asks requests of one chain; false when there was a finding.
bool run_chain(std::uint64_t seed, int cases, Tally& tally) {
  Dice dice(seed);
  const OddChain chain = ChainMaker(dice).make();
  const std::string urdf = urdf_of(chain);
  SCOPED_TRACE("IKSEL_TEST_SEED=" + std::to_string(seed) + "\n" + urdf);
  set_watchdog(seed);
  if (is_refused(chain, urdf)) return true;
  std::optional<Session> session;
  EXPECT_NO_THROW({
    const auto robot = iksel::Robot::from_urdf_string(urdf, robot_options(chain));
    EXPECT_EQ(robot.dof(), chain.dof());
    session.emplace(chain, robot, dice, tally);
  });
  const int end = tally.cases + cases;
  while (!testing::Test::HasFailure() && tally.cases < end) {
    EXPECT_NO_THROW(session->ask());
  }
  return !testing::Test::HasFailure();
}

TEST(OddChains, EveryAnswerHoldsByAnIndependentJudge) {
  const int cases = iksel_test::cases(10'000);
  Tally tally;
  int chains = 0;
  while (tally.cases < cases) {
    const auto seed = iksel_test::seed() + static_cast<std::uint64_t>(chains++);
    if (!run_chain(seed, std::min(kCasesPerChain, cases - tally.cases), tally)) break;
  }
  const itimerval none{};
  ::setitimer(ITIMER_PROF, &none, nullptr);
  std::cout << "odd chains: " << tally.cases << " cases on " << chains << " chains, "
            << tally.solved << " solved; of ordinary arms' " << tally.reachable
            << " reachable targets " << tally.reached << std::endl;
  // A solver that says no to everything would hold as well.
  EXPECT_GE(tally.reached, tally.reachable * 0.99);
  if (cases >= 10'000) EXPECT_GE(tally.reachable, cases / 50);
  if (cases >= 10'000) EXPECT_GE(tally.solved, cases / 2);
}

}  // namespace
