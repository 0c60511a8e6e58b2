// SPDX-License-Identifier: BSD-3-Clause
// Databases read, or mapped, from files.
//
// Whoever can write to a mapped file can cut it short, and the next look at what is gone raises
// SIGBUS; nothing that a process may hold on a file prevents it. So a handler of that signal,
// installed with the first mapping, puts zeros in the place of what is gone and marks the mapping;
// solves then end as they would with bad seeds, and the next call says what happened. All other
// faults go to the handler that was there before.
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <mutex>
#include <new>
#include <string>

#include "database/descriptor.hpp"
#include "database/file.hpp"
#include "iksel/error.hpp"

namespace iksel {
namespace {

/// A mapping as the handler sees it; it may neither lock nor allocate.
struct Watched {
  std::atomic<std::uintptr_t> begin{0};  ///< 0: free
  std::atomic<std::uintptr_t> end{0};
  std::atomic<bool> damaged{false};
};
static_assert(std::atomic<std::uintptr_t>::is_always_lock_free);

std::array<Watched, 256> watched;
std::mutex watched_mutex;  ///< of those who add and remove
std::uintptr_t page_size = 4096;
struct sigaction previous {};

/// Puts zeros from the page of `address` to the end of the mapping that it lies in, if any.
bool replace_lost_pages(std::uintptr_t address) {
  for (Watched& mapping : watched) {
    const std::uintptr_t begin = mapping.begin;
    const std::uintptr_t end = mapping.end;
    if (begin == 0 || address < begin || address >= end) continue;
    const std::uintptr_t page = address / page_size * page_size;
    mapping.damaged = true;
    // NOLINTNEXTLINE(performance-no-int-to-ptr): an address is all that a handler is told.
    return ::mmap(reinterpret_cast<void*>(page), end - page, PROT_READ,
                  MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1, 0) != MAP_FAILED;
  }
  return false;
}

void on_bus_error(int signal, siginfo_t* info, void* context) {
  const int error = errno;
  if (!replace_lost_pages(reinterpret_cast<std::uintptr_t>(info->si_addr))) {
    if ((previous.sa_flags & SA_SIGINFO) != 0) {
      previous.sa_sigaction(signal, info, context);
    } else if (previous.sa_handler != SIG_DFL && previous.sa_handler != SIG_IGN) {
      previous.sa_handler(signal);
    } else {
      // The fault comes again when this returns, and ends the process as ever.
      ::signal(signal, SIG_DFL);
    }
  }
  errno = error;
}

void install_handler() {
  page_size = static_cast<std::uintptr_t>(::sysconf(_SC_PAGESIZE));
  struct sigaction ours {};
  ours.sa_sigaction = &on_bus_error;
  ours.sa_flags = SA_SIGINFO | SA_ONSTACK;
  ::sigemptyset(&ours.sa_mask);
  ::sigaction(SIGBUS, nullptr, &previous);
  ::sigaction(SIGBUS, &ours, nullptr);
}

/// A place for one more mapping; null if there is none.
Watched* watch(void* bytes, std::size_t size) {
  static std::once_flag installed;
  std::call_once(installed, install_handler);
  const std::lock_guard<std::mutex> lock(watched_mutex);
  for (Watched& place : watched) {
    if (place.begin != 0) continue;
    const auto begin = reinterpret_cast<std::uintptr_t>(bytes);
    place.damaged = false;
    place.end = (begin + size + page_size - 1) / page_size * page_size;
    place.begin = begin;
    return &place;
  }
  return nullptr;
}

/// Opens a regular file.
Descriptor open_database(const std::filesystem::path& path, std::size_t& size) {
  // Without O_NONBLOCK a pipe would wait for its writer.
  Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.get() < 0) throw_io("open", path, system_error(errno));
  struct stat info {};
  if (::fstat(file.get(), &info) != 0) throw_io("read", path, system_error(errno));
  if (!S_ISREG(info.st_mode)) throw_io("read", path, "not a regular file");
  size = static_cast<std::size_t>(info.st_size);
  return file;
}

}  // namespace

Storage read_file(const std::filesystem::path& path) {
  std::size_t size = 0;
  const Descriptor file = open_database(path, size);
  std::shared_ptr<unsigned char> bytes;
  try {
    bytes = allocate(size);
  } catch (const std::bad_alloc&) {
    throw_io("read", path, "no memory for " + std::to_string(size) + " bytes");
  }
  for (std::size_t done = 0; done < size;) {
    const ssize_t n = ::read(file.get(), bytes.get() + done, size - done);
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) throw_io("read", path, system_error(errno));
    if (n == 0) {
      throw DatabaseCorruptError("database '" + path.string() + "': truncated while it was read");
    }
    done += static_cast<std::size_t>(n);
  }
  return {bytes, size};
}

Storage map_file(const std::filesystem::path& path) {
  std::size_t size = 0;
  const Descriptor file = open_database(path, size);
  // Of an empty file nothing can be mapped.
  if (size == 0) return {};
  void* bytes = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.get(), 0);
  if (bytes == MAP_FAILED) throw_io("map", path, system_error(errno));
  Watched* const place = watch(bytes, size);
  const auto unmap = [bytes, size, place](const unsigned char* /*bytes*/) {
    if (place != nullptr) {
      const std::lock_guard<std::mutex> lock(watched_mutex);
      place->begin = 0;
    }
    ::munmap(bytes, size);
  };
  std::shared_ptr<const unsigned char> mapped(static_cast<const unsigned char*>(bytes), unmap);
  if (place == nullptr) {
    throw_io("map", path, std::to_string(watched.size()) + " are mapped already");
  }
  return {mapped, size, &place->damaged};
}

}  // namespace iksel
