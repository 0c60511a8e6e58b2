// SPDX-License-Identifier: BSD-3-Clause
// Open files.
#pragma once

#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <string>
#include <utility>

#include "iksel/error.hpp"

namespace iksel {

/// A file descriptor that closes itself; below 0: none.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor() {
    if (fd_ >= 0) ::close(fd_);
  }
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

inline std::string system_error(int error) { return std::strerror(error); }

/// Throws DatabaseIoError "cannot `act` database 'path': why".
[[noreturn]] inline void throw_io(const char* act, const std::filesystem::path& path,
                                  const std::string& why) {
  throw DatabaseIoError(std::string("cannot ") + act + " database '" + path.string() + "': " + why);
}

}  // namespace iksel
