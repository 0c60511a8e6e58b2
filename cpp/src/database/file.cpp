// SPDX-License-Identifier: BSD-3-Clause
#include "database/file.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <limits>
#include <new>
#include <type_traits>
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
  // Zero for all samplings but kmeans.
  std::uint64_t kmeans_pool;
  std::uint64_t kmeans_rounds;
  unsigned char reserved[168];
  std::uint64_t header_checksum;
};
static_assert(sizeof(Header) == kHeaderSize);

std::uint64_t header_checksum(const Header& header) {
  return checksum(&header, offsetof(Header, header_checksum));
}

[[noreturn]] void corrupt(const std::string& name, const std::string& what) {
  throw DatabaseCorruptError("database " + name + ": " + what);
}

/// copy(field, value) for every number of the header that the data hold as it is.
template <typename Fields, typename Data, typename Copy>
void for_each_number(Fields& header, Data& data, const Copy& copy) {
  copy(header.chain_hash, data.chain_hash);
  copy(header.samples, data.size);
  copy(header.dof, data.dof);
  copy(header.key_dim, data.key_dim);
  copy(header.weight, data.weight);
  copy(header.sampling, data.options.sampling);
  copy(header.scale, data.options.scale);
  copy(header.rotation_key, data.options.rotation_key);
  copy(header.key_scheme, data.options.key_scheme);
  copy(header.option_samples, data.options.samples);
  copy(header.cvt_updates, data.options.cvt_updates);
  copy(header.seed, data.options.seed);
  copy(header.rotation_weight, data.options.rotation_weight);
  copy(header.pinv_cutoff, data.options.pinv_cutoff);
  if (data.options.sampling != Sampling::kmeans) return;
  copy(header.kmeans_pool, data.options.kmeans_pool);
  copy(header.kmeans_rounds, data.options.kmeans_rounds);
}

/// The rotation and position of a pose, column by column.
using PoseNumbers = Eigen::Matrix<double, 3, 4>;

/// What a header says of the data behind it.
DatabaseData describe(const Header& header) {
  DatabaseData data;
  for_each_number(header, data, [](const auto& field, auto& value) {
    value = static_cast<std::decay_t<decltype(value)>>(field);
  });
  // Older files may have any number where it was not read.
  if (data.options.sampling != Sampling::cvt) {
    data.options.cvt_updates = DatabaseOptions{}.cvt_updates;
  }
  if (data.options.key_scheme == KeyScheme::reduced) {
    Reduction p;
    p.left = static_cast<lanes::Side>(header.left);
    p.right = static_cast<lanes::Side>(header.right);
    p.dof = data.dof;
    p.weight = data.weight;
    p.base_inverse.affine() = Eigen::Map<const PoseNumbers>(header.base_inverse);
    p.flange_inverse.affine() = Eigen::Map<const PoseNumbers>(header.flange_inverse);
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

void DatabaseData::use(Storage with) {
  storage = std::move(with);
  keys = reinterpret_cast<const double*>(storage.bytes.get() + kHeaderSize);
  const std::size_t count = size * static_cast<std::size_t>(key_dim);
  records = keys + count;
  if (storage.damaged != nullptr) {
    // What the trees lead through does not change under them.
    own_keys = std::make_shared<const std::vector<double>>(keys, keys + count);
    keys = own_keys->data();
  }
  if (!std::all_of(keys, keys + count, is_usable) ||
      !std::all_of(records, records + size * record_length(dof), is_usable)) {
    throw DatabaseError("a sample is not finite, or farther out than 1e100");
  }
  tree = make_kd_tree(keys, size, key_dim);
  if (reduction) {
    leaves = LeafIndex(*this);
    blocks = SampleBlocks(*this);
  }
}

void DatabaseData::check_intact() const {
  if (storage.damaged == nullptr || !*storage.damaged) return;
  throw DatabaseIoError(
      "a mapped database can no longer be read: its file was cut short, or the disk failed, after "
      "Database::load(..., mmap = true)");
}

void write_header(const DatabaseData& data, unsigned char* storage, std::size_t size) {
  Header header{};
  std::memcpy(header.magic, kMagic, sizeof kMagic);
  header.byte_order = kByteOrder;
  header.version = kVersion;
  for_each_number(header, data, [](auto& field, const auto& value) {
    field = static_cast<std::decay_t<decltype(field)>>(value);
  });
  if (data.reduction) {
    const Reduction& p = *data.reduction;
    header.left = static_cast<std::uint32_t>(p.left);
    header.right = static_cast<std::uint32_t>(p.right);
    Eigen::Map<PoseNumbers>(header.base_inverse) = p.base_inverse.affine();
    Eigen::Map<PoseNumbers>(header.flange_inverse) = p.flange_inverse.affine();
  }
  header.payload_size = size - kHeaderSize;
  header.payload_checksum = checksum(storage + kHeaderSize, size - kHeaderSize);
  header.header_checksum = header_checksum(header);
  std::memcpy(storage, &header, sizeof header);
}

std::shared_ptr<unsigned char> allocate(std::size_t size) {
  constexpr std::size_t kAlignment = 64;
  const std::size_t rounded = (size / kAlignment + 1) * kAlignment;
  void* const bytes = std::aligned_alloc(kAlignment, rounded);
  if (bytes == nullptr) throw std::bad_alloc();
  return {static_cast<unsigned char*>(bytes), &std::free};
}

DatabaseData read_storage(const Storage& storage, const std::string& name) {
  if (storage.size < kHeaderSize) {
    corrupt(name, "truncated: " + std::to_string(storage.size) + " bytes, less than a header");
  }
  Header header;
  std::memcpy(&header, storage.bytes.get(), sizeof header);
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
  if (storage.size - kHeaderSize != header.payload_size) {
    const bool is_short = storage.size - kHeaderSize < header.payload_size;
    corrupt(name, (is_short ? "truncated: " : "something stands behind it: ") +
                      std::to_string(storage.size) + " bytes instead of " +
                      std::to_string(kHeaderSize + header.payload_size));
  }
  const unsigned char* payload = storage.bytes.get() + kHeaderSize;
  if (checksum(payload, header.payload_size) != header.payload_checksum) {
    corrupt(name, "its content fails its checksum");
  }
  try {
    data.use(storage);
  } catch (const DatabaseError& error) {
    corrupt(name, error.what());
  }
  data.check_intact();
  return data;
}

}  // namespace iksel
