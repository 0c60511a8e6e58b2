// SPDX-License-Identifier: BSD-3-Clause
// A saved database comes back as it was, or not at all.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iksel/iksel.hpp>

#include "math/random.hpp"
#include "robots.hpp"

namespace {

namespace fs = std::filesystem;
using iksel::Database;
using iksel::DatabaseOptions;
using iksel::Robot;

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
    return Database::build(iksel_test::load(iksel_test::paper_robots()[0]), options);
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

TEST_F(DatabaseFile, ServesTheSameSolver) {
  const Robot robot = iksel_test::load(iksel_test::paper_robots()[0]);
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
  constexpr std::size_t kHeader = 512;
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
  const Robot other = iksel_test::load(iksel_test::paper_robots()[1]);
  EXPECT_THROW(iksel::Solver(other, {}, make(10)), iksel::DatabaseMismatchError);
}

TEST_F(DatabaseFile, AnotherToolsDatabaseServes) {
  const Robot robot = iksel_test::load(iksel_test::paper_robots()[0]);
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

TEST_F(DatabaseFile, SavingOverAMappedFileKeepsTheMapping) {
  make(50).save(path("d.iksel"));
  const Database mapped = Database::load(path("d.iksel"));
  const std::string bytes = mapped.to_bytes();
  make(70).save(path("d.iksel"));
  EXPECT_EQ(mapped.to_bytes(), bytes);
  EXPECT_EQ(Database::load(path("d.iksel")).size(), 70U);
}

}  // namespace
