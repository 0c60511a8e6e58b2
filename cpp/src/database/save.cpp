// SPDX-License-Identifier: BSD-3-Clause
// Saving so that at every moment there is the old file or the new one, and no other stays.
#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdio>
#include <random>
#include <string>
#include <system_error>

#include "database/descriptor.hpp"
#include "database/file.hpp"
#include "iksel/error.hpp"

namespace iksel {
namespace {

namespace fs = std::filesystem;

// Files on their way bear names of their own, by chance: process numbers come again, in containers
// soon. Whoever writes one holds a lock on it until it has its place, and so one without a lock has
// nobody who will finish it.
std::string temporary_name(unsigned first, unsigned second) {
  char name[32];
  std::snprintf(name, sizeof name, "iksel-%08x%08x.tmp", first, second);
  return name;
}

bool is_temporary_name(const std::string& name) {
  unsigned first = 0;
  unsigned second = 0;
  return std::sscanf(name.c_str(), "iksel-%8x%8x", &first, &second) == 2 &&
         name == temporary_name(first, second);
}

bool lock(const Descriptor& file) { return ::flock(file.get(), LOCK_EX | LOCK_NB) == 0; }

/// Removes what saves that were killed have left in a folder.
void remove_abandoned(const fs::path& folder) {
  std::error_code none;
  for (fs::directory_iterator entry(folder, none), end; entry != end; entry.increment(none)) {
    if (!is_temporary_name(entry->path().filename().string())) continue;
    const Descriptor file(
        ::open(entry->path().c_str(), O_RDWR | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC));
    struct stat info {};
    if (file.get() < 0 || ::fstat(file.get(), &info) != 0) continue;
    if (!S_ISREG(info.st_mode) || info.st_uid != ::geteuid() || !lock(file)) continue;
    ::unlink(entry->path().c_str());
  }
}

/// A file of a new name, which is written to `name`; none if it cannot be made.
Descriptor open_named(const fs::path& folder, fs::path& name) {
  std::random_device random;
  for (int tries = 0; tries < 16; ++tries) {
    name = folder / temporary_name(random(), random());
    Descriptor file(::open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666));
    if (file.get() < 0 && errno == EEXIST) continue;
    if (file.get() < 0) return file;
    // Another's remove_abandoned may have come between.
    struct stat info {};
    const bool taken = !lock(file) && errno == EWOULDBLOCK;
    if (!taken && ::fstat(file.get(), &info) == 0 && info.st_nlink > 0) return file;
  }
  errno = EEXIST;
  return Descriptor();
}

bool write_all(const Descriptor& file, const Storage& storage) {
  std::size_t written = 0;
  while (written < storage.size) {
    const ssize_t n = ::write(file.get(), storage.bytes.get() + written, storage.size - written);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    written += static_cast<std::size_t>(n);
  }
  return ::fsync(file.get()) == 0;
}

/// What a path stands for, so that renaming leaves a link what it is.
fs::path behind_links(fs::path path) {
  std::error_code none;
  // Not for ever: they may go in a circle.
  for (int i = 0; i < 40 && fs::is_symlink(path, none); ++i) {
    path = path.parent_path() / fs::read_symlink(path, none);
  }
  return path;
}

}  // namespace

void write_file(const fs::path& path, const Storage& storage) {
  const fs::path target = behind_links(path);
  const fs::path folder = target.has_parent_path() ? target.parent_path() : fs::path(".");
  fs::path name;
  const auto fail = [&](const char* act) {
    const int error = errno;
    if (!name.empty()) ::unlink(name.c_str());
    throw_io(act, path, system_error(error));
  };
  // Renaming would put a file in the place of a device.
  struct stat there {};
  if (::stat(path.c_str(), &there) == 0 && !S_ISREG(there.st_mode)) {
    throw_io("write", path, "it is no regular file");
  }
  remove_abandoned(folder);
  fs::path made;
  const Descriptor file = open_named(folder, made);
  if (file.get() < 0) fail("write");
  name = made;
  if (!write_all(file, storage)) fail("write");
  if (::rename(name.c_str(), target.c_str()) != 0) fail("replace");
}

}  // namespace iksel
