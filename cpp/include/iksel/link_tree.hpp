// SPDX-License-Identifier: BSD-3-Clause
// What a URDF holds before a chain is chosen: its links and the joints between them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "iksel/export.hpp"

namespace iksel {

/// One joint of a URDF.
struct LinkTreeJoint {
  std::string name;         ///< its name
  std::string type;         ///< "revolute", "fixed", ...
  std::string parent_link;  ///< the link that it is on
  std::string child_link;   ///< the link that it carries
};

/// The tree of a URDF's links, depth first from the root.
struct IKSEL_EXPORT LinkTree {
  std::string robot_name;             ///< name in the URDF
  std::vector<std::string> links;     ///< names of all links, the root first
  std::vector<LinkTreeJoint> joints;  ///< each leads to the next link
  /// Links without children, and how many joints move each of them: the tips to choose from.
  struct Tip {
    std::string link;
    int moving_joints;
  };
  std::vector<Tip> tips;

  /// Reads a URDF file. Where its links hang in several trees, the one with `link` is meant.
  /// Throws UrdfError.
  static LinkTree from_urdf_file(const std::filesystem::path& path, const std::string& link = "");
  /// Reads the bytes of a URDF file, as from_urdf_file does.
  static LinkTree from_urdf_string(const std::string& xml, const std::string& link = "");

  /// One line per link, indented under its parent, with the joint that carries it.
  [[nodiscard]] std::string draw() const;
};

}  // namespace iksel
