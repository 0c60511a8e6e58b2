// SPDX-License-Identifier: BSD-3-Clause
// Scenes: the lanes of every instruction set against distances one by one, and points in a grid
// against all points.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <random>
#include <vector>

#include "iksel/error.hpp"
#include "iksel/scene.hpp"
#include "levels.hpp"
#include "robots.hpp"
#include "scene/point_grid.hpp"
#include "scene/scene_data.hpp"

namespace {

using iksel::JointVector;
using iksel::Obstacle;
using iksel::PointCloud;
using iksel::Pose;
using iksel::Robot;
using iksel::RobotSpheres;
using iksel::Scene;

/// Balls along each link of the chain to the next, of which some have many.
RobotSpheres balls_on(const Robot& robot) {
  RobotSpheres spheres;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(0, 1);
  const std::vector<Pose> poses = robot.link_poses(JointVector::Zero(robot.dof()));
  const auto& names = robot.link_names();
  const std::size_t last = names.size() - 1;
  for (std::size_t i = 0; i < last; ++i) {
    const Eigen::Vector3d next = poses[i].inverse() * poses[i + 1].translation();
    auto& of_link = spheres.links[names[i]];
    of_link = {{Eigen::Vector3d::Zero(), 0.04}, {0.5 * next, 0.03}};
    const int more = i % 6 == 3 ? 600 : i % 3 == 0 ? 60 : (i % 3 == 1 ? 9 : 0);
    for (int k = 0; k < more; ++k) {
      const Eigen::Vector3d aside = 0.03 * Eigen::Vector3d(uniform(random), uniform(random), 0);
      of_link.push_back({uniform(random) * next + aside, 0.02 * uniform(random) + 0.001});
    }
  }
  // Neighbours touch always, and so do links that have no joint between them.
  for (std::size_t i = 0; i + 4 < last; i += 2)
    spheres.pairs.emplace_back(names[i], names[last - 1]);
  return spheres;
}

Scene furnished(const Robot& robot, unsigned seed) {
  Scene scene(robot, balls_on(robot));
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-0.7, 0.7);
  const auto place = [&] {
    Pose pose = Pose::Identity();
    pose.translation() << uniform(random), uniform(random), uniform(random);
    pose.rotate(Eigen::AngleAxisd(uniform(random), Eigen::Vector3d(1, 2, 3).normalized()));
    return pose;
  };
  scene.set("box", Obstacle::box({0.2, 0.1, 0.3}, place(), 0.01));
  scene.set("ball", Obstacle::sphere(0.1, place()));
  scene.set("capsule", Obstacle::capsule(0.05, 0.3, place(), 0.02));
  scene.set("cylinder", Obstacle::cylinder(0.1, 0.3, place()));
  Pose floor = Pose::Identity();
  floor.translation().z() = -0.2;
  scene.set("floor", Obstacle::half_space(floor));
  scene.set("points", Obstacle::point_cloud(PointCloud::Random(60, 3) * 0.2, 0.01, place()));
  return scene;
}

TEST(SceneLanes, AgreeWithTheDepthsOfContactsAtEveryLevel) {
  for (const char* name : {"ur3", "panda", "valkyrie_waist_right_arm"}) {
    const Robot& robot = iksel_test::robot(name);
    const iksel::Matrix q = robot.random_configurations(100, 3);
    std::vector<double> rows;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      const JointVector row = q.row(i);
      rows.insert(rows.end(), row.data(), row.data() + row.size());
    }
    int found = 0;
    for (const std::string& level : iksel_test::levels()) {
      const iksel_test::ForcedLevel forced(level);
      for (unsigned seed = 0; seed < 5; ++seed) {
        const Scene scene = furnished(robot, seed);
        // Packs that are not full, too.
        for (const std::size_t count : {std::size_t{100}, std::size_t{13}, std::size_t{1}}) {
          const std::unique_ptr<bool[]> free(new bool[count]());
          scene.find_free(rows.data(), count, free.get());
          for (std::size_t i = 0; i < count; ++i) {
            const JointVector at = q.row(static_cast<Eigen::Index>(i));
            const bool touches = !scene.contacts(at).empty();
            EXPECT_NE(free[i], touches) << name << " at " << level << ", scene " << seed;
            found += static_cast<int>(free[i]);
          }
        }
      }
    }
    EXPECT_GT(found, 20) << name;
  }
}

TEST(SceneLanes, TakeAnglesOfAnySizeAndNothingElse) {
  const Robot& robot = iksel_test::robot("ur3");
  const iksel::Matrix q = robot.random_configurations(60, 3);
  for (const std::string& level : iksel_test::levels()) {
    const iksel_test::ForcedLevel forced(level);
    const Scene scene = furnished(robot, 1);
    int found = 0;
    bool none_is_free = true;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      JointVector far = q.row(i);
      far[i % 6] *= std::pow(10.0, 5.0 * static_cast<double>(i % 60));
      const bool is_free = scene.is_free(far);
      EXPECT_NE(is_free, !scene.contacts(far).empty()) << far.transpose() << " at " << level;
      found += static_cast<int>(is_free);
      for (const double none : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        JointVector bad = q.row(i);
        bad[i % 6] = none;
        scene.find_free(bad.data(), 1, &none_is_free);
        EXPECT_FALSE(none_is_free) << bad.transpose() << " at " << level;
      }
    }
    EXPECT_GT(found, 5) << level;
    EXPECT_LT(found, 55) << level;
  }
}

