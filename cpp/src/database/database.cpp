// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/database.hpp"

#include <algorithm>
#include <cstring>
#include <utility>

#include "base/rotation.hpp"
#include "database/data.hpp"
#include "database/file.hpp"
#include "database/key.hpp"
#include "iksel/error.hpp"
#include "iksel/pose.hpp"

namespace iksel {
namespace {

void check_index(std::size_t i, std::size_t size) {
  if (i >= size) {
    throw InvalidArgumentError("sample index " + std::to_string(i) + " is not in 0 .. " +
                               std::to_string(size - 1));
  }
}

}  // namespace

void DatabaseData::make_key(const Pose& T_base_tip, double* key) const {
  if (reduction) {
    reduction->make_key(reduction->reduce(T_base_tip), key);
  } else {
    iksel::make_key(options, weight, T_base_tip, key);
  }
}

Database::Database(std::shared_ptr<const DatabaseData> data) : data_(std::move(data)) {}

Database Database::load(const std::filesystem::path& path, bool mmap) {
  return Database(std::make_shared<DatabaseData>(
      read_storage(mmap ? map_file(path) : read_file(path), "'" + path.string() + "'")));
}

void Database::save(const std::filesystem::path& path) const {
  data_->check_intact();
  write_file(path, data_->storage);
}

std::string Database::to_bytes() const {
  const Storage& storage = data_->storage;
  std::string bytes(reinterpret_cast<const char*>(storage.bytes.get()), storage.size);
  data_->check_intact();
  return bytes;
}

Database Database::from_bytes(const std::string& bytes) {
  const std::shared_ptr<unsigned char> copy = allocate(bytes.size());
  std::memcpy(copy.get(), bytes.data(), bytes.size());
  return Database(std::make_shared<DatabaseData>(read_storage({copy, bytes.size()}, "bytes")));
}

const DatabaseOptions& Database::options() const { return data_->options; }
std::size_t Database::size() const { return data_->size; }
int Database::dof() const { return data_->dof; }
int Database::key_dimension() const { return data_->key_dim; }
std::size_t Database::bytes() const {
  const DatabaseData& data = *data_;
  const std::size_t own_keys = data.own_keys ? data.own_keys->capacity() * sizeof(double) : 0;
  return sizeof data + data.storage.size + own_keys + data.tree->bytes() + data.leaves.bytes() +
         data.blocks.bytes();
}
std::uint64_t Database::chain_hash() const { return data_->chain_hash; }

JointVector Database::q(std::size_t i) const {
  check_index(i, size());
  JointVector q = Eigen::Map<const Eigen::VectorXd>(data_->q(i), dof());
  data_->check_intact();
  return q;
}

Pose Database::pose(std::size_t i) const {
  check_index(i, size());
  const double* x = data_->x(i);
  Pose pose = Pose::Identity();
  pose.translation() = Eigen::Map<const Eigen::Vector3d>(x);
  pose.linear() = from_rotation_vector(Eigen::Map<const Eigen::Vector3d>(x + 3));
  data_->check_intact();
  if (data_->reduction) {
    const Reduction& p = *data_->reduction;
    return Pose(p.base_inverse).inverse() * pose * Pose(p.flange_inverse).inverse();
  }
  return pose;
}

Matrix Database::pseudo_inverse(std::size_t i) const {
  check_index(i, size());
  Matrix inverse = Eigen::Map<const Eigen::MatrixXd>(data_->pseudo_inverse(i), dof(), 6);
  data_->check_intact();
  return inverse;
}

std::vector<std::size_t> Database::nearest(const Pose& T_base_tip, std::size_t k) const {
  const Pose target = check_pose(T_base_tip);
  double key[kMaxKeyDimension];
  data_->make_key(target, key);
  std::vector<Neighbour> neighbours(std::min(k, size()));
  std::vector<std::size_t> indices;
  if (neighbours.empty()) return indices;
  neighbours.resize(data_->tree->nearest(key, neighbours.size(), neighbours.data()));
  std::sort(neighbours.begin(), neighbours.end());
  for (const Neighbour& neighbour : neighbours) indices.push_back(neighbour.index);
  return indices;
}

}  // namespace iksel
