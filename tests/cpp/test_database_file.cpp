// SPDX-License-Identifier: BSD-3-Clause
// A saved database comes back as it was, or not at all.
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iksel/iksel.hpp>
#include <limits>

#include "base/hash.hpp"
#include "base/random.hpp"
#include "database/file.hpp"
#include "robots.hpp"

namespace {

namespace fs = std::filesystem;
using iksel::Database;
using iksel::DatabaseOptions;
using iksel::Robot;

constexpr std::size_t kHeader = 512;

class DatabaseFile : public testing::Test {
 protected:
  void SetUp() override {
    folder_ =
        fs::temp_directory_path() / ("iksel-" + std::to_string(::getpid()) + "-" +
                                     testing::UnitTest::GetInstance()->current_test_info()->name());
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static Database make(std::size_t samples = 500) {
    DatabaseOptions options;
    options.samples = samples;
    return Database::build(iksel_test::robot("cvr038"), options);
  }

  [[nodiscard]] fs::path path(const std::string& name) const { return folder_ / name; }
  [[nodiscard]] std::size_t files() const {
    std::size_t count = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_)) ++count;
    return count;
  }

  static void write(const fs::path& path, const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
  }
  static std::string read(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

 private:
  fs::path folder_;
};

TEST_F(DatabaseFile, ComesBackBitForBit) {
  const Database database = make();
  database.save(path("d.iksel"));
  const Database loaded = Database::load(path("d.iksel"));
  EXPECT_EQ(loaded.to_bytes(), database.to_bytes());
  EXPECT_EQ(loaded.size(), database.size());
  EXPECT_EQ(loaded.options().samples, database.options().samples);
  EXPECT_EQ(loaded.chain_hash(), database.chain_hash());
  EXPECT_EQ(Database::from_bytes(database.to_bytes()).to_bytes(), database.to_bytes());
  EXPECT_EQ(files(), 1U);
}

TEST_F(DatabaseFile, CarriesHowTheSamplesWereMade) {
  iksel::DatabaseOptions options = iksel::DatabaseOptions::paper(2026);
  options.samples = 50;
  options.kmeans_pool = 777;
  options.kmeans_rounds = 3;
  const Database database = Database::build(iksel_test::robot("cvr038"), options);
  const iksel::DatabaseOptions read = Database::from_bytes(database.to_bytes()).options();
  EXPECT_EQ(read.sampling, iksel::Sampling::kmeans);
  EXPECT_EQ(read.kmeans_pool, 777U);
  EXPECT_EQ(read.kmeans_rounds, 3);
  // Files of other samplings are as they were before there was this one.
  const std::string others = make(50).to_bytes();
  const std::size_t reserved = kHeader - sizeof(std::uint64_t) - 184;
  EXPECT_EQ(others.substr(reserved, 184), std::string(184, '\0'));
  EXPECT_EQ(Database::from_bytes(others).options().kmeans_pool,
            iksel::DatabaseOptions{}.kmeans_pool);
}

TEST_F(DatabaseFile, ServesTheSameSolver) {
  const Robot& robot = iksel_test::robot("cvr038");
  iksel::SolverOptions options = iksel::SolverOptions::paper();
  options.database.scale = iksel::Scale::small;
  const iksel::Solver built(robot, options);
  built.database().save(path("d.iksel"));
  const iksel::Solver loaded(robot, options, Database::load(path("d.iksel")));
  const Eigen::MatrixXd q = robot.random_configurations(200, iksel_test::seed());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const iksel::Result a = built.solve(robot.fk(q.row(i)));
    const iksel::Result b = loaded.solve(robot.fk(q.row(i)));
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.q, b.q);
  }
}

TEST_F(DatabaseFile, AnyFlippedByteIsRefused) {
  const std::string good = make(60).to_bytes();
  iksel::Random random(iksel_test::seed());
  // Every byte of the header, then random ones of the content.
  for (std::size_t trial = 0; trial < kHeader + 1000; ++trial) {
    const std::size_t at =
        trial < kHeader ? trial : kHeader + random.next() % (good.size() - kHeader);
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ static_cast<char>(1 + random.next() % 255));
    EXPECT_THROW(Database::from_bytes(bad), iksel::DatabaseError) << "byte " << at;
    if (trial % 50 == 0) {
      write(path("bad.iksel"), bad);
      EXPECT_THROW(Database::load(path("bad.iksel")), iksel::DatabaseError) << "byte " << at;
    }
  }
}