TEST(Scene, ShapesHaveTheirOwnSizesOnly) {
  const Robot& robot = iksel_test::robot("ur3");
  const iksel::Matrix q = robot.random_configurations(40, 3);
  const Pose place = robot.fk(JointVector::Zero(6));
  for (const double left_over : {1.0, std::nan("")}) {
    for (Obstacle obstacle : {Obstacle::sphere(0.1, place), Obstacle::box({0.2, 0.1, 0.3}, place),
                              Obstacle::capsule(0.05, 0.3, place)}) {
      const bool is_box = obstacle.shape == Obstacle::Shape::box;
      if (is_box) obstacle.radius = left_over;
      if (!is_box) obstacle.size.setConstant(left_over);
      if (obstacle.shape != Obstacle::Shape::capsule) obstacle.length = left_over;
      Scene scene(robot, balls_on(robot));
      scene.set("it", obstacle);
      for (Eigen::Index i = 0; i < q.rows(); ++i) {
        const JointVector at = q.row(i);
        EXPECT_EQ(scene.is_free(at), scene.contacts(at).empty()) << to_string(obstacle.shape);
      }
    }
  }
}

TEST(Scene, WhatIsTooLargeIsRefused) {
  const Robot& robot = iksel_test::robot("ur3");
  Scene scene(robot, balls_on(robot));
  const Pose here = Pose::Identity();
  PointCloud points(2, 3);
  points << -1.7e308, 0, 0, 1.7e308, 0, 0;
  Pose far = here;
  far.translation().x() = 1e200;
  for (const Obstacle& obstacle :
       {Obstacle::point_cloud(points, 0.1, here), Obstacle::sphere(1e200, here),
        Obstacle::box({1, 1e9, 1}, here), Obstacle::capsule(1, 1e9, here),
        Obstacle::half_space(here, 1e9), Obstacle::sphere(1, far)}) {
    EXPECT_THROW(scene.set("it", obstacle), iksel::InvalidArgumentError);
  }
  scene.set("it", Obstacle::sphere(1, here));
  EXPECT_THROW(scene.move("it", far), iksel::InvalidArgumentError);
  EXPECT_THROW(scene.attach("cup", {robot.tip_link(), {{{0, 0, 1e200}, 0.1}}, {}}),
               iksel::InvalidArgumentError);
  EXPECT_THROW(scene.attach("cup", {robot.tip_link(), {{{0, 0, 0}, 1e200}}, {}}),
               iksel::InvalidArgumentError);
}

TEST(PointGrid, TouchesWhatAllPointsTouch) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const double extent : {0.0, 0.01, 0.5, 20.0}) {
    PointCloud points(200, 3);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      points.row(i) << extent * uniform(random), extent * uniform(random), 0.3 * extent;
    }
    const iksel::PointGrid grid(points);
    int touched = 0;
    for (int i = 0; i < 5000; ++i) {
      const Eigen::Vector3d c(1.2 * extent * uniform(random) + 0.03 * uniform(random),
                              1.2 * extent * uniform(random), 0.3 * extent + 0.1 * uniform(random));
      const double radius = (0.02 + 0.2 * extent) * (1 + uniform(random));
      const double nearest = (points.rowwise() - c.transpose()).rowwise().norm().minCoeff();
      double clearance = 1;
      EXPECT_EQ(grid.touches(c, radius, clearance), nearest <= radius) << extent;
      if (nearest <= radius) {
        EXPECT_LE(clearance, 0) << extent;
        EXPECT_GE(clearance, nearest * nearest - radius * radius - 1e-12) << extent;
      }
      EXPECT_TRUE(nearest > radius || grid.may_touch(c, radius)) << extent;
      EXPECT_NEAR(grid.nearest(c), nearest, 1e-12);
      touched += static_cast<int>(nearest <= radius);
    }
    EXPECT_GT(touched, 100) << extent;
    EXPECT_LT(touched, 4900) << extent;
  }
}

TEST(TargetShape, TouchesOnlyWhereNoConfigurationIsFree) {
  for (const char* name : {"ur3", "panda", "iiwa14"}) {
    const Robot& robot = iksel_test::robot(name);
    const iksel::Matrix q = robot.random_configurations(200, 6);
    int found = 0;
    int collided = 0;
    for (unsigned seed = 0; seed < 5; ++seed) {
      Scene scene = furnished(robot, seed);
      if (seed % 2 == 1) {
        scene.attach("cup", {robot.tip_link(), {{Eigen::Vector3d(0, 0.1, 0.2), 0.07}}, {}});
      }
      for (Eigen::Index i = 0; i < q.rows(); ++i) {
        const JointVector at = q.row(i);
        const bool is_free = scene.is_free(at);
        const bool touches = scene.data().touches_at(robot.fk(at), 1e-6, 1e-6);
        EXPECT_FALSE(is_free && touches) << name << ", scene " << seed << ", row " << i;
        found += static_cast<int>(touches);
        collided += static_cast<int>(!is_free);
      }
    }
    EXPECT_GT(found, 50) << name;
    EXPECT_LT(found, collided) << name;
  }
}

