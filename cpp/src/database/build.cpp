// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <new>

#include "database/data.hpp"
#include "database/file.hpp"
#include "database/key.hpp"
#include "database/sampling.hpp"
#include "iksel/database.hpp"
#include "iksel/error.hpp"
#include "kinematics/chain_model.hpp"
#include "math/pseudo_inverse.hpp"
#include "math/rotation.hpp"
#include "util/parallel.hpp"

namespace iksel {
namespace {

constexpr std::size_t kChunk = 512;

/// x, q and J^+ of one sample.
void fill_record(KdlChain& kdl, const double* sample, int dof, double cutoff, double* record) {
  const JointVector q = Eigen::Map<const Eigen::VectorXd>(sample, dof);
  const Pose pose = kdl.fk(q);
  Eigen::Map<Eigen::Vector3d> position(record);
  Eigen::Map<Eigen::Vector3d> rotation(record + 3);
  position = pose.translation();
  rotation = to_rotation_vector(pose.linear());
  Eigen::Map<Eigen::VectorXd>(record + 6, dof) = q;
  Eigen::Map<Eigen::MatrixXd>(record + 6 + dof, dof, 6) =
      TruncatedSvd(kdl.jacobian(q), cutoff).inverse();
}

std::shared_ptr<DatabaseData> build_data(const ChainModel& model, const DatabaseOptions& options,
                                         const Progress& progress) {
  const auto data = std::make_shared<DatabaseData>();
  data->options = options;
  data->dof = model.dof;
  data->key_dim = iksel::key_dimension(options.rotation_key);
  data->chain_hash = model.hash;
  data->size = sample_count(model, options);
  if (data->size > std::numeric_limits<std::uint32_t>::max()) {
    throw DatabaseError("a database of " + std::to_string(data->size) +
                        " samples is too large; at most 4294967295 are possible");
  }
  const std::size_t updates = options.sampling == Sampling::cvt ? options.cvt_updates : 0;
  const std::size_t total = updates + data->size;
  const auto report = [&](std::size_t done) {
    if (progress) progress(done, total);
  };
  report(0);

  const std::vector<double> samples = make_samples(model, options, report);
  const auto dof = static_cast<std::size_t>(model.dof);
  const auto key_dim = static_cast<std::size_t>(data->key_dim);
  const std::size_t length = DatabaseData::record_length(model.dof);
  const int threads = resolve_threads(options.threads);

  // Keys first: the tree made of them tells the order in which everything is then stored.
  std::vector<double> keys(data->size * key_dim);
  parallel_for(
      data->size, kChunk, threads,
      [&] {
        return [&, kdl = std::shared_ptr<KdlChain>(model.make_kdl(false))](std::size_t begin,
                                                                           std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            const JointVector q = Eigen::Map<const Eigen::VectorXd>(&samples[i * dof], model.dof);
            make_key(options, kdl->fk(q), &keys[i * key_dim]);
          }
        };
      },
      [&](std::size_t) { report(updates); });
  const std::vector<std::uint32_t> order = KdTree(keys.data(), data->size, data->key_dim).order();

  const auto block = std::make_shared<HeapBlock>(data->size * (key_dim + length) * sizeof(double));
  auto* payload = reinterpret_cast<double*>(block->writable() + kHeaderSize);
  double* records = payload + data->size * key_dim;
  for (std::size_t i = 0; i < data->size; ++i) {
    std::copy_n(&keys[order[i] * key_dim], key_dim, payload + i * key_dim);
  }
  parallel_for(
      data->size, kChunk, threads,
      [&] {
        return [&, kdl = std::shared_ptr<KdlChain>(model.make_kdl(false))](std::size_t begin,
                                                                           std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            fill_record(*kdl, &samples[order[i] * dof], model.dof, options.pinv_cutoff,
                        records + i * length);
          }
        };
      },
      [&](std::size_t done) { report(updates + done); });

  write_header(*data, block->writable(), block->size());
  data->keys = payload;
  data->records = records;
  data->tree = KdTree(data->keys, data->size, data->key_dim);
  data->block = block;
  report(total);
  return data;
}

}  // namespace

Database Database::build(const Robot& robot, const DatabaseOptions& options,
                         const Progress& progress) {
  options.validate();
  try {
    return Database(build_data(robot.model(), options, progress));
  } catch (const std::bad_alloc&) {
    throw DatabaseError("no memory for a database of " +
                        std::to_string(sample_count(robot.model(), options)) + " samples");
  }
}

}  // namespace iksel