TEST_F(DatabaseFile, AnyOtherLengthIsRefused) {
  const std::string good = make(60).to_bytes();
  for (std::size_t size = 0; size < good.size(); size += size < 300 ? 1 : 997) {
    write(path("short.iksel"), good.substr(0, size));
    EXPECT_THROW(Database::load(path("short.iksel")), iksel::DatabaseCorruptError) << size;
  }
  write(path("long.iksel"), good + "x");
  EXPECT_THROW(Database::load(path("long.iksel")), iksel::DatabaseCorruptError);
}

TEST_F(DatabaseFile, MissingFilesAndFoldersAreNamed) {
  try {
    Database::load(path("none.iksel"));
    FAIL();
  } catch (const iksel::DatabaseIoError& error) {
    EXPECT_NE(std::string(error.what()).find("none.iksel"), std::string::npos);
  }
  EXPECT_THROW(Database::load(path("")), iksel::DatabaseIoError);
  EXPECT_THROW(make(10).save(path("no-folder/d.iksel")), iksel::DatabaseIoError);
}

TEST_F(DatabaseFile, AnotherRobotsDatabaseIsRefused) {
  const Robot& other = iksel_test::robot("cvrb1213");
  EXPECT_THROW(iksel::Solver(other, {}, make(10)), iksel::DatabaseMismatchError);
}

TEST_F(DatabaseFile, AnotherToolsDatabaseServes) {
  const Robot& robot = iksel_test::robot("cvr038");
  EXPECT_NO_THROW(iksel::Solver(robot.with_tcp(iksel::Pose::Identity()), {}, make(10)));
}

TEST_F(DatabaseFile, AFullDiskLeavesTheOldFile) {
  make(20).save(path("d.iksel"));
  const std::string old = read(path("d.iksel"));

  // A file may not grow beyond 8 KiB: writes fail as on a full disk.
  rlimit before{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto previous = std::signal(SIGXFSZ, SIG_IGN);
  rlimit tight = before;
  tight.rlim_cur = 8192;
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &tight), 0);
  EXPECT_THROW(make(500).save(path("d.iksel")), iksel::DatabaseIoError);
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
  std::signal(SIGXFSZ, previous);

  EXPECT_EQ(read(path("d.iksel")), old);
  EXPECT_EQ(files(), 1U) << "the half-written file is still there";
}

TEST_F(DatabaseFile, SavingOverALoadedFileChangesNothing) {
  for (const bool mmap : {false, true}) {
    make(50).save(path("d.iksel"));
    const Database loaded = Database::load(path("d.iksel"), mmap);
    const std::string bytes = loaded.to_bytes();
    make(70).save(path("d.iksel"));
    EXPECT_EQ(loaded.to_bytes(), bytes);
    EXPECT_EQ(Database::load(path("d.iksel"), mmap).size(), 70U);
  }
}

// Files whose checksums are right and whose content is not.

/// Writes right checksums over a changed header and content.
void sign(std::string& bytes) {
  const auto put = [&](std::size_t at, std::uint64_t value) {
    std::memcpy(&bytes[at], &value, sizeof value);
  };
  put(312, iksel::checksum(&bytes[kHeader], bytes.size() - kHeader));
  put(504, iksel::checksum(bytes.data(), 504));
}

const double kBadNumbers[] = {std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity(), -1e300};

TEST_F(DatabaseFile, SamplesThatAreNotFiniteAreRefused) {
  const std::string good = make(60).to_bytes();
  iksel::Random random(iksel_test::seed());
  for (int trial = 0; trial < 300; ++trial) {
    std::string bad = good;
    const std::size_t doubles = (good.size() - kHeader) / sizeof(double);
    const std::size_t at = kHeader + random.next() % doubles * sizeof(double);
    std::memcpy(&bad[at], &kBadNumbers[trial % 3], sizeof(double));
    sign(bad);
    EXPECT_THROW(Database::from_bytes(bad), iksel::DatabaseCorruptError) << at;
  }
}

