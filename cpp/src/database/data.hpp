// SPDX-License-Identifier: BSD-3-Clause
// The arrays behind a Database. They lie in memory as in a file: a header, the keys, the records.
#pragma once

#include <atomic>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "database/kd_tree.hpp"
#include "database/reduction.hpp"
#include "database/sample_blocks.hpp"
#include "iksel/options.hpp"

namespace iksel {

/// Bytes on the heap or mapped from a file, aligned to 64 bytes at least; copies share them.
struct Storage {
  std::shared_ptr<const unsigned char> bytes;
  std::size_t size = 0;
  /// Null where nobody else can change the bytes; else whether some were lost since.
  const std::atomic<bool>* damaged = nullptr;
};

/// Whether a number may be in a database: finite, and so are squared distances between such.
inline bool is_usable(double value) { return std::abs(value) <= 1e100; }

struct DatabaseData {
  DatabaseOptions options;
  int dof = 0;
  int key_dim = 0;
  std::size_t size = 0;
  std::uint64_t chain_hash = 0;
  /// Length that a unit of the key's rotation part counts [m].
  double weight = 0;
  /// Header, keys and records, as in a file.
  Storage storage;
  /// size x key_dim, in the order of the tree, so that neighbours lie close together.
  const double* keys = nullptr;
  /// The keys, if the storage may change.
  std::shared_ptr<const std::vector<double>> own_keys;
  /// size x record_length: x_i = [position; rotation vector] of the tip link (6), q_i (dof), J_i^+
  /// column by column (dof x 6).
  const double* records = nullptr;
  std::shared_ptr<const KdTree> tree;
  /// Not null: the key is reduced, and x_i and J_i^+ are those of the pose Y of reduction.hpp.
  std::shared_ptr<const Reduction> reduction;
  /// Only over a reduced key.
  LeafIndex leaves;
  SampleBlocks blocks;

  /// Key of a pose of the tip link.
  void make_key(const Pose& T_base_tip, double* key) const;
  /// Takes keys and records from a storage, and makes the trees over them. Throws DatabaseError if
  /// one is not usable.
  void use(Storage with);
  /// Throws DatabaseIoError if bytes of a mapped file were lost.
  void check_intact() const;

  [[nodiscard]] static std::size_t record_length(int dof) {
    return 6 + 7 * static_cast<std::size_t>(dof);
  }
  [[nodiscard]] const double* record(std::size_t i) const {
    return records + i * record_length(dof);
  }
  [[nodiscard]] const double* x(std::size_t i) const { return record(i); }
  [[nodiscard]] const double* q(std::size_t i) const { return record(i) + 6; }
  [[nodiscard]] const double* pseudo_inverse(std::size_t i) const { return record(i) + 6 + dof; }
};

}  // namespace iksel
