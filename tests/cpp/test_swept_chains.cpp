// SPDX-License-Identifier: BSD-3-Clause
// Random chains of six joints of which one is swept: the residual, and its roots.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iksel/iksel.hpp>
#include <optional>
#include <vector>

#include "branches.hpp"
#include "closed_chains.hpp"
#include "levels.hpp"
#include "robots.hpp"
#include "seeds/root_sweep.hpp"
#include "simd/kernels.hpp"
#include "structure/closed_form.hpp"
#include "structure/loop_equations.hpp"

namespace {

namespace lanes = iksel::lanes;
using iksel::ClosedFormChain;
using iksel::JointVector;
using iksel::Pose;
using iksel::Robot;
using iksel::RootFinder;
using iksel::RootSweep;
using iksel_test::AxisMaker;
using iksel_test::Dice;
using iksel_test::kTwoPi;
using iksel_test::Pair;
using lanes::Closure;

RootSweep sweep_of(const Robot& robot) {
  return {robot.model(), *iksel::find_residual(robot.model()), /*is_nominal=*/true, 1e-6,
          lanes::choose_kernels()};
}

/// Whether q is among the solutions that a sweep has found.
bool holds(const RootSweep& sweep, const Robot& robot, const JointVector& q, double within) {
  for (int i = 0; i < sweep.size(); ++i) {
    const JointVector other = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(sweep.q(i));
    if (iksel_test::distance(robot, other, q) <= within) return true;
  }
  return false;
}

/// Finds all solutions of a pose.
void find(RootSweep& sweep, const Robot& robot, const Pose& target) {
  sweep.find(iksel_test::reduced(robot, target), /*wants_all=*/true);
}

/// The residual of a chain by the angle of the joint that is swept, for the pose of its last frame.
class Residual {
 public:
  Residual(const ClosedFormChain& chain, const Pose& Y) : kernels_(lanes::choose_kernels()) {
    if (chain.loop) {
      lanes::LoopTarget target;
      chain.loop->set_target(chain.reversed ? Y.inverse() : Y, target);
      iksel::LoopPolynomial polynomial(kernels_);
      polynomial.find(target);
      EXPECT_LT(polynomial.noise(), 1e-9 * polynomial.size());
      polynomial_ = polynomial.get();
    } else {
      auto pack = iksel::all_branches();
      chain.set_target(Y, pack);
      form_ = iksel::make_residual(chain, pack);
    }
  }
  void operator()(const double* angles, int n, double* residuals) const {
    if (form_) {
      kernels_.find_residuals(*form_, angles, n, residuals);
    } else {
      kernels_.evaluate_polynomial(polynomial_, angles, n, residuals);
    }
  }

 private:
  const lanes::LaneKernels& kernels_;
  std::optional<lanes::ResidualForm> form_;
  lanes::TrigonometricPolynomial polynomial_{};
};

/// Of a closure, seen from either end; or, for a loop, of axes that lie anyhow but for a pair.
struct Swept {
  Closure closure;
  bool is_reversed = false;
  Pair pair = Pair::none;
  std::size_t first = 0;

