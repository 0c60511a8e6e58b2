// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/error.hpp>

namespace iksel_headers {

void use_error() {
  const iksel::UrdfError::Names names = {"tool0"};
  if (iksel::UrdfError("no such link", names).available() != names) throw iksel::Error("");
  if (iksel::UnknownNameError("").available().empty()) throw iksel::InvalidArgumentError("");
  if (iksel::DatabaseIoError("").what() == nullptr) throw iksel::DatabaseCorruptError("");
  throw iksel::DatabaseMismatchError("");
}

}  // namespace iksel_headers
