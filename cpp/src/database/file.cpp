// SPDX-License-Identifier: BSD-3-Clause
#include "database/file.hpp"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>
#include <vector>

#include "base/hash.hpp"
#include "database/key.hpp"
#include "iksel/error.hpp"

namespace iksel {
namespace {

constexpr char kMagic[8] = {'I', 'K', 'S', 'E', 'L', 'D', 'B', '\0'};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kByteOrder = 0x01020304;

/// The header. Magic, byte order and version keep their places, and the checksum its place at the
/// end, in every version of the format.
struct Header {
  char magic[8];
  std::uint32_t byte_order;
  std::uint32_t version;
  std::uint64_t chain_hash;
  std::uint64_t samples;
  std::uint32_t dof;
  std::uint32_t key_dim;
  std::uint32_t sampling;
  std::uint32_t scale;
  std::uint32_t rotation_key;
  std::uint32_t key_scheme;
  std::uint64_t option_samples;
  std::uint64_t cvt_updates;
  std::uint64_t seed;
  double rotation_weight;
  double pinv_cutoff;
  // The reduction (zero for a full key) and the weight that its key really has.
  std::uint32_t left;
  std::uint32_t right;
  double weight;
  double base_inverse[12];
  double flange_inverse[12];
  std::uint64_t payload_size;
  std::uint64_t payload_checksum;
  unsigned char reserved[184];
  std::uint64_t header_checksum;
};
static_assert(sizeof(Header) == kHeaderSize);

std::uint64_t header_checksum(const Header& header) {
  return checksum(&header, offsetof(Header, header_checksum));
}

[[noreturn]] void corrupt(const std::string& name, const std::string& what) {
  throw DatabaseCorruptError("database " + name + ": " + what);
}

void store_pose(const StoredPose& pose, double* to) {
  for (int i = 0; i < 12; ++i) to[i] = pose(i % 3, i / 3);
}

StoredPose load_pose(const double* from) {
  StoredPose pose = StoredPose::Identity();
  for (int i = 0; i < 12; ++i) pose(i % 3, i / 3) = from[i];
  return pose;
}

/// What a header says of the data behind it.
DatabaseData describe(const Header& header) {
  DatabaseData data;
  data.options.sampling = static_cast<Sampling>(header.sampling);
  data.options.scale = static_cast<Scale>(header.scale);
  data.options.rotation_key = static_cast<RotationKey>(header.rotation_key);
  data.options.key_scheme = static_cast<KeyScheme>(header.key_scheme);
  data.options.samples = header.option_samples;
  data.options.cvt_updates = header.cvt_updates;
  data.options.seed = header.seed;
  data.options.rotation_weight = header.rotation_weight;
  data.options.pinv_cutoff = header.pinv_cutoff;
  data.dof = static_cast<int>(header.dof);
  data.key_dim = static_cast<int>(header.key_dim);
  data.size = header.samples;
  data.chain_hash = header.chain_hash;
  data.weight = header.weight;
  if (data.options.key_scheme == KeyScheme::reduced) {
    Reduction::Parameters p;
    p.left = static_cast<lanes::Side>(header.left);
    p.right = static_cast<lanes::Side>(header.right);
    p.dof = data.dof;
    p.weight = header.weight;
    p.base_inverse = load_pose(header.base_inverse);
    p.flange_inverse = load_pose(header.flange_inverse);
    data.reduction = std::make_shared<Reduction>(p);
  }
  return data;
}

bool reduction_fits(const Header& header) {
  const auto last = static_cast<std::uint32_t>(lanes::Side::translation);
  const bool reduced = header.key_scheme == static_cast<std::uint32_t>(KeyScheme::reduced);
  const bool leaves_out = header.left != 0 || header.right != 0;
  return header.left <= last && header.right <= last &&
         (!leaves_out || (reduced && header.dof >= 3)) && is_usable(header.weight) &&
         std::all_of(std::begin(header.base_inverse), std::end(header.base_inverse), is_usable) &&
         std::all_of(std::begin(header.flange_inverse), std::end(header.flange_inverse), is_usable);
}

bool sizes_fit(const Header& header, const DatabaseData& data) {
  const int key_dim =
      data.reduction ? data.reduction->key_dimension() : key_dimension(data.options.rotation_key);
  return header.key_dim == static_cast<std::uint32_t>(key_dim) && header.samples >= 1 &&
         header.samples <= std::numeric_limits<std::uint32_t>::max() &&
         header.payload_size == header.samples * sizeof(double) *
                                    (header.key_dim + DatabaseData::record_length(data.dof));
}

/// A header with a right checksum was written by this code, or by somebody who wants it to look so:
/// nothing is done by its numbers until they are known to be in range.
DatabaseData read_header(const Header& header, const std::string& name) {
  if (header.dof < 1 || header.dof > static_cast<std::uint32_t>(kMaxDof) ||
      !reduction_fits(header)) {
    corrupt(name, "its header's numbers are out of range");
  }
  DatabaseData data = describe(header);
  try {
    data.options.validate();
  } catch (const InvalidArgumentError& error) {
    corrupt(name, std::string("its header's ") + error.what());
  }
  if (!sizes_fit(header, data)) corrupt(name, "its header's sizes do not fit together");
  return data;
}

}  // namespace

void DatabaseData::use(std::shared_ptr<const Storage> with) {
  storage = std::move(with);
  keys = reinterpret_cast<const double*>(storage->data() + kHeaderSize);
  const std::size_t count = size * static_cast<std::size_t>(key_dim);
  records = keys + count;
  if (storage->damaged() != nullptr) {
    // What the trees lead through does not change under them.
    own_keys = std::make_shared<const std::vector<double>>(keys, keys + count);
    keys = own_keys->data();
  }
  if (!std::all_of(keys, keys + count, is_usable) ||
      !std::all_of(records, records + size * record_length(dof), is_usable)) {
    throw DatabaseError("a sample is not finite, or farther out than 1e100");
  }
  tree = KdTree(keys, size, key_dim);
  if (reduction) {
    leaves = LeafIndex(*this);
    blocks = SampleBlocks(*this);
  }
}

void DatabaseData::check_intact() const {
  const std::atomic<bool>* damaged = storage->damaged();
  if (damaged == nullptr || !*damaged) return;
  throw DatabaseIoError(
      "a mapped database can no longer be read: its file was cut short, or the disk failed, after "
      "Database::load(..., mmap = true)");
}

void write_header(const DatabaseData& data, unsigned char* storage, std::size_t size) {
  Header header{};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.byte_order = kByteOrder;
  header.version = kVersion;
  header.chain_hash = data.chain_hash;
  header.samples = data.size;
  header.dof = static_cast<std::uint32_t>(data.dof);
  header.key_dim = static_cast<std::uint32_t>(data.key_dim);
  header.sampling = static_cast<std::uint32_t>(data.options.sampling);
  header.scale = static_cast<std::uint32_t>(data.options.scale);
  header.rotation_key = static_cast<std::uint32_t>(data.options.rotation_key);
  header.key_scheme = static_cast<std::uint32_t>(data.options.key_scheme);
  header.option_samples = data.options.samples;
  header.cvt_updates = data.options.cvt_updates;
  header.seed = data.options.seed;
  header.rotation_weight = data.options.rotation_weight;
  header.pinv_cutoff = data.options.pinv_cutoff;
  header.weight = data.weight;
  if (data.reduction) {
    const Reduction::Parameters& p = data.reduction->parameters();
    header.left = static_cast<std::uint32_t>(p.left);
    header.right = static_cast<std::uint32_t>(p.right);
    store_pose(p.base_inverse, header.base_inverse);
    store_pose(p.flange_inverse, header.flange_inverse);
  }
  header.payload_size = size - kHeaderSize;
  header.payload_checksum = checksum(storage + kHeaderSize, size - kHeaderSize);
  header.header_checksum = header_checksum(header);
  std::memcpy(storage, &header, sizeof header);
}

DatabaseData read_storage(std::shared_ptr<const Storage> storage, const std::string& name) {
  if (storage->size() < kHeaderSize) {
    corrupt(name, "truncated: " + std::to_string(storage->size()) + " bytes, less than a header");
  }
  Header header;
  std::memcpy(&header, storage->data(), sizeof header);
  if (std::memcmp(header.magic, kMagic, sizeof kMagic) != 0) corrupt(name, "not an IKSel database");
  if (header.byte_order == __builtin_bswap32(kByteOrder)) {
    throw DatabaseMismatchError("database " + name +
                                ": written on a machine of the other byte order");
  }
  if (header_checksum(header) != header.header_checksum) {
    corrupt(name, "its header fails its checksum");
  }
  if (header.version != kVersion) {
    throw DatabaseMismatchError("database " + name + ": format version " +
                                std::to_string(header.version) + ", this library reads version " +
                                std::to_string(kVersion));
  }

  DatabaseData data = read_header(header, name);
  if (storage->size() - kHeaderSize != header.payload_size) {
    corrupt(name, "truncated: " + std::to_string(storage->size()) + " bytes instead of " +
                      std::to_string(kHeaderSize + header.payload_size));
  }
  const unsigned char* payload = storage->data() + kHeaderSize;
  if (checksum(payload, header.payload_size) != header.payload_checksum) {
    corrupt(name, "its content fails its checksum");
  }
  try {
    data.use(std::move(storage));
  } catch (const DatabaseError& error) {
    corrupt(name, error.what());
  }
  data.check_intact();
  return data;
}

}  // namespace iksel
