// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/export.hpp>

class IKSEL_EXPORT Exported;
static_assert(sizeof(Exported*) > 0);
