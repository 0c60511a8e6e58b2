// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/database.hpp>

namespace iksel_headers {

void use_database(const iksel::Robot& robot, const std::filesystem::path& path) {
  const auto database = iksel::Database::build(robot, iksel::DatabaseOptions::paper(), {});
  iksel::Database::load(path, /*mmap=*/true).save(path);
  static_cast<void>(iksel::Database::from_bytes(database.to_bytes()).options().samples);
  static_cast<void>(database.size() + database.bytes() + database.chain_hash());
  static_cast<void>(database.dof() + database.key_dimension());
  static_cast<void>(database.q(0).size() + database.pseudo_inverse(0).size());
  static_cast<void>(database.nearest(database.pose(0), 3).size());
  static_cast<void>(iksel::grid_counts(6, iksel::Scale::small).size());
}

}  // namespace iksel_headers
