// SPDX-License-Identifier: BSD-3-Clause
// The file format: a fixed header, then keys and records as they lie in memory.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "database/data.hpp"

namespace iksel {

inline constexpr std::size_t kHeaderSize = 512;

/// Room on the heap for a storage's bytes, the header's among them. Throws std::bad_alloc.
std::shared_ptr<unsigned char> allocate(std::size_t size);

/// Writes the header for `data`, whose payload stands behind it already.
void write_header(const DatabaseData& data, unsigned char* storage, std::size_t size);

/// Checks a storage (magic, byte order, version, sizes, checksums) and points `DatabaseData` into
/// it. `name` names it in errors.
DatabaseData read_storage(const Storage& storage, const std::string& name);

/// Reads a file into memory of its own.
Storage read_file(const std::filesystem::path& path);

/// Maps a file read-only. Where the file is cut short afterwards, the mapping reads as zeros and is
/// marked as damaged (load.cpp).
Storage map_file(const std::filesystem::path& path);

/// Writes a file beside `path`, syncs and renames; first removes what saves that were killed left
/// in the folder.
void write_file(const std::filesystem::path& path, const Storage& storage);

}  // namespace iksel
