// SPDX-License-Identifier: BSD-3-Clause
#include "base/hash.hpp"

#define XXH_INLINE_ALL  // header only: nothing to link against
#include <xxhash.h>

namespace iksel {

std::uint64_t checksum(const void* bytes, std::size_t size) { return XXH3_64bits(bytes, size); }

}  // namespace iksel
