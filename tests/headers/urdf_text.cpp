// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/urdf_text.hpp>

namespace iksel_headers {

bool use_urdf_text(const std::string& bytes) { return iksel::mend_xml(bytes, "base").empty(); }

}  // namespace iksel_headers
