// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/version.hpp>

static_assert(iksel::kVersion[0] != '\0');
