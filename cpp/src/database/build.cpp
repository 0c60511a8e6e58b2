// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstring>
#include <limits>
#include <memory>
#include <new>
#include <vector>

#include "base/message_text.hpp"
#include "base/parallel.hpp"
#include "base/pseudo_inverse.hpp"
#include "base/rotation.hpp"
#include "database/data.hpp"
#include "database/file.hpp"
#include "database/key.hpp"
#include "database/sampling.hpp"
#include "iksel/database.hpp"
#include "iksel/error.hpp"
#include "kinematics/chain_model.hpp"

namespace iksel {
namespace {

/// Throws unless all numbers can be in a database.
void check_samples(const double* first, std::size_t count, const ChainModel& model) {
  if (std::all_of(first, first + count, is_usable)) return;
  throw DatabaseError(
      "no database can be built: samples of the chain are not finite or out of scale; its reach "
      "is " +
      number_text(model.reach) + " m");
}

/// Samples that a thread takes at a time.
constexpr std::size_t kSamplesPerTurn = 512;

/// What the samples of one database are made with, by one thread.
class SampleMaker {
 public:
  SampleMaker(const ChainModel& model, const DatabaseOptions& options, double weight,
              const Reduction* reduction)
      : options_(options),
        reduction_(reduction),
        model_(model),
        weight_(weight),
        base_inverse_(to_pose(model.kernel.base).inverse()),
        // Reduced samples are taken at the last joint's frame instead of the tip link.
        kdl_(model.make_kdl(reduction != nullptr ? to_pose(model.kernel.flange).inverse()
                                                 : Pose::Identity())) {}

  /// All joint values of a sample that has those of the sample space.
  [[nodiscard]] JointVector complete(const double* sample) const {
    JointVector q(model_.dof);
    for (int j = 0; j < model_.dof; ++j) {
      const bool left_out = reduction_ != nullptr && reduction_->leaves_out(j);
      q[j] = left_out ? -model_.kernel.joints[static_cast<std::size_t>(j)].offset : *sample++;
    }
    return q;
  }

  void make_key(const double* sample, double* key) {
    const Pose pose = pose_of(complete(sample));
    if (reduction_ != nullptr) {
      reduction_->make_key(pose, key);
    } else {
      iksel::make_key(options_, weight_, pose, key);
    }
  }

  /// x, q and J^+.
  void make_record(const double* sample, double* record) {
    const JointVector q = complete(sample);
    const Pose pose = pose_of(q);
    Eigen::Map<Eigen::Vector3d> position(record);
    Eigen::Map<Eigen::Vector3d> rotation(record + 3);
    position = pose.translation();
    rotation = to_rotation_vector(pose.linear());
    Eigen::Map<Eigen::VectorXd>(record + 6, model_.dof) = q;
    JacobianMatrix J = kdl_->jacobian(q);
    if (reduction_ != nullptr) {
      J.topRows<3>() = base_inverse_.linear() * J.topRows<3>().eval();
      J.bottomRows<3>() = base_inverse_.linear() * J.bottomRows<3>().eval();
    }
    Eigen::Map<Eigen::MatrixXd>(record + 6 + model_.dof, model_.dof, 6) =
        TruncatedSvd(J, options_.pinv_cutoff).inverse();
  }

 private:
  Pose pose_of(const JointVector& q) {
    const Pose pose = kdl_->fk(q);
    return reduction_ != nullptr ? base_inverse_ * pose : pose;
  }

  const DatabaseOptions& options_;
  const Reduction* reduction_;
  const ChainModel& model_;
  double weight_;
  Pose base_inverse_;
  std::unique_ptr<KdlChain> kdl_;
};

/// Fills `data`; its size is known as soon as memory is asked for.
void build_data(const ChainModel& model, const DatabaseOptions& options, const Progress& progress,
                const std::shared_ptr<DatabaseData>& data) {
  data->options = options;
  if (!is_simple(model)) data->options.key_scheme = KeyScheme::full;
  data->dof = model.dof;
  data->chain_hash = model.hash;
  data->weight = rotation_weight(options, model.reach);
  data->key_dim = iksel::key_dimension(options.rotation_key);
  if (data->options.key_scheme == KeyScheme::reduced) {
    data->reduction = std::make_shared<Reduction>(Reduction::of(model, data->weight));
    data->key_dim = data->reduction->key_dimension();
  }
  const SampleSpace space = sample_space(model, data->reduction.get());
  data->size = sample_count(space, options);
  if (data->size > std::numeric_limits<std::uint32_t>::max()) {
    throw DatabaseError("a database of " + std::to_string(data->size) +
                        " samples is too large; at most 4294967295 are possible");
  }
  const std::size_t updates = options.sampling == Sampling::cvt ? options.cvt_updates : 0;
  const std::size_t total = updates + data->size;
  // Only what is new, so that every call tells more than the one before.
  std::size_t next_told = 0;
  const auto report = [&](std::size_t done) {
    if (!progress || done < next_told) return;
    next_told = done + 1;
    progress(done, total);
  };
  report(0);

  const std::vector<double> samples = make_samples(space, options, report);
  const std::size_t width = space.dof();
  const auto key_dim = static_cast<std::size_t>(data->key_dim);
  const std::size_t length = DatabaseData::record_length(model.dof);
  const int threads = resolve_threads(options.threads);
  const auto make_worker = [&] {
    return std::make_shared<SampleMaker>(model, data->options, data->weight, data->reduction.get());
  };

  // Keys first: the tree made of them tells the order in which everything is then stored.
  std::vector<double> keys(data->size * key_dim);
  const auto make_key_worker = [&] {
    return [&, maker = make_worker()](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        maker->make_key(&samples[i * width], &keys[i * key_dim]);
      }
    };
  };
  // Half of a sample's work.
  parallel_for(data->size, kSamplesPerTurn, threads, make_key_worker,
               [&](std::size_t done) { report(updates + done / 2); });
  check_samples(keys.data(), keys.size(), model);
  const std::vector<std::uint32_t> order = KdTree(keys.data(), data->size, data->key_dim).order();

  const auto storage =
      std::make_shared<HeapStorage>(data->size * (key_dim + length) * sizeof(double));
  auto* payload = reinterpret_cast<double*>(storage->writable() + kHeaderSize);
  double* records = payload + data->size * key_dim;
  for (std::size_t i = 0; i < data->size; ++i) {
    std::copy_n(&keys[order[i] * key_dim], key_dim, payload + i * key_dim);
  }
  parallel_for(
      data->size, kSamplesPerTurn, threads,
      [&] {
        return [&, maker = make_worker()](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) {
            maker->make_record(&samples[order[i] * width], records + i * length);
          }
        };
      },
      [&](std::size_t done) {
        // The end is told when all is done.
        const std::size_t halves = updates + (data->size + done) / 2;
        if (halves < total) report(halves);
      });

  check_samples(records, data->size * length, model);
  write_header(*data, storage->writable(), storage->size());
  data->use(storage);
  report(total);
}

}  // namespace

Database Database::build(const Robot& robot, const DatabaseOptions& options,
                         const Progress& progress) {
  options.validate();
  const auto data = std::make_shared<DatabaseData>();
  try {
    build_data(robot.model(), options, progress, data);
  } catch (const std::bad_alloc&) {
    throw DatabaseError("no memory for a database of " + std::to_string(data->size) + " samples");
  }
  return Database(data);
}

}  // namespace iksel
