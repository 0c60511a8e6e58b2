// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <urdf_model/model.h>
#include <urdf_world/types.h>

#include <filesystem>
#include <string>

namespace iksel {

/// Text of a URDF file. Throws UrdfError if it cannot be read.
std::string read_urdf_file(const std::filesystem::path& path);

/// Parses URDF text by urdfdom, whose console messages become the text of the UrdfError.
urdf::ModelInterfaceSharedPtr parse_urdf(const std::string& xml);

}  // namespace iksel
