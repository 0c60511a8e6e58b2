// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/simd.hpp>

namespace iksel_headers {

void use_simd() { static_cast<void>(iksel::simd_level()); }

}  // namespace iksel_headers
