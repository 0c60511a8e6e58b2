// SPDX-License-Identifier: BSD-3-Clause
#include "database/file.hpp"

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>
#include <utility>

#include "database/key.hpp"
#include "iksel/error.hpp"
#include "math/hash.hpp"

namespace iksel {
namespace {

constexpr char kMagic[8] = {'I', 'K', 'S', 'E', 'L', 'D', 'B', '\0'};
constexpr std::uint32_t kVersion = 1;
constexpr std::uint32_t kByteOrder = 0x01020304;
constexpr std::size_t kAlignment = 64;

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

std::string system_error(int error) { return std::strerror(error); }

class MappedBlock final : public Block {
 public:
  MappedBlock(void* bytes, std::size_t size) : bytes_(bytes), size_(size) {}
  MappedBlock(const MappedBlock&) = delete;
  MappedBlock& operator=(const MappedBlock&) = delete;
  ~MappedBlock() override { ::munmap(bytes_, size_); }
  [[nodiscard]] const unsigned char* data() const override {
    return static_cast<const unsigned char*>(bytes_);
  }
  [[nodiscard]] std::size_t size() const override { return size_; }

 private:
  void* bytes_;
  std::size_t size_;
};

/// A file descriptor that closes itself.
class Descriptor {
 public:
  explicit Descriptor(int fd) : fd_(fd) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() { close(); }
  [[nodiscard]] int get() const { return fd_; }
  int close() {
    const int fd = std::exchange(fd_, -1);
    return fd >= 0 ? ::close(fd) : 0;
  }

 private:
  int fd_;
};

}  // namespace

HeapBlock::HeapBlock(std::size_t payload) : size_(kHeaderSize + payload) {
  const std::size_t rounded = (size_ + kAlignment - 1) / kAlignment * kAlignment;
  bytes_ = static_cast<unsigned char*>(std::aligned_alloc(kAlignment, rounded));
  if (bytes_ == nullptr) throw std::bad_alloc();
}

HeapBlock::~HeapBlock() { std::free(bytes_); }

void DatabaseData::use(std::shared_ptr<const Block> with) {
  block = std::move(with);
  keys = reinterpret_cast<const double*>(block->data() + kHeaderSize);
  records = keys + size * static_cast<std::size_t>(key_dim);
  tree = KdTree(keys, size, key_dim);
  if (reduction) {
    leaves = LeafTree(*this);
    tiles = Tiles(*this);
  }
}

void write_header(const DatabaseData& data, unsigned char* block, std::size_t size) {
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
  header.payload_checksum = checksum(block + kHeaderSize, size - kHeaderSize);
  header.header_checksum = header_checksum(header);
  std::memcpy(block, &header, sizeof header);
}

DatabaseData read_block(std::shared_ptr<const Block> block, const std::string& name) {
  if (block->size() < kHeaderSize) {
    corrupt(name, "truncated: " + std::to_string(block->size()) + " bytes, less than a header");
  }
  Header header;
  std::memcpy(&header, block->data(), sizeof header);
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

  // A header with a right checksum was written by this code, yet nothing is read by its sizes until
  // they are known to be consistent.
  const bool sizes_fit =
      header.dof >= 1 && header.dof <= static_cast<std::uint32_t>(kMaxDof) && header.key_dim >= 1 &&
      header.key_dim <= static_cast<std::uint32_t>(kMaxKeyDimension) && header.samples >= 1 &&
      header.samples <= header.payload_size / sizeof(double) &&
      header.payload_size == header.samples * sizeof(double) *
                                 (header.key_dim + DatabaseData::record_length(data.dof));
  if (!sizes_fit) corrupt(name, "its header's sizes do not fit together");
  if (block->size() - kHeaderSize != header.payload_size) {
    corrupt(name, "truncated: " + std::to_string(block->size()) + " bytes instead of " +
                      std::to_string(kHeaderSize + header.payload_size));
  }
  const unsigned char* payload = block->data() + kHeaderSize;
  if (checksum(payload, header.payload_size) != header.payload_checksum) {
    corrupt(name, "its content fails its checksum");
  }
  data.use(std::move(block));
  return data;
}

std::shared_ptr<const Block> map_file(const std::filesystem::path& path) {
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (file.get() < 0) {
    throw DatabaseIoError("cannot open database '" + path.string() + "': " + system_error(errno));
  }
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) {
    throw DatabaseIoError("cannot read database '" + path.string() + "': " + system_error(errno));
  }
  if (!S_ISREG(info.st_mode)) {
    throw DatabaseIoError("cannot read database '" + path.string() + "': not a regular file");
  }
  const auto size = static_cast<std::size_t>(info.st_size);
  if (size < kHeaderSize) {
    corrupt("'" + path.string() + "'",
            "truncated: " + std::to_string(size) + " bytes, less than a header");
  }
  void* bytes = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.get(), 0);
  if (bytes == MAP_FAILED) {
    throw DatabaseIoError("cannot map database '" + path.string() + "': " + system_error(errno));
  }
  return std::make_shared<MappedBlock>(bytes, size);
}

void write_file(const std::filesystem::path& path, const Block& block) {
  // A name of our own in the same folder, so that the rename is atomic.
  static std::atomic<unsigned> counter{0};
  const std::string temporary =
      path.string() + "." + std::to_string(::getpid()) + "-" + std::to_string(counter++) + ".tmp";
  Descriptor file(::open(temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
  if (file.get() < 0) {
    throw DatabaseIoError("cannot write database '" + path.string() + "': " + system_error(errno));
  }
  const auto fail = [&](const char* what) {
    const int error = errno;
    file.close();
    ::unlink(temporary.c_str());
    throw DatabaseIoError(std::string("cannot ") + what + " database '" + path.string() +
                          "': " + system_error(error));
  };
  std::size_t written = 0;
  while (written < block.size()) {
    constexpr std::size_t kPiece = 1U << 30U;
    const ssize_t n =
        ::write(file.get(), block.data() + written, std::min(kPiece, block.size() - written));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) fail("write");
    written += static_cast<std::size_t>(n);
  }
  if (::fsync(file.get()) != 0) fail("write");
  if (file.close() != 0) fail("write");
  if (::rename(temporary.c_str(), path.c_str()) != 0) fail("replace");
}

}  // namespace iksel