TEST(TargetShape, AnswersSayThatTheTargetTouches) {
  const Robot& robot = iksel_test::robot("panda");
  const iksel::Solver solver(robot);
  const JointVector q = robot.random_configurations(1, 8).row(0);
  const Pose target = robot.fk(q);
  iksel::SolveRequest request;
  request.scene.emplace(robot, balls_on(robot));
  request.scene->set("post", Obstacle::sphere(0.05, target));
  for (const bool has_near : {false, true}) {
    if (has_near) request.near = q;
    const iksel::Result result = solver.solve(target, request);
    EXPECT_EQ(result.status, iksel::Status::in_collision);
    EXPECT_EQ(result.proof, iksel::Proof::target);
  }
  const iksel::Solutions all = solver.solve_all(target, {}, request);
  EXPECT_EQ(all.status, iksel::Status::in_collision);
  EXPECT_EQ(all.proof, iksel::Proof::target);
  // What cannot be reached at all does not collide.
  Pose beyond = target;
  beyond.translation() *= 100;
  request.scene->set("post", Obstacle::sphere(0.05, beyond));
  EXPECT_EQ(solver.solve(beyond, request).status, iksel::Status::out_of_reach);
}

TEST(Scene, ASecondOpinionCountsWhereSpheresRefuse) {
  const Robot& robot = iksel_test::robot("panda");
  const iksel::Solver solver(robot);
  const JointVector q = robot.random_configurations(1, 9).row(0);
  const Pose target = robot.fk(q);
  iksel::SolveRequest request;
  request.scene.emplace(robot, balls_on(robot));
  request.scene->set("post", Obstacle::sphere(0.05, target));
  int asked = 0;
  request.exact = [&](const double* rows, std::size_t count, bool* free) {
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_FALSE(request.scene->is_free(Eigen::Map<const Eigen::VectorXd>(rows + 7 * i, 7)));
      free[i] = rows[7 * i] > 0;
      ++asked;
    }
  };
  const iksel::Result result = solver.solve(target, request);
  ASSERT_TRUE(result.success());
  EXPECT_GT(result.q[0], 0);
  EXPECT_GT(asked, 0);
  for (const iksel::Result& answer : solver.solve_all(target, {}, request).all) {
    EXPECT_GT(answer.q[0], 0);
  }
  const std::vector<iksel::Result> batch = solver.solve_batch({target, target}, request);
  EXPECT_TRUE(batch[0].success() && batch[1].success());
  request.exact = [](const double*, std::size_t count, bool* free) {
    std::fill_n(free, count, false);
  };
  EXPECT_EQ(solver.solve(target, request).status, iksel::Status::in_collision);
  request.scene.reset();
  EXPECT_THROW(solver.solve(target, request), iksel::InvalidArgumentError);
}

TEST(Scene, CopiesDoNotSeeWhatIsDoneToAnother) {
  const Robot& robot = iksel_test::robot("panda");
  const Scene scene = furnished(robot, 1);
  Scene other = scene;
  other.remove("box");
  other.attach("cup", {robot.tip_link(), {{Eigen::Vector3d::Zero(), 0.1}}, {}});
  EXPECT_EQ(scene.obstacles().size(), other.obstacles().size() + 1);
  EXPECT_TRUE(scene.attached().empty());
}

TEST(Scene, FirstAnswersAreFree) {
  for (const char* name : {"ur3", "cvr038", "panda", "irb14050"}) {
    const Robot& robot = iksel_test::robot(name);
    const iksel::Solver solver(robot);
    const iksel::Matrix q = robot.random_configurations(60, 4);
    int solved = 0;
    int collided = 0;
    for (Eigen::Index i = 0; i < q.rows(); ++i) {
      iksel::SolveRequest request;
      request.scene = furnished(robot, static_cast<unsigned>(i));
      const JointVector known = q.row(i);
      const iksel::Result result = solver.solve(robot.fk(known), request);
      solved += static_cast<int>(result.success());
      collided += static_cast<int>(result.status == iksel::Status::in_collision);
      if (result.success()) EXPECT_TRUE(request.scene->is_free(result.q)) << name << i;
      // A six-joint arm's own configuration is one of its branches.
      if (robot.dof() == 6 && request.scene->is_free(known)) {
        EXPECT_TRUE(result.success()) << name << i;
      }
    }
    EXPECT_GT(solved, 3) << name;
    EXPECT_EQ(solved + collided, 60) << name;
  }
}

}  // namespace