TEST_F(DatabaseFile, OlderFilesMayHaveAnOptionThatWasNotRead) {
  std::string old = make(60).to_bytes();
  const std::uint64_t cvt_updates = 5;
  std::memcpy(&old[64], &cvt_updates, sizeof cvt_updates);
  sign(old);
  EXPECT_EQ(Database::from_bytes(old).options().cvt_updates, DatabaseOptions{}.cvt_updates);
}

TEST_F(DatabaseFile, SignedHeadersOfAnyContentAreRefusedOrServe) {
  const Robot& robot = iksel_test::robot("cvr038");
  const iksel::Pose target = robot.fk(robot.random_configurations(1, 1).row(0));
  const std::string good = make(60).to_bytes();
  iksel::Random random(iksel_test::seed());
  int refused = 0;
  for (int trial = 0; trial < iksel_test::cases(2000); ++trial) {
    std::string bad = good;
    for (std::uint64_t changes = 1 + random.next() % 2; changes > 0; --changes) {
      // Not what the checksums are, and more often small numbers than any.
      const std::size_t at = 16 + random.next() % 72 * 4;
      std::uint64_t value = random.next() % 16;
      if (random.next() % 4 == 0) value = random.next();
      if (random.next() % 4 == 0) std::memcpy(&value, &kBadNumbers[random.next() % 3], 8);
      std::memcpy(&bad[at], &value, random.next() % 2 == 0 ? 4 : 8);
    }
    sign(bad);
    try {
      const iksel::Solver solver(robot, {}, Database::from_bytes(bad));
      (void)solver.solve(target);
    } catch (const iksel::DatabaseError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

TEST(DatabaseBuild, ChainsOutOfScaleAreRefused) {
  for (const char* length : {"1e160", "1e200", "1e306"}) {
    const std::string x = std::string("<origin xyz=\"") + length + " 0 0\"/>";
    const auto joint = [&](int i) {
      const std::string n = std::to_string(i);
      return "<joint name=\"j" + n + "\" type=\"revolute\"><parent link=\"l" + n +
             "\"/><child link=\"l" + std::to_string(i + 1) + "\"/>" + x + "<axis xyz=\"0 " +
             (i % 2 == 0 ? "1 0" : "0 1") +
             "\"/><limit lower=\"-3\" upper=\"3\" effort=\"1\" velocity=\"1\"/></joint><link "
             "name=\"l" +
             std::to_string(i + 1) + "\"/>";
    };
    std::string urdf = "<robot name=\"r\"><link name=\"l0\"/>";
    for (int i = 0; i < 6; ++i) urdf += joint(i);
    urdf += "</robot>";
    iksel::RobotOptions options;
    options.base_link = "l0";
    options.tip_link = "l6";
    for (const auto scheme : {iksel::KeyScheme::reduced, iksel::KeyScheme::full}) {
      DatabaseOptions of_database;
      of_database.samples = 100;
      of_database.key_scheme = scheme;
      EXPECT_THROW(Database::build(Robot::from_urdf_string(urdf, options), of_database),
                   iksel::Error)
          << length;
    }
  }
}

// Files that others write to while they are in use.

/// Solves reachable poses and others, with and without wishes.
int solve_everything(const iksel::Solver& solver) {
  const Robot& robot = solver.robot();
  iksel_test::Judge judge(robot);
  const Eigen::MatrixXd q = robot.random_configurations(10, iksel_test::seed());
  int solved = 0;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    iksel::Pose target = robot.fk(q.row(i));
    for (int k = 0; k < 2; ++k) {
      iksel::SolveRequest near;
      near.near = q.row(0).transpose();
      iksel::SolveRequest task;
      task.task = iksel::Task::position_only();
      for (const iksel::Result& result :
           {solver.solve(target), solver.solve(target, near), solver.solve(target, task)}) {
        solved += result.success();
        if (!result.success() || result.status != iksel::Status::solved) continue;
        const auto error = iksel::pose_error(target, judge.fk(result.q));
        EXPECT_LE(error.head<3>().norm(), 1.0001 * solver.options().position_tolerance);
      }
      target.rotate(Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()));
    }
  }
  return solved;
}

iksel::SolverOptions small(bool paper) {
  iksel::SolverOptions options = paper ? iksel::SolverOptions::paper() : iksel::SolverOptions();
  options.database.scale = iksel::Scale::small;
  return options;
}

TEST_F(DatabaseFile, WhatHappensToTheFileIsNothingToWhatWasLoaded) {
  const Robot& robot = iksel_test::robot("cvr038");
  for (const bool paper : {false, true}) {
    const iksel::SolverOptions options = small(paper);
    Database::build(robot, options.database).save(path("d.iksel"));
    const Database loaded = Database::load(path("d.iksel"));
    const std::string bytes = loaded.to_bytes();
    const iksel::Solver solver(robot, options, loaded);
    const int before = solve_everything(solver);
    write(path("d.iksel"), std::string(bytes.size(), '\xff'));
    EXPECT_EQ(solve_everything(solver), before);
    fs::resize_file(path("d.iksel"), 0);
    EXPECT_EQ(solve_everything(solver), before);
    EXPECT_EQ(loaded.to_bytes(), bytes);
  }
}

TEST_F(DatabaseFile, SolvesEndWhateverIsWrittenIntoAMappedFile) {
  const Robot& robot = iksel_test::robot("cvr038");
  for (const bool paper : {false, true}) {
    const iksel::SolverOptions options = small(paper);
    const Database built = Database::build(robot, options.database);
    std::vector<double> numbers = {0.0, 1e-300};
    numbers.insert(numbers.end(), std::begin(kBadNumbers), std::end(kBadNumbers));
    for (const double number : numbers) {
      built.save(path("d.iksel"));
      const iksel::Solver solver(robot, options, Database::load(path("d.iksel"), true));
      std::fstream file(path("d.iksel"), std::ios::in | std::ios::out | std::ios::binary);
      file.seekp(kHeader);
      const std::vector<double> content((built.bytes() - kHeader) / sizeof(double), number);
      file.write(reinterpret_cast<const char*>(content.data()),
                 static_cast<std::streamsize>(content.size() * sizeof(double)));
      file.close();
      ASSERT_EQ(solver.database().q(7)[2] == number, !std::isnan(number));
      // The blocks of the default database are in memory of their own.
      const int solved = solve_everything(solver);
      if (!paper) EXPECT_GE(solved, 30) << number;
      EXPECT_EQ(solver.database().nearest(iksel::Pose::Identity(), 5).size(), 5U);
    }
  }
}

TEST_F(DatabaseFile, AMappedFileThatIsCutShortIsReported) {
  const Robot& robot = iksel_test::robot("cvr038");
  for (const bool paper : {false, true}) {
    for (const std::size_t left : {std::size_t{0}, std::size_t{100}, std::size_t{20000}}) {
      const iksel::SolverOptions options = small(paper);
      Database::build(robot, options.database).save(path("d.iksel"));
      const Database mapped = Database::load(path("d.iksel"), true);
      const iksel::Solver solver(robot, options, mapped);
      solve_everything(solver);
      fs::resize_file(path("d.iksel"), left);
      EXPECT_THROW((void)mapped.q(mapped.size() - 1), iksel::DatabaseIoError);
      EXPECT_THROW((void)mapped.pose(0), iksel::DatabaseIoError);
      EXPECT_THROW((void)mapped.to_bytes(), iksel::DatabaseIoError);
      EXPECT_THROW(mapped.save(path("other.iksel")), iksel::DatabaseIoError);
      EXPECT_FALSE(fs::exists(path("other.iksel")));
      EXPECT_THROW(solve_everything(solver), iksel::DatabaseIoError);
      EXPECT_THROW(iksel::Solver(robot, options, mapped), iksel::DatabaseIoError);
      // Another of the same name is another.
      make(20).save(path("d.iksel"));
      EXPECT_NO_THROW((void)Database::load(path("d.iksel"), true).to_bytes());
    }
  }
}

TEST_F(DatabaseFile, CutShortBeneathASearchItEnds) {
  const Robot& robot = iksel_test::robot("cvr038");
  const iksel::SolverOptions options = small(true);
  Database::build(robot, options.database).save(path("d.iksel"));
  const iksel::Solver solver(robot, options, Database::load(path("d.iksel"), true));
  fs::resize_file(path("d.iksel"), 5000);
  // The first call meets the lost pages, the second is told of them.
  EXPECT_NO_THROW((void)solver.solve(robot.fk(robot.random_configurations(1, 1).row(0))));
  EXPECT_THROW(solve_everything(solver), iksel::DatabaseIoError);
}

#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)

void touch_a_lost_page(const fs::path& file) {
  std::ofstream(file) << std::string(8192, 'x');
  std::FILE* open = std::fopen(file.c_str(), "r");
  const void* bytes = ::mmap(nullptr, 8192, PROT_READ, MAP_SHARED, ::fileno(open), 0);
  fs::resize_file(file, 0);
  fs::remove_all(file.parent_path());
  (void)*static_cast<const volatile char*>(bytes);
}

TEST_F(DatabaseFile, OtherBusErrorsGoToTheHandlerBefore) {
  // A new process, in which no file was mapped yet.
  testing::FLAGS_gtest_death_test_style = "threadsafe";
  make(20).save(path("d.iksel"));
  EXPECT_EXIT(
      {
        std::signal(SIGBUS, [](int) { ::_exit(42); });
        const Database mapped = Database::load(path("d.iksel"), true);
        touch_a_lost_page(path("own"));
      },
      testing::ExitedWithCode(42), "");
  EXPECT_EXIT(
      {
        const Database mapped = Database::load(path("d.iksel"), true);
        touch_a_lost_page(path("own"));
      },
      testing::KilledBySignal(SIGBUS), "");
}

#endif

// Saves that do not come to their end.

TEST_F(DatabaseFile, KilledSavesLeaveADatabaseAndNoFiles) {
  const Database databases[] = {make(500), make(700)};
  const std::string contents[] = {databases[0].to_bytes(), databases[1].to_bytes()};
  const auto save = [&](int i) {
    iksel::write_file(path("d.iksel"), databases[i % 2].data().storage);
  };
  iksel::Random random(iksel_test::seed());
  save(0);
  int changed = 0;
  const int kills = iksel_test::cases(30, 20);
  for (int kill = 0; kill < kills; ++kill) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      for (int i = kill + 1;; ++i) save(i);
    }
    ::usleep(static_cast<useconds_t>(random.next() % 10000));
    ASSERT_EQ(::kill(child, SIGKILL), 0);
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    ASSERT_TRUE(WIFSIGNALED(status)) << "the child ended by itself";
    const std::string now = read(path("d.iksel"));
    ASSERT_TRUE(now == contents[0] || now == contents[1]) << "kill " << kill;
    ASSERT_LE(files(), 2U) << "kill " << kill;
    changed += now != contents[kill % 2];
  }
  EXPECT_GT(changed, 0) << "no child saved anything";
  save(0);
  EXPECT_EQ(files(), 1U);
}

