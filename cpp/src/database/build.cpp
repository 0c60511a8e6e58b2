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

  /// All joint values of a sample that has those of the sample space.
  [[nodiscard]] JointVector complete(const double* sample) const {
    JointVector q(model_.dof);
    for (int j = 0; j < model_.dof; ++j) {
      const bool left_out = data_.reduction && data_.reduction->leaves_out(j);
      const auto& joints = model_.kernel.joints;
      q[j] = left_out ? -(j == 0 ? joints.front() : joints.back()).offset : *sample++;
    }
    return q;
  }

  void make_key(const double* sample, double* key) {
    const Pose pose = pose_of(complete(sample));
    if (data_.reduction) {
      data_.reduction->make_key(pose, key);
    } else {
      iksel::make_key(data_.options, data_.weight, pose, key);
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
    if (data_.reduction) {
      J.topRows<3>() = base_inverse_.linear() * J.topRows<3>().eval();
      J.bottomRows<3>() = base_inverse_.linear() * J.bottomRows<3>().eval();
    }
    Eigen::Map<Eigen::MatrixXd>(record + 6 + model_.dof, model_.dof, 6) =
        TruncatedSvd(J, data_.options.pinv_cutoff).inverse();
  }

 private:
  Pose pose_of(const JointVector& q) {
    const Pose pose = kdl_->fk(q);
    return data_.reduction ? base_inverse_ * pose : pose;
  }

  const ChainModel& model_;
  const DatabaseData& data_;
  Pose base_inverse_;
  std::unique_ptr<KdlChain> kdl_;
};

/// Makes the content of one database.
class DatabaseBuilder {
 public:
  DatabaseBuilder(const ChainModel& model, const DatabaseOptions& options, const Progress& progress,
                  DatabaseData& data)
      : model_(model), options_(options), progress_(progress), data_(data) {}

  void build() {
    const SampleSpace space = describe();
    updates_ = update_count(options_);
    report(0);
    samples_ = make_samples(space, options_, [this](std::size_t done) { report(done); });
    width_ = space.dof();

    const std::vector<double> keys = make_keys();
    // The tree made of the keys sets the order in which everything is stored.
    const std::vector<std::uint32_t> order =
        make_kd_tree(keys.data(), data_.size, data_.key_dim)->order();
    const std::size_t record_length = DatabaseData::record_length(model_.dof);
    const std::size_t size =
        kHeaderSize + data_.size * (key_dim() + record_length) * sizeof(double);
    const std::shared_ptr<unsigned char> bytes = allocate(size);
    auto* payload = reinterpret_cast<double*>(bytes.get() + kHeaderSize);
    for (std::size_t i = 0; i < data_.size; ++i) {
      std::copy_n(&keys[order[i] * key_dim()], key_dim(), payload + i * key_dim());
    }
    make_records(order, payload + data_.size * key_dim());
    write_header(data_, bytes.get(), size);
    data_.use({bytes, size});
    report(total());
  }

 private:
  /// Sets what does not depend on the samples' values; their number is known before memory for
  /// them is asked for.
  SampleSpace describe() {
    data_.options = options_;
    data_.dof = model_.dof;
    data_.chain_hash = model_.hash;
    data_.weight = rotation_weight(options_, model_.reach);
    data_.key_dim = iksel::key_dimension(options_.rotation_key);
    if (data_.options.key_scheme == KeyScheme::reduced) {
      data_.reduction = std::make_shared<Reduction>(Reduction::of(model_, data_.weight));
      data_.key_dim = data_.reduction->key_dimension();
    }
    SampleSpace space = sample_space(model_, data_.reduction.get());
    data_.size = sample_count(space, options_);
    if (data_.size > std::numeric_limits<std::uint32_t>::max()) {
      throw DatabaseError("a database of " + std::to_string(data_.size) +
                          " samples is too large; at most 4294967295 are possible");
    }
    return space;
  }

  std::vector<double> make_keys() {
    std::vector<double> keys(data_.size * key_dim());
    // Half of a sample's work.
    for_all_samples(
        [&](SampleMaker& maker, std::size_t i) {
          maker.make_key(&samples_[i * width_], &keys[i * key_dim()]);
        },
        [this](std::size_t done) { report(updates_ + done / 2); });
    check_samples(keys.data(), keys.size(), model_);
    return keys;
  }

  void make_records(const std::vector<std::uint32_t>& order, double* records) {
    const std::size_t length = DatabaseData::record_length(model_.dof);
    for_all_samples(
        [&](SampleMaker& maker, std::size_t i) {
          maker.make_record(&samples_[order[i] * width_], records + i * length);
        },
        [this](std::size_t done) {
          // The end is reported when all is done.
          const std::size_t halves = updates_ + (data_.size + done) / 2;
          if (halves < total()) report(halves);
        });
    check_samples(records, data_.size * length, model_);
  }

  /// work(maker, i) for every sample, with a maker per thread.
  template <typename Work, typename OnProgress>
  void for_all_samples(const Work& work, const OnProgress& on_progress) {
    const auto make_worker = [&] {
      return
          [&work, maker = SampleMaker(model_, data_)](std::size_t begin, std::size_t end) mutable {
            for (std::size_t i = begin; i < end; ++i) work(maker, i);
          };
    };
    parallel_for(data_.size, /*chunk=*/512, resolve_threads(options_.threads), make_worker,
                 on_progress);
  }

  /// Only what is new, so that every call reports more than the one before.
  void report(std::size_t done) {
    if (!progress_ || done < next_told_) return;
    next_told_ = done + 1;
    progress_(done, total());
  }

  [[nodiscard]] std::size_t total() const { return updates_ + data_.size; }
  [[nodiscard]] std::size_t key_dim() const { return static_cast<std::size_t>(data_.key_dim); }

  const ChainModel& model_;
  const DatabaseOptions& options_;
  const Progress& progress_;
  DatabaseData& data_;
  /// Steps of the tessellation before the first key.
  std::size_t updates_ = 0;
  /// Joint values that the samples are spread over, `width_` each.
  std::vector<double> samples_;
  std::size_t width_ = 0;
  std::size_t next_told_ = 0;
};

}  // namespace

Database Database::build(const Robot& robot, const DatabaseOptions& options,
                         const Progress& progress) {
  options.validate();
  const auto data = std::make_shared<DatabaseData>();
  try {
    DatabaseBuilder(robot.model(), options, progress, *data).build();
  } catch (const std::bad_alloc&) {
    throw DatabaseError("no memory for a database of " + std::to_string(data->size) + " samples");
  }
  return Database(data);
}

}  // namespace iksel