  [[nodiscard]] iksel_test::AxisChain make(Dice& dice) const {
    AxisMaker maker(dice);
    return closure == Closure::loop ? maker.make(pair, first) : maker.make(closure, is_reversed);
  }
};

std::string name_of(const testing::TestParamInfo<Swept>& info) {
  const Swept& swept = info.param;
  if (swept.closure != Closure::loop) {
    return std::string(swept.closure == Closure::sweep_4 ? "sweep_4" : "sweep_6") +
           (swept.is_reversed ? "_reversed" : "");
  }
  if (swept.pair == Pair::none) return "anyhow";
  return (swept.pair == Pair::parallel ? "parallel_" : "meeting_") +
         std::to_string(swept.first + 1) + std::to_string(swept.first + 2);
}

std::vector<Swept> all_swept() {
  std::vector<Swept> all;
  for (const Closure closure : {Closure::sweep_4, Closure::sweep_6}) {
    all.push_back({closure, false});
    all.push_back({closure, true});
  }
  all.push_back({Closure::loop});
  for (const Pair pair : {Pair::parallel, Pair::meeting}) {
    for (std::size_t first = 0; first < 5; ++first) {
      all.push_back({Closure::loop, false, pair, first});
    }
  }
  return all;
}

/// Random chains of one kind.
class SweptChains : public testing::TestWithParam<Swept> {
 protected:
  template <typename Check>
  void for_each_chain(int count, double limit, const Check& check) const {
    const Swept& swept = GetParam();
    int as_made = 0;
    for (int i = 0; i < count; ++i) {
      const std::uint64_t seed = iksel_test::seed() * 1000 + static_cast<std::uint64_t>(i);
      SCOPED_TRACE("chain of seed " + std::to_string(seed));
      Dice dice(seed);
      const Robot robot = iksel_test::make_robot(swept.make(dice), dice, limit);
      auto chain = iksel::find_residual(robot.model());
      ASSERT_TRUE(chain.has_value());
      EXPECT_EQ(iksel::find_structure(robot).kind, iksel::StructureKind::swept);
      check(robot, *chain, dice);
      const bool is_loop = chain->form.closure == Closure::loop;
      as_made +=
          chain->form.closure == swept.closure && (is_loop || chain->reversed == swept.is_reversed);
    }
    // Axes may meet by chance too.
    EXPECT_GE(as_made, count * 9 / 10);
  }
};

/// Of the residual by its definition: where a branch has none, it has none.
TEST_P(SweptChains, TheResidualIsZeroAtSolutions) {
  for_each_chain(
      iksel_test::cases(40), 0, [](const Robot& robot, const ClosedFormChain& chain, Dice&) {
        const Eigen::MatrixXd random = robot.random_configurations(10, iksel_test::seed());
        const auto held = static_cast<std::size_t>(chain.held);
        for (int i = 0; i < random.rows(); ++i) {
          const Residual residual(chain, iksel_test::reduced(robot, robot.fk(random.row(i))));
          std::array<double, 128> angles;
          std::array<double, 128> residuals;
          const double at = random(i, chain.held) + robot.model().kernel.joints[held].offset;
          for (std::size_t k = 0; k < 128; ++k)
            angles[k] = at + kTwoPi / 128 * static_cast<double>(k);
          residual(angles.data(), 128, residuals.data());
          double largest = 0;
          for (const double r : residuals) largest = std::max(largest, std::abs(r));
          EXPECT_LE(std::abs(residuals[0]), 1e-9 * largest) << random.row(i);
          EXPECT_GT(largest, 0);
        }
      });
}

TEST_P(SweptChains, HoldsTheSolutionThatWasPutIn) {
  int all = 0;
  int lost = 0;
  int certain = 0;
  for_each_chain(
      iksel_test::cases(40), 3.0, [&](const Robot& robot, const ClosedFormChain&, Dice&) {
        RootSweep sweep = sweep_of(robot);
        const Eigen::MatrixXd random = robot.random_configurations(20, iksel_test::seed());
        for (int i = 0; i < random.rows(); ++i) {
          const JointVector q = random.row(i);
          find(sweep, robot, robot.fk(q));
          for (int k = 0; k < sweep.size(); ++k) {
            EXPECT_LE(Eigen::Map<const JointVector>(sweep.q(k), 6).cwiseAbs().maxCoeff(), 3.1);
          }
          if (iksel_test::least_singular_value(robot.jacobian(q)) < 1e-4) continue;
          ++all;
          certain += sweep.is_certain();
          // Where two branches meet, roots are double, and a seed is near to the solution.
          lost += !holds(sweep, robot, q, 0.1);
        }
      });
  EXPECT_LE(lost, all / 20000) << "of " << all;
  EXPECT_GE(certain, all * 9 / 10) << "of " << all;
}

TEST_P(SweptChains, EveryLevelFindsTheSameRoots) {
  for_each_chain(
      iksel_test::cases(5), 0, [](const Robot& robot, const ClosedFormChain& chain, Dice&) {
        const Pose Y = iksel_test::reduced(robot, robot.fk(JointVector::Constant(6, 0.7)));
        const auto roots = [&] {
          RootFinder finder(0, kTwoPi, 1e-3, 5e-10, lanes::choose_kernels());
          finder.find(Residual(chain, Y), 0);
          return finder;
        };
        const RootFinder reference = roots();
        for (const std::string& level : iksel_test::levels()) {
          const iksel_test::ForcedLevel forced(level);
          const RootFinder other = roots();
          ASSERT_EQ(other.size(), reference.size()) << level;
          for (std::size_t i = 0; i < other.size(); ++i) {
            // Where the residual hardly crosses zero, rounding moves a root by so much.
            EXPECT_NEAR(other[i].angle, reference[i].angle, 1e-5) << level;
          }
        }
      });
}

INSTANTIATE_TEST_SUITE_P(Each, SweptChains, testing::ValuesIn(all_swept()), name_of);

/// From each joint that may be swept, and with the target at each place of the loop.
TEST(Loops, CloseWhereTheyWereMade) {
  const auto& kernels = lanes::choose_kernels();
  for (int i = 0; i < iksel_test::cases(40); ++i) {
    Dice dice(iksel_test::seed() * 1000 + static_cast<std::uint64_t>(i));
    const Robot robot = iksel_test::make_robot(AxisMaker(dice).make(Pair::none, 0), dice);
    const iksel::ChainModel& model = robot.model();
    JointVector q(6);
    for (int j = 0; j < 6; ++j) q[j] = dice.uniform(-3, 3);
    const Pose Y = iksel_test::reduced(robot, robot.fk(q));
    for (const int swept : {3, 4, 5, 0}) {
      const iksel::LoopEquations loop(iksel::ScrewAxes::of(model), model.reach, swept);
      lanes::LoopTarget target;
      loop.set_target(Y, target);
      lanes::ClosedForm limits{};
      lanes::BranchPack pack{};
      for (int j = 0; j < 6; ++j) {
        limits.offset[j] = model.kernel.joints[static_cast<std::size_t>((swept + j) % 6)].offset;
      }
      std::fill_n(pack.held, lanes::kWidth, q[swept] + limits.offset[0]);
      kernels.close_loops(loop.form(), target, limits, /*are_pairs=*/false, pack);
      for (int j = 0; j < 6; ++j) {
        EXPECT_LT(std::abs(std::remainder(pack.q[j][0] - q[(swept + j) % 6], kTwoPi)), 1e-5)
            << "joint " << j << " from " << swept << ", seed " << iksel_test::seed() << ", " << i;
      }
      EXPECT_LT(pack.residual[0], 1e-5);
    }
  }
}

/// Where the last three axes of the loop meet or are parallel, two solutions share the others'
/// angles.
TEST(Loops, CloseBothWays) {
  const auto& kernels = lanes::choose_kernels();
  for (int i = 0; i < iksel_test::cases(40); ++i) {
    Dice dice(iksel_test::seed() * 1000 + static_cast<std::uint64_t>(i));
    iksel_test::AxisChain axes = AxisMaker(dice).make(Pair::none, 0);
    std::vector<Eigen::Vector3d>& same = i % 2 == 0 ? axes.p : axes.h;
    same[4] = same[5] = same[3];
    const Robot robot = iksel_test::make_robot(axes, dice);
    JointVector q(6);
    for (int j = 0; j < 6; ++j) q[j] = dice.uniform(-3, 3);
    const Pose target = robot.fk(q);
    const iksel::LoopEquations loop(iksel::ScrewAxes::of(robot.model()), robot.model().reach, 0);
    EXPECT_TRUE(loop.form().has_two_ways());
    lanes::LoopTarget of_target;
    loop.set_target(iksel_test::reduced(robot, target), of_target);
    lanes::ClosedForm limits{};
    lanes::BranchPack pack{};
    for (int j = 0; j < 6; ++j) {
      limits.offset[j] = robot.model().kernel.joints[static_cast<std::size_t>(j)].offset;
    }
    std::fill_n(pack.held, lanes::kWidth, q[0] + limits.offset[0]);
    for (int lane = 0; lane < lanes::kWidth; ++lane) pack.sign[0][lane] = lane % 2 == 0 ? 1 : -1;
    kernels.close_loops(loop.form(), of_target, limits, /*are_pairs=*/false, pack);
    double nearest = 10;
    for (int lane = 0; lane < 2; ++lane) {
      JointVector other(6);
      for (int j = 0; j < 6; ++j) other[j] = pack.q[j][lane];
      EXPECT_LT((robot.fk(other).matrix() - target.matrix()).norm(), 1e-6)
          << "way " << lane << ", seed " << iksel_test::seed() << ", " << i;
      nearest = std::min(nearest, iksel_test::distance(robot, other, q));
    }
    EXPECT_LT(nearest, 1e-5) << "seed " << iksel_test::seed() << ", " << i;
    EXPECT_GT(std::abs(pack.q[5][0] - pack.q[5][1]), 1e-6);
  }
}

/// Moves the target of which a and b are solutions to where they share the angle of a joint, by
/// Newton's method; false where that fails.
bool share_angle(const Robot& robot, int joint, JointVector& a, JointVector& b) {
  for (int step = 0; step < 40; ++step) {
    const double apart = std::remainder(a[joint] - b[joint], kTwoPi);
    if (std::abs(apart) < 1e-11) return iksel_test::distance(robot, a, b) > 0.1;
    const Eigen::MatrixXd by_a = robot.jacobian(a).inverse();
    const Eigen::MatrixXd by_b = robot.jacobian(b).inverse();
    const Eigen::VectorXd slope = (by_a.row(joint) - by_b.row(joint)).transpose();
    Eigen::VectorXd twist = -apart / slope.squaredNorm() * slope;
    twist *= std::min(1.0, 0.1 / twist.norm());
    a += by_a * twist;
    b += by_b * twist;
    const Pose target = robot.fk(a);
    for (int i = 0; i < 8; ++i) {
      b += robot.jacobian(b).inverse() * iksel::pose_error(target, robot.fk(b));
    }
    if (!(iksel::pose_error(target, robot.fk(b)).norm() < 1e-9)) return false;
  }
  return false;
}

/// Two solutions that share the angle of the joint that is swept, or all but do, are both found.
TEST(Loops, FindTwoThatShareAnAngle) {
  int tried = 0;
  int missed = 0;
  for (int i = 0; i < iksel_test::cases(100); ++i) {
    Dice dice(iksel_test::seed() * 1000 + static_cast<std::uint64_t>(i));
    const Robot robot =
        iksel_test::make_robot(AxisMaker(dice).make(Pair::none, 0), dice, /*limit=*/kTwoPi);
    RootSweep sweep = sweep_of(robot);
    JointVector a(6);
    for (int j = 0; j < 6; ++j) a[j] = dice.uniform(-3, 3);
    find(sweep, robot, robot.fk(a));
    if (sweep.size() < 2) continue;
    JointVector b = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(sweep.q(0));
    if (iksel_test::distance(robot, a, b) < 0.1) {
      b = Eigen::Map<const Eigen::Matrix<double, 6, 1>>(sweep.q(1));
    }
    const int swept = iksel::find_residual(robot.model())->held;
    if (!share_angle(robot, swept, a, b)) continue;
    for (const double away : {0.0, 1e-9, 1e-7, 1e-5, 1e-3}) {
      JointVector q = a;
      for (int j = 0; j < 6; ++j) q[j] += away * dice.uniform(-1, 1);
      find(sweep, robot, robot.fk(q));
      ++tried;
      if (!holds(sweep, robot, q, 0.3) || !holds(sweep, robot, b, 0.3)) ++missed;
    }
  }
  EXPECT_GT(tried, 20);
  EXPECT_LE(missed, tried / 50) << "of " << tried << ", seed " << iksel_test::seed();
}

/// Of this pose, two solutions share the angle of the joint that is swept.
TEST(Loops, AreNotConcludedFromWhereTwoShareAnAngle) {
  constexpr std::uint64_t kSeed = 19;
  Dice dice(kSeed);
  const Robot robot =
      iksel_test::make_robot(AxisMaker(dice).make(Pair::parallel, 1), dice, /*limit=*/3.0);
  const JointVector q = robot.random_configurations(30, kSeed).row(14);
  RootSweep sweep = sweep_of(robot);
  find(sweep, robot, robot.fk(q));
  EXPECT_TRUE(holds(sweep, robot, q, 0.1) || !sweep.is_certain());
}

}  // namespace