TEST_F(DatabaseFile, OnlyAbandonedFilesOfOursAreRemoved) {
  const std::string other = "iksel-0123456789abcdef.tmp";
  for (const char* name : {"iksel-0123456789abcde.tmp", "iksel-0123456789abcdeg.tmp", "d.tmp",
                           "iksel-0123456789abcdef.tmp.iksel", "xiksel-0123456789abcdef.tmp"}) {
    write(path(name), "");
  }
  fs::create_directory(path("iksel-fedcba9876543210.tmp"));
  fs::create_symlink(path("d.tmp"), path("iksel-0000000000000000.tmp"));
  const std::size_t before = files();
  write(path(other), "half a dat");
  make(20).save(path("d.iksel"));
  EXPECT_EQ(files(), before + 1);
  EXPECT_FALSE(fs::exists(path(other)));
}

TEST_F(DatabaseFile, SavesAtOnceDoNotDisturbEachOther) {
  const Database databases[] = {make(300), make(400), make(500)};
  std::vector<pid_t> children;
  for (const Database& database : databases) {
    const pid_t child = ::fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      try {
        for (int i = 0; i < 20; ++i) {
          iksel::write_file(path("d.iksel"), database.data().storage);
        }
      } catch (const std::exception& error) {
        std::fputs(error.what(), stderr);
        ::_exit(1);
      }
      ::_exit(0);
    }
    children.push_back(child);
  }
  for (const pid_t child : children) {
    int status = 0;
    ASSERT_EQ(::waitpid(child, &status, 0), child);
    EXPECT_EQ(status, 0);
  }
  EXPECT_NO_THROW((void)Database::load(path("d.iksel")));
  EXPECT_EQ(files(), 1U);
}

}  // namespace
