// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
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

/// What the samples of one database are made with, by one thread.
class SampleMaker {
 public:
  /// `data` knows how its samples are to be.
  SampleMaker(const ChainModel& model, const DatabaseData& data)
      : model_(model),
        data_(data),
        base_inverse_(to_pose(model.kernel.base).inverse()),
        // Reduced samples are taken at the last joint's frame instead of the tip link.
        kdl_(model.make_kdl(data.reduction ? to_pose(model.kernel.flange).inverse()
                                           : Pose::Identity())) {}

  /// The key of a sample that has the joint values of the sample space, and its record: x, q and
  /// J^+.
  void make(const double* sample, double* key, double* record) {
    const JointVector q = complete(sample);
    Pose pose = kdl_->fk(q);
    JacobianMatrix J = kdl_->jacobian(q);
    if (data_.reduction) {
      pose = base_inverse_ * pose;
      J.topRows<3>() = base_inverse_.linear() * J.topRows<3>().eval();
      J.bottomRows<3>() = base_inverse_.linear() * J.bottomRows<3>().eval();
      data_.reduction->make_key(pose, key);
    } else {
      make_key(data_.options, data_.weight, pose, key);
    }
    Eigen::Map<Eigen::Vector3d>{record} = pose.translation();
    Eigen::Map<Eigen::Vector3d>{record + 3} = to_rotation_vector(pose.linear());
    Eigen::Map<Eigen::VectorXd>(record + 6, model_.dof) = q;
    Eigen::Map<Eigen::MatrixXd>(record + 6 + model_.dof, model_.dof, 6) =
        TruncatedSvd(J, data_.options.pinv_cutoff).inverse();
  }

 private:
  /// All joint values.
  [[nodiscard]] JointVector complete(const double* sample) const {
    JointVector q(model_.dof);
    for (int j = 0; j < model_.dof; ++j) {
      const bool left_out = data_.reduction && data_.reduction->leaves_out(j);
      const auto& joints = model_.kernel.joints;
      q[j] = left_out ? -(j == 0 ? joints.front() : joints.back()).offset : *sample++;
    }
    return q;
  }

  const ChainModel& model_;
  const DatabaseData& data_;
  Pose base_inverse_;
  std::unique_ptr<KdlChain> kdl_;
};

/// Sets what does not depend on the samples' values; their number is known before memory for them
/// is asked for.
SampleSpace describe(const ChainModel& model, const DatabaseOptions& options, DatabaseData& data) {
  data.options = options;
  data.dof = model.dof;
  data.chain_hash = model.hash;
  data.weight = rotation_weight(options, model.reach);
  data.key_dim = key_dimension(options.rotation_key);
  if (options.key_scheme == KeyScheme::reduced) {
    data.reduction = std::make_shared<Reduction>(Reduction::of(model, data.weight));
    data.key_dim = data.reduction->key_dimension();
  }
  SampleSpace space = sample_space(model, data.reduction.get());
  data.size = sample_count(space, options);
  if (data.size > std::numeric_limits<std::uint32_t>::max()) {
    throw DatabaseError("a database of " + std::to_string(data.size) +
                        " samples is too large; at most 4294967295 are possible");
  }
  return space;
}

/// Puts row order[i] of so many numbers in the place of row i.
void reorder(double* rows, std::size_t width, const std::vector<std::uint32_t>& order) {
  for (std::size_t i = 0; i < order.size(); ++i) {
    std::size_t from = order[i];
    while (from < i) from = order[from];  // where it went when its place was taken
    std::swap_ranges(rows + i * width, rows + (i + 1) * width, rows + from * width);
  }
}

/// Makes the content of one database.
void make_content(const ChainModel& model, const DatabaseOptions& options, const Progress& progress,
                  DatabaseData& data) {
  const SampleSpace space = describe(model, options, data);
  const std::size_t updates = update_count(options);
  const std::size_t total = updates + data.size;
  std::size_t next_told = 0;
  // Only what is new, so that every call tells more than the one before.
  const auto tell = [&](std::size_t done) {
    if (!progress || done < next_told) return;
    next_told = done + 1;
    progress(done, total);
  };
  tell(0);
  const std::vector<double> samples = make_samples(space, options, tell);

  const auto key_dim = static_cast<std::size_t>(data.key_dim);
  const std::size_t length = DatabaseData::record_length(model.dof);
  const std::size_t numbers = data.size * (key_dim + length);
  const std::size_t size = kHeaderSize + numbers * sizeof(double);
  const std::shared_ptr<unsigned char> bytes = allocate(size);
  auto* const keys = reinterpret_cast<double*>(bytes.get() + kHeaderSize);
  double* const records = keys + data.size * key_dim;
  const auto make_worker = [&] {
    return [&, maker = SampleMaker(model, data)](std::size_t begin, std::size_t end) mutable {
      for (std::size_t i = begin; i < end; ++i) {
        maker.make(&samples[i * space.dof()], keys + i * key_dim, records + i * length);
      }
    };
  };
  // The end is told when all is done.
  parallel_for(data.size, /*chunk=*/256, resolve_threads(options.threads), make_worker,
               [&](std::size_t done) { tell(updates + std::min(done, data.size - 1)); });
  check_samples(keys, numbers, model);
  // The tree made of the keys sets the order in which everything is stored.
  const std::vector<std::uint32_t> order = make_kd_tree(keys, data.size, data.key_dim)->order();
  reorder(keys, key_dim, order);
  reorder(records, length, order);
  write_header(data, bytes.get(), size);
  data.use({bytes, size});
  tell(total);
}

}  // namespace

Database Database::build(const Robot& robot, const DatabaseOptions& options,
                         const Progress& progress) {
  options.validate();
  const auto data = std::make_shared<DatabaseData>();
  try {
    make_content(robot.model(), options, progress, *data);
  } catch (const std::bad_alloc&) {
    throw DatabaseError("no memory for a database of " + std::to_string(data->size) + " samples");
  }
  return Database(data);
}

}  // namespace iksel
