// SPDX-License-Identifier: BSD-3-Clause
// Wishes of a single call: deadlines, the same bits again, and which are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <iksel/iksel.hpp>
#include <string>
#include <vector>

#include "robots.hpp"

namespace {

using iksel::JointVector;
using iksel::Pose;
using iksel::Result;
using iksel::Solver;
using iksel::SolveRequest;
using iksel::Status;

TEST(Deadline, EndsTheSearch) {
  const Solver& solver = iksel_test::solver("ur3");
  const Pose target = solver.robot().fk(JointVector::Constant(6, 0.5));
  SolveRequest request;
  request.deadline = 1e-9;
  const Result result = solver.solve(target, request);
  EXPECT_EQ(result.status, Status::out_of_time);
  EXPECT_EQ(result.attempts, 0);
  request.deadline = 1e9;
  EXPECT_TRUE(solver.solve(target, request).success());
}

TEST(Deadline, IsNoReasonWhereThereProvablyIsNoAnswer) {
  const Solver& solver = iksel_test::solver("iiwa14");
  const auto q = solver.robot().random_configurations(100, iksel_test::seed());
  int proven = 0;
  for (int i = 0; i + 1 < 100; ++i) {
    Pose target = solver.robot().fk(JointVector(q.row(i)));
    target.translation() = solver.robot().fk(JointVector(q.row(i + 1))).translation();
    SolveRequest request;
    request.near = JointVector(q.row(i));
    request.deadline = 1e-9;
    const Result result = solver.solve(target, request);
    if (result.success() || result.proof == iksel::Proof::none) continue;
    ++proven;
    EXPECT_NE(result.status, Status::out_of_time) << "target " << i;
  }
  EXPECT_GT(proven, 0);
}

TEST(Requests, SameInputSameBits) {
  for (const char* name : {"ur3", "panda"}) {
    const Solver& solver = iksel_test::solver(name);
    const Eigen::MatrixXd q = solver.robot().random_configurations(50, iksel_test::seed());
    std::vector<JointVector> first;
    for (int repeat = 0; repeat < 2; ++repeat) {
      for (int i = 0; i < 50; ++i) {
        SolveRequest request;
        request.near = q.row((i + 1) % 50).transpose();
        const Result result = solver.solve(solver.robot().fk(q.row(i)), request);
        ASSERT_TRUE(result.success());
        if (repeat == 0) {
          first.push_back(result.q);
        } else {
          EXPECT_EQ(first[static_cast<std::size_t>(i)], result.q);
        }
      }
    }
  }
}

TEST(Requests, WithoutWishesAreThePlainSolve) {
  const Solver& solver = iksel_test::solver("panda");
  const Eigen::MatrixXd q = solver.robot().random_configurations(50, iksel_test::seed());
  SolveRequest request;
  request.weights = JointVector::Constant(7, 2.0);
  request.norm = iksel::MoveNorm::max;
  for (int i = 0; i < 50; ++i) {
    const Pose target = solver.robot().fk(q.row(i));
    EXPECT_EQ(solver.solve(target, request).q, solver.solve(target).q);
  }
}

TEST(Requests, BadOnesAreNamed) {
  const Solver& solver = iksel_test::solver("ur3");
  const Pose target = Pose::Identity();
  const auto expect_error = [&](const SolveRequest& request, const std::string& what) {
    try {
      (void)solver.solve(target, request);
      FAIL() << what;
    } catch (const iksel::InvalidArgumentError& error) {
      EXPECT_NE(std::string(error.what()).find(what), std::string::npos) << error.what();
    }
  };
  SolveRequest request;
  request.near = JointVector::Zero(5);
  expect_error(request, "near");
  request = {};
  request.weights = JointVector::Constant(6, -1.0);
  expect_error(request, "weights[0]");
  request.weights = JointVector::Zero(6);
  expect_error(request, "weights");
  request = {};
  request.seeds = {JointVector::Zero(6), JointVector::Constant(6, NAN)};
  expect_error(request, "seeds[1]");
  request = {};
  request.near = JointVector::Constant(6, NAN);
  expect_error(request, "near");
  request = {};
  request.weights = JointVector::Constant(6, NAN);
  expect_error(request, "weights");
  request.weights = JointVector::Ones(7);
  expect_error(request, "weights");
  request = {};
  request.norm = static_cast<iksel::MoveNorm>(7);
  expect_error(request, "norm: not a value of MoveNorm (two, max)");
  request = {};
  for (const double deadline : {0.0, -1.0, double(NAN)}) {
    request.deadline = deadline;
    expect_error(request, "deadline");
  }
}

}  // namespace
