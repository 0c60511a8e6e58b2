// SPDX-License-Identifier: BSD-3-Clause
// The file format: a fixed header, then keys and records as they lie in memory.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "database/data.hpp"

namespace iksel {

inline constexpr std::size_t kHeaderSize = 512;

/// Room for the header and `payload` bytes, on the heap, to be filled by the caller.
class HeapStorage final : public Storage {
 public:
  explicit HeapStorage(std::size_t payload);
  HeapStorage(const HeapStorage&) = delete;
  HeapStorage& operator=(const HeapStorage&) = delete;
  ~HeapStorage() override;
  [[nodiscard]] const unsigned char* data() const override { return bytes_; }
  [[nodiscard]] std::size_t size() const override { return size_; }
  [[nodiscard]] unsigned char* writable() { return bytes_; }

 private:
  unsigned char* bytes_ = nullptr;
  std::size_t size_;
};

/// Writes the header for `data`, whose payload stands behind it already.
void write_header(const DatabaseData& data, unsigned char* storage, std::size_t size);

/// Checks a storage (magic, byte order, version, sizes, checksums) and points `DatabaseData` into
/// it. `name` names it in errors.
DatabaseData read_storage(std::shared_ptr<const Storage> storage, const std::string& name);

/// Reads a file into memory of its own.
std::shared_ptr<const Storage> read_file(const std::filesystem::path& path);

/// Maps a file read-only. Where the file is cut short afterwards, the mapping reads as zeros and is
/// marked as damaged (mapped_file.cpp).
std::shared_ptr<const Storage> map_file(const std::filesystem::path& path);

/// Writes a file beside `path`, syncs and renames; first removes what saves that were killed left
/// in the folder. A file without a name, where the system has such, leaves nothing when killed;
/// tests can do without it.
void write_file(const std::filesystem::path& path, const Storage& storage, bool nameless = true);

}  // namespace iksel
