// SPDX-License-Identifier: BSD-3-Clause
#include <iksel/link_tree.hpp>

namespace iksel_headers {

void use_link_tree(const std::filesystem::path& path) {
  const auto tree = iksel::LinkTree::from_urdf_file(path);
  static_cast<void>(iksel::LinkTree::from_urdf_string(tree.draw()).tips.size());
}

}  // namespace iksel_headers
