// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <filesystem>
#include <string>
#include <vector>

#include "iksel/error.hpp"
#include "iksel/link_tree.hpp"

namespace iksel {

/// Bytes of a URDF file. Throws UrdfError if it cannot be read.
std::string read_urdf_file(const std::filesystem::path& path);

/// Parses the bytes of a URDF by urdfdom, whose console messages become the text of the UrdfError.
/// Of several trees of links that with `links` is left, see keep_one_tree (urdf/urdf_text.hpp).
urdf::ModelInterfaceSharedPtr parse_urdf(const std::string& xml,
                                         const std::vector<std::string>& links = {});

/// Names of all joints, in order of the alphabet.
std::vector<std::string> joint_names_of(const urdf::ModelInterface& model);

LinkTree make_link_tree(const urdf::ModelInterface& model);

/// "revolute", "fixed", ...
const char* joint_type_name(int type);

/// Throws the UrdfError of text that holds xacro and failed as URDF for `reason`; nothing where
/// there is no xacro.
void throw_if_xacro(const std::string& xml, const std::string& reason);

/// What `read` makes of the text; if it fails and the text is xacro, the error says that.
template <typename Read>
auto explain_xacro(const std::string& xml, const Read& read) {
  try {
    return read();
  } catch (const UrdfError& error) {
    throw_if_xacro(xml, error.what());
    throw;
  }
}

/// What `read` makes of the text of a file, which its errors name.
template <typename Read>
auto read_with_path(const std::filesystem::path& path, const Read& read) {
  const std::string where = "URDF file '" + path.string() + "': ";
  const std::string xml = read_urdf_file(path);
  try {
    return read(xml);
  } catch (const UnknownNameError& error) {
    throw UnknownNameError(where + error.what(), error.available());
  } catch (const UrdfError& error) {
    throw UrdfError(where + error.what(), error.available());
  }
}

}  // namespace iksel
