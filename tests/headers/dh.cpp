// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/dh.hpp>

namespace iksel_headers {

iksel::DhTable use_dh() {
  iksel::DhTable table;
  table.joints.resize(2);
  table.convention = iksel::DhConvention::modified;
  return table;
}

}  // namespace iksel_headers
