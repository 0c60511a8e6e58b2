// SPDX-License-Identifier: BSD-3-Clause
// Databases mapped from files.
//
// Whoever can write to a file can cut it short, and the next look at what is gone raises SIGBUS;
// nothing that a process may hold on a file prevents it. So a handler of that signal, installed
// with the first mapping, puts zeros in the place of what is gone and marks the mapping; solves
// then end as they would with bad seeds, and the next call says what happened. All other faults go
// to the handler that was there before.
#include <sys/mman.h>

#include <array>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <mutex>
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

constexpr std::size_t kMostMappings = 256;
std::array<Watched, kMostMappings> watched;
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

class MappedStorage final : public Storage {
 public:
  MappedStorage(void* bytes, std::size_t size) : bytes_(bytes), size_(size) {}
  MappedStorage(const MappedStorage&) = delete;
  MappedStorage& operator=(const MappedStorage&) = delete;
  ~MappedStorage() override {
    if (watched_ != nullptr) {
      const std::lock_guard<std::mutex> lock(watched_mutex);
      watched_->begin = 0;
    }
    ::munmap(bytes_, size_);
  }
  [[nodiscard]] bool watch() { return (watched_ = iksel::watch(bytes_, size_)) != nullptr; }
  [[nodiscard]] const unsigned char* data() const override {
    return static_cast<const unsigned char*>(bytes_);
  }
  [[nodiscard]] std::size_t size() const override { return size_; }
  [[nodiscard]] const std::atomic<bool>* damaged() const override { return &watched_->damaged; }

 private:
  void* bytes_;
  std::size_t size_;
  Watched* watched_ = nullptr;
};

}  // namespace

std::shared_ptr<const Storage> map_file(const std::filesystem::path& path) {
  std::size_t size = 0;
  const Descriptor file = open_database(path, size);
  void* bytes = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, file.get(), 0);
  if (bytes == MAP_FAILED) {
    throw DatabaseIoError("cannot map database '" + path.string() + "': " + system_error(errno));
  }
  auto storage = std::make_shared<MappedStorage>(bytes, size);
  if (!storage->watch()) {
    throw DatabaseIoError("cannot map database '" + path.string() +
                          "': " + std::to_string(kMostMappings) + " are mapped already");
  }
  return storage;
}

}  // namespace iksel
