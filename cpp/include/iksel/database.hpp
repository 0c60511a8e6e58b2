// SPDX-License-Identifier: BSD-3-Clause
// Joint samples of a robot with their poses and Jacobian pseudo-inverses, under a KD-tree.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "iksel/export.hpp"
#include "iksel/options.hpp"
#include "iksel/robot.hpp"

namespace iksel {

struct DatabaseData;

/// An immutable set of samples (q_i, x_i, J_i^+); copies are cheap and share the data. Safe to use
/// from many threads at once.
class IKSEL_EXPORT Database {
 public:
  /// Samples the joint limits and computes pose, Jacobian (by KDL) and pseudo-inverse of every
  /// sample. Poses are of the tip link, without the TCP. Throws InvalidArgumentError on bad
  /// options, DatabaseError if the samples would not fit.
  static Database build(const Robot& robot, const DatabaseOptions& options = {},
                        const Progress& progress = {});

  /// Reads a file, after which it may be changed or removed. Throws DatabaseIoError,
  /// DatabaseCorruptError or DatabaseMismatchError (format version, byte order).
  ///
  /// With `mmap` the samples, most of a large file, stay in the file and are mapped read-only:
  /// processes that load one file share them. The file may be replaced (`save` does so) or removed,
  /// but should not be written to: what is overwritten in place is not noticed, and makes seeds
  /// worse, never an answer wrong. Where a file is cut short, the call under way still ends, and
  /// the next one on the database or a solver of it throws DatabaseIoError; for this the first such
  /// load installs a handler of SIGBUS, which passes on what is not its own. At most 256 files are
  /// mapped at once.
  static Database load(const std::filesystem::path& path, bool mmap = false);
  /// Writes beside `path` and renames, so that a crash leaves the old file or the new one. Removes
  /// files named iksel-*.tmp in the same folder that saves which were killed have left. Throws
  /// DatabaseIoError; the old file is then untouched.
  void save(const std::filesystem::path& path) const;

  /// The content of a file, for pickling and sending.
  [[nodiscard]] std::string to_bytes() const;
  static Database from_bytes(const std::string& bytes);

  /// Options it was built with (`threads` as given then).
  [[nodiscard]] const DatabaseOptions& options() const;
  /// Number of samples.
  [[nodiscard]] std::size_t size() const;
  /// Degrees of freedom of its robot.
  [[nodiscard]] int dof() const;
  /// Dimension of the KD-tree's key.
  [[nodiscard]] int key_dimension() const;
  /// Bytes of all that it holds: samples, keys and pseudo-inverses, the trees over them, and the
  /// copies that are laid out for the lanes. Bytes of a mapped file are among them.
  [[nodiscard]] std::size_t bytes() const;
  /// Robot::chain_hash of the robot it belongs to.
  [[nodiscard]] std::uint64_t chain_hash() const;

  /// Joint values of sample i [rad or m].
  [[nodiscard]] JointVector q(std::size_t i) const;
  /// T_base_tip of sample i, of the tip link without the TCP.
  [[nodiscard]] Pose pose(std::size_t i) const;
  /// J^+ of sample i, as in Eq. (4), (dof, 6).
  [[nodiscard]] Matrix pseudo_inverse(std::size_t i) const;

  /// Indices of the k samples whose keys are nearest to that of T_base_tip (of the tip link),
  /// nearest first; Eq. (2).
  [[nodiscard]] std::vector<std::size_t> nearest(const Pose& T_base_tip, std::size_t k) const;

  /// For the library itself.
  [[nodiscard]] const DatabaseData& data() const { return *data_; }

 private:
  explicit Database(std::shared_ptr<const DatabaseData> data);
  std::shared_ptr<const DatabaseData> data_;
};

/// Points per joint of the paper's grid, and how it is cut down for more than 7 joints: see
/// database/sampling.cpp.
IKSEL_EXPORT std::vector<int> grid_counts(int dof, Scale scale);

}  // namespace iksel
