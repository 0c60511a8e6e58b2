// SPDX-License-Identifier: BSD-3-Clause
// A URDF as people hold it: a path, or the text itself, as str or bytes.
#pragma once

#include <string>

#include "python_types.hpp"

namespace iksel::python {

/// A path, or the text or bytes of a URDF.
struct UrdfSource : RawArgument {
  using RawArgument::RawArgument;
  static constexpr const char* kText = "str | bytes | os.PathLike[str]";
};

/// Whether a str is the text of a URDF and no path.
inline bool is_xml(const std::string& text) {
  const auto start = text.find_first_not_of(" \t\r\n\xEF\xBB\xBF");
  return start != std::string::npos && text[start] == '<';
}

/// `from_text` of the text, as a str or as the bytes of a file, or `from_file` of the path.
template <typename FromText, typename FromFile>
auto read_urdf(const UrdfSource& path_or_xml, const FromText& from_text,
               const FromFile& from_file) {
  if (py::isinstance<py::str>(path_or_xml)) {
    // What is no UTF-8 may still be a path.
    const py::bytes bytes = path_or_xml.attr("encode")("utf-8", "replace");
    const auto text = py::cast<std::string>(bytes);
    if (is_xml(text)) return from_text(text);
  }
  if (py::isinstance<py::bytes>(path_or_xml)) return from_text(py::cast<std::string>(path_or_xml));
  if (!py::isinstance<py::str>(path_or_xml) && !py::hasattr(path_or_xml, "__fspath__")) {
    throw_wrong_type("path_or_xml",
                     "the path of a URDF file, or its text as str or bytes; iksel.load_robot reads "
                     "robots of other libraries",
                     path_or_xml);
  }
  return from_file(as_path(path_or_xml, "path_or_xml"));
}

}  // namespace iksel::python
