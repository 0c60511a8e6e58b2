// SPDX-License-Identifier: BSD-3-Clause
#include "base/parallel.hpp"
#include "iksel/error.hpp"
#include "iksel/options.hpp"
#include "options/option_check.hpp"

namespace iksel {

DatabaseOptions DatabaseOptions::paper() {
  DatabaseOptions options;
  options.sampling = Sampling::grid;
  options.scale = Scale::medium;
  options.key_scheme = KeyScheme::full;
  options.rotation_key = RotationKey::rotation_vector;
  options.rotation_weight = 1.0;
  options.pinv_cutoff = 1e-4;
  return options;
}

void DatabaseOptions::validate() const {
  check_enum("sampling", sampling, Sampling::random);
  check_enum("scale", scale, Scale::large);
  check_enum("key_scheme", key_scheme, KeyScheme::reduced);
  check_enum("rotation_key", rotation_key, RotationKey::euler);
  if (key_scheme == KeyScheme::reduced && rotation_key != RotationKey::rotation_vector) {
    throw InvalidArgumentError(
        "option rotation_key: only a full key writes rotations in different ways; set key_scheme "
        "to full with it");
  }
  check_range<std::size_t>("samples", samples, 0, 4'000'000'000U);
  check_range("rotation_weight", rotation_weight, 0.0, 1e6);
  check_range("pinv_cutoff", pinv_cutoff, 0.0, 0.5);
  check_range<std::size_t>("cvt_updates", cvt_updates, 0, 1'000'000'000U);
  resolve_threads(threads);
}

}  // namespace iksel
