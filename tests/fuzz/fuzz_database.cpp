// SPDX-License-Identifier: BSD-3-Clause
// Bytes as a database file: a typed error, or a database that a solver can use without a false
// success. Most mutants get right checksums, so that they reach what lies behind them.
#include <sys/mman.h>
#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iksel/iksel.hpp>
#include <string>

#include "base/hash.hpp"
#include "check_answer.hpp"

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t room);

namespace {

// Places in the header of the file format; `check_fix_up` notices when they change.
constexpr std::size_t kHeaderSize = 512;
constexpr std::size_t kPayloadSize = 304;
constexpr std::size_t kPayloadChecksum = 312;
constexpr std::size_t kHeaderChecksum = 504;

constexpr const char* kTwoJoints = R"(<robot name="two">
  <link name="base"/><link name="arm"/><link name="hand"/>
  <joint name="a" type="revolute"><parent link="base"/><child link="arm"/>
    <axis xyz="0 0 1"/><limit lower="-2" upper="2" velocity="1" effort="1"/></joint>
  <joint name="b" type="revolute"><parent link="arm"/><child link="hand"/>
    <origin xyz="0.3 0 0.1" rpy="1.2 0 0.3"/>
    <axis xyz="0 0 1"/><limit lower="-1" upper="2" velocity="1" effort="1"/></joint>
</robot>)";

const iksel::Robot& robot() {
  static const iksel::Robot two = [] {
    iksel::RobotOptions options;
    options.tcp.translation().x() = 0.2;
    return iksel::Robot::from_urdf_string(kTwoJoints, options);
  }();
  return two;
}

void put(std::uint8_t* bytes, std::size_t at, std::uint64_t value) {
  std::memcpy(bytes + at, &value, sizeof value);
}

void fix_checksums(std::uint8_t* bytes, std::size_t size) {
  if (size < kHeaderSize) return;
  put(bytes, kPayloadSize, size - kHeaderSize);
  put(bytes, kPayloadChecksum, iksel::checksum(bytes + kHeaderSize, size - kHeaderSize));
  put(bytes, kHeaderChecksum, iksel::checksum(bytes, kHeaderChecksum));
}

/// The fix-up of an intact file changes nothing.
bool check_fix_up() {
  iksel::DatabaseOptions options;
  options.samples = 5;
  const std::string intact = iksel::Database::build(robot(), options).to_bytes();
  std::string fixed = intact;
  fix_checksums(reinterpret_cast<std::uint8_t*>(fixed.data()), fixed.size());
  if (fixed != intact) iksel_fuzz::finding("the fuzzer's offsets are not those of the file format");
  return true;
}

/// A file without a name that holds the bytes.
class MemoryFile {
 public:
  MemoryFile(const std::uint8_t* data, std::size_t size) : fd_(::memfd_create("fuzz", 0)) {
    if (fd_ < 0 || ::write(fd_, data, size) != static_cast<ssize_t>(size)) {
      iksel_fuzz::finding("no memory file to be had");
    }
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  ~MemoryFile() { ::close(fd_); }
  [[nodiscard]] std::string path() const { return "/proc/self/fd/" + std::to_string(fd_); }

 private:
  int fd_;
};

void use(const iksel::Database& database) {
  const iksel::Pose target = robot().fk(robot().random_configurations(1, 1).row(0));
  const std::size_t last = database.size() - 1;
  (void)database.q(last);
  (void)database.pose(last);
  (void)database.pseudo_inverse(last);
  (void)database.nearest(target, 5);
  (void)database.to_bytes();
  iksel::SolverOptions options;
  options.max_attempts = 8;
  const iksel::Solver solver(robot(), options, database);
  iksel_fuzz::check_answer(solver, target, solver.solve(target));
}

}  // namespace

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t room, unsigned seed) {
  const std::size_t mutated = LLVMFuzzerMutate(data, size, room);
  if (seed % 8 != 0) fix_checksums(data, mutated);
  return mutated;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  [[maybe_unused]] static const bool checked = check_fix_up();
  const MemoryFile file(data, size);
  try {
    use(iksel::Database::load(file.path()));
    use(iksel::Database::load(file.path(), /*mmap=*/true));
  } catch (const iksel::Error&) {
    // Any other exception is a finding.
  }
  return 0;
}
