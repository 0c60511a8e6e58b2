// SPDX-License-Identifier: BSD-3-Clause
// The descent-only tree against the exact search over the same samples: how many of a target's
// nearest samples a leaf's block holds, and how many targets the block alone solves.
//
// Usage: bench_recall [TARGETS]
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <iksel/iksel.hpp>
#include <string>
#include <vector>

#include "database/data.hpp"
#include "simd/lane_types.hpp"

namespace {

struct Arm {
  const char* name;
  const char* base;
  const char* tip;
};
constexpr Arm kArms[] = {
    {"cvr038", "cvr038_base", "cvr038_flange"},
    {"ur3_wrs", "ur3_base", "ur3_flange"},
    {"irb14050", "irb14050_base", "irb14050_flange"},
};

/// How many of the block's columns are samples among `nearest`, told by their pose rows.
int held(const iksel::DatabaseData& data, const float* block, const iksel::Neighbour* nearest) {
  std::vector<float> column(static_cast<std::size_t>(iksel::lanes::block_rows(data.dof)) *
                            iksel::lanes::kBlock);
  int count = 0;
  for (int n = 0; n < iksel::lanes::kBlock; ++n) {
    iksel::write_to_block(data, nearest[n].index, 0, column.data());
    for (int entry = 0; entry < iksel::lanes::kBlock; ++entry) {
      bool same = true;
      for (int row = 0; row < iksel::lanes::block_rows(data.dof) && same; ++row) {
        same = column[static_cast<std::size_t>(row * iksel::lanes::kBlock)] ==
               block[row * iksel::lanes::kBlock + entry];
      }
      if (same) {
        ++count;
        break;
      }
    }
  }
  return count;
}

}  // namespace

int main(int argc, char** argv) {
  const std::size_t targets = argc > 1 ? std::strtoul(argv[1], nullptr, 10) : 10'000;
  std::printf("%zu targets uniform in the limits, seed 1; blocks of %d samples\n", targets,
              iksel::lanes::kBlock);
  std::printf("%-10s %8s %8s %12s %18s\n", "robot", "samples", "leaves", "recall [%]",
              "first block [%]");
  for (const Arm& arm : kArms) {
    iksel::RobotOptions frames;
    frames.base_link = arm.base;
    frames.tip_link = arm.tip;
    const iksel::Robot robot = iksel::Robot::from_urdf_file(
        std::string(IKSEL_ROBOTS_DIR) + "/" + arm.name + ".urdf", frames);
    iksel::SolverOptions options;
    // A pack's worth of seeds after the other, until the block is used up.
    options.max_attempts = iksel::lanes::kBlock;
    const iksel::Solver solver(robot, options);
    const iksel::DatabaseData& data = solver.database().data();
    const Eigen::MatrixXd q = robot.random_configurations(targets, 1);
    std::size_t recalled = 0;
    std::size_t solved = 0;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const iksel::Pose target = robot.fk(q.row(i));
      double key[12];
      data.make_key(target, key);
      iksel::Neighbour nearest[iksel::lanes::kBlock];
      data.tree->nearest(key, iksel::lanes::kBlock, nearest);
      recalled += static_cast<std::size_t>(held(data, data.leaves.block(key), nearest));
      solved += solver.solve(target).success() ? 1U : 0U;
    }
    const auto n = static_cast<double>(targets);
    std::printf("%-10s %8zu %8zu %12.1f %18.2f\n", arm.name, data.size, data.leaves.leaves(),
                100.0 * static_cast<double>(recalled) / n / iksel::lanes::kBlock,
                100.0 * static_cast<double>(solved) / n);
  }
}
