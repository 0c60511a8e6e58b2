// SPDX-License-Identifier: BSD-3-Clause
// Every exception the library throws. Each message names the culprit and lists what was possible.
#pragma once

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "iksel/export.hpp"

namespace iksel {

/// Base of every exception of the library.
class IKSEL_EXPORT Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A URDF that cannot be read, parsed or turned into a chain.
class IKSEL_EXPORT UrdfError : public Error {
 public:
  using Names = std::vector<std::string>;

  using Error::Error;
  UrdfError(const std::string& message, Names available)
      : Error(message), available_(std::make_shared<const Names>(std::move(available))) {}

  /// The names that there were to choose from, all of them (a message shortens long lists); empty
  /// where the error is not about a name.
  [[nodiscard]] Names available() const { return available_ ? *available_ : Names{}; }

 private:
  std::shared_ptr<const Names> available_;  // exceptions are copied, and that must not throw
};

/// A link or joint name that the URDF does not have.
class IKSEL_EXPORT UnknownNameError : public UrdfError {
 public:
  using UrdfError::UrdfError;
};

/// An argument of the wrong size or value: a pose that is not rigid, a non-finite number, a q of
/// the wrong length, an option out of range.
class IKSEL_EXPORT InvalidArgumentError : public Error {
 public:
  using Error::Error;
};

/// A database that cannot be built, read, written or trusted.
class IKSEL_EXPORT DatabaseError : public Error {
 public:
  using Error::Error;
};

/// A database file that cannot be opened, read or written (no such file, full disk, no permission).
class IKSEL_EXPORT DatabaseIoError : public DatabaseError {
 public:
  using DatabaseError::DatabaseError;
};

/// A database file that is truncated, corrupted, or no database at all.
class IKSEL_EXPORT DatabaseCorruptError : public DatabaseError {
 public:
  using DatabaseError::DatabaseError;
};

/// An intact database that does not fit: other robot, other format version, other byte order.
class IKSEL_EXPORT DatabaseMismatchError : public DatabaseError {
 public:
  using DatabaseError::DatabaseError;
};

}  // namespace iksel
