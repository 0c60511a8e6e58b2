// SPDX-License-Identifier: BSD-3-Clause
// loop PROBLEM ANSWERS
//
// The damped loop of bench/rivals/pinocchio.py in C++ over the same library: what its users get who
// do not stay in Python. Reads what bench/cpp/baselines/problem.hpp describes, writes what its
// main.cpp does. bench/rivals/pinocchio_cpp.py compiles it with the headers of the wheel `pin`.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/multibody.hpp>
#include <pinocchio/spatial.hpp>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

namespace pin = pinocchio;
using Clock = std::chrono::steady_clock;
using Matrix6x = Eigen::Matrix<double, 6, Eigen::Dynamic>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

constexpr double kTolerance = 1e-6;
constexpr double kDamping = 1e-6;
constexpr int kIterations = 60;
constexpr int kStarts = 20;
constexpr std::size_t kWarmUp = 5;
constexpr double kTurn = 2 * 3.14159265358979323846;

struct Problem {
  pin::Model model;
  pin::FrameIndex tip = 0;
  Eigen::VectorXd lower, upper;
  std::vector<pin::SE3> targets;
  std::vector<Eigen::VectorXd> starts;
};

class Reader {
 public:
  explicit Reader(const std::string& path) : file_(path) {
    if (!file_) throw std::runtime_error("cannot read " + path);
  }
  double number() {
    std::string word;
    if (!(file_ >> word)) throw std::runtime_error("the problem file ends early");
    return std::stod(word);
  }
  pin::SE3 frame() {
    Eigen::Matrix3d rotation;
    Eigen::Vector3d position;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) rotation(row, column) = number();
      position(row) = number();
    }
    return {rotation, position};
  }

 private:
  std::ifstream file_;
};

Problem read_problem(const std::string& path) {
  Reader in(path);
  Problem problem;
  const auto dof = static_cast<Eigen::Index>(in.number());
  std::vector<pin::SE3> offsets;
  for (Eigen::Index i = 0; i <= dof; ++i) offsets.push_back(in.frame());
  problem.lower.resize(dof);
  problem.upper.resize(dof);
  pin::JointIndex parent = 0;
  for (Eigen::Index i = 0; i < dof; ++i) {
    const bool prismatic = in.number() != 0;
    problem.lower(i) = in.number();
    problem.upper(i) = in.number();
    if (prismatic || std::isinf(problem.lower(i))) {
      throw std::runtime_error("the loop has joints that turn, with limits");
    }
    const auto& offset = offsets[static_cast<std::size_t>(i)];
    parent = problem.model.addJoint(parent, pin::JointModelRZ(), offset, std::to_string(i));
  }
  const pin::Frame tip("tip", parent, offsets.back(), pin::OP_FRAME);
  problem.tip = problem.model.addFrame(tip);
  const auto count = static_cast<std::size_t>(in.number());
  for (std::size_t i = 0; i < count; ++i) {
    problem.targets.push_back(in.frame());
    Eigen::VectorXd start(dof);
    for (double& value : start) value = in.number();
    problem.starts.push_back(start);
  }
  return problem;
}

class Loop {
 public:
  explicit Loop(const Problem& problem)
      : problem_(problem), data_(problem.model), jacobian_(6, problem.lower.size()) {}

  bool solve(const pin::SE3& target, Eigen::VectorXd& q) {
    for (int start = 0; start < kStarts; ++start) {
      if (search(target, q)) return true;
      for (Eigen::Index i = 0; i < q.size(); ++i) {
        q(i) =
            std::uniform_real_distribution<double>(problem_.lower(i), problem_.upper(i))(random_);
      }
    }
    return false;
  }

 private:
  bool search(const pin::SE3& target, Eigen::VectorXd& q) {
    for (int iteration = 0; iteration < kIterations; ++iteration) {
      pin::computeJointJacobians(problem_.model, data_, q);
      pin::updateFramePlacement(problem_.model, data_, problem_.tip);
      const pin::SE3 error = data_.oMf[problem_.tip].actInv(target);
      const Eigen::Matrix<double, 6, 1> twist = pin::log6(error).toVector();
      if (twist.cwiseAbs().maxCoeff() < kTolerance / 2) return wrap(q);
      jacobian_.setZero();
      pin::getFrameJacobian(problem_.model, data_, problem_.tip, pin::LOCAL, jacobian_);
      Matrix6 log_jacobian;
      pin::Jlog6(error.inverse(), log_jacobian);
      const Matrix6x j = log_jacobian * jacobian_;
      Matrix6 gram = j * j.transpose();
      gram.diagonal().array() += kDamping;
      q += j.transpose() * gram.llt().solve(twist);
    }
    return false;
  }

  bool wrap(Eigen::VectorXd& q) const {
    for (Eigen::Index i = 0; i < q.size(); ++i) {
      const double low = problem_.lower(i);
      const double high = problem_.upper(i);
      if (q(i) < low) q(i) += kTurn * std::ceil((low - q(i)) / kTurn);
      if (q(i) > high) q(i) -= kTurn * std::ceil((q(i) - high) / kTurn);
      if (q(i) < low || q(i) > high) return false;
    }
    return true;
  }

  const Problem& problem_;
  pin::Data data_;
  Matrix6x jacobian_;
  std::mt19937_64 random_{1};
};

void run(const std::string& from, const std::string& to) {
  const Problem problem = read_problem(from);
  Loop loop(problem);
  std::FILE* out = std::fopen(to.c_str(), "w");
  if (out == nullptr) throw std::runtime_error("cannot write " + to);
  // The first targets twice: the first time warms the caches.
  const std::size_t warm_up = std::min(problem.targets.size(), kWarmUp);
  for (std::size_t i = 0; i < warm_up + problem.targets.size(); ++i) {
    const std::size_t target = i < warm_up ? i : i - warm_up;
    Eigen::VectorXd q = problem.starts[target];
    const auto begin = Clock::now();
    const bool solved = loop.solve(problem.targets[target], q);
    const auto time = std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - begin);
    if (i < warm_up) continue;
    std::fprintf(out, "%d %lld", solved ? 1 : 0, static_cast<long long>(time.count()));
    for (const double value : q) std::fprintf(out, " %.17g", value);
    std::fputc('\n', out);
  }
  if (std::fclose(out) != 0) throw std::runtime_error("cannot write " + to);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc != 3) throw std::runtime_error("usage: loop PROBLEM ANSWERS");
    run(argv[1], argv[2]);
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "loop: %s\n", error.what());
    return 2;
  }
}
