// SPDX-License-Identifier: BSD-3-Clause
// Databases in memory of their own.
#include <fcntl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdlib>
#include <new>

#include "database/descriptor.hpp"
#include "database/file.hpp"
#include "iksel/error.hpp"

namespace iksel {

HeapStorage::HeapStorage(std::size_t payload) : size_(kHeaderSize + payload) {
  constexpr std::size_t kAlignment = 64;
  const std::size_t rounded = (size_ + kAlignment - 1) / kAlignment * kAlignment;
  bytes_ = static_cast<unsigned char*>(std::aligned_alloc(kAlignment, rounded));
  if (bytes_ == nullptr) throw std::bad_alloc();
}

HeapStorage::~HeapStorage() { std::free(bytes_); }

Descriptor open_database(const std::filesystem::path& path, std::size_t& size) {
  const std::string name = "database '" + path.string() + "'";
  // Without O_NONBLOCK a pipe would wait for its writer.
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) throw DatabaseIoError("cannot open " + name + ": " + system_error(errno));
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) {
    throw DatabaseIoError("cannot read " + name + ": " + system_error(errno));
  }
  if (!S_ISREG(info.st_mode)) {
    throw DatabaseIoError("cannot read " + name + ": not a regular file");
  }
  size = static_cast<std::size_t>(info.st_size);
  if (size < kHeaderSize) {
    throw DatabaseCorruptError(name + ": truncated: " + std::to_string(size) +
                               " bytes, less than a header");
  }
  return file;
}

std::shared_ptr<const Storage> read_file(const std::filesystem::path& path) {
  const std::string name = "database '" + path.string() + "'";
  std::size_t size = 0;
  const Descriptor file = open_database(path, size);
  std::shared_ptr<HeapStorage> storage;
  try {
    storage = std::make_shared<HeapStorage>(size - kHeaderSize);
  } catch (const std::bad_alloc&) {
    throw DatabaseIoError("cannot read " + name + ": no memory for " + std::to_string(size) +
                          " bytes");
  }
  for (std::size_t done = 0; done < size;) {
    const ssize_t n = ::read(file.get(), storage->writable() + done, size - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw DatabaseIoError("cannot read " + name + ": " + system_error(errno));
    if (n == 0) throw DatabaseCorruptError(name + ": truncated while it was read");
    done += static_cast<std::size_t>(n);
  }
  return storage;
}

}  // namespace iksel
