// SPDX-License-Identifier: BSD-3-Clause
#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "array_checks.hpp"
#include "bindings.hpp"
#include "gil.hpp"
#include "iksel/database.hpp"
#include "option_fields.hpp"
#include "pose_arguments.hpp"
#include "progress.hpp"
#include "property.hpp"

namespace iksel::python {

namespace {

Database build(const Loose<Robot>& given_robot, const Loose<DatabaseOptions>& given_options,
               const std::optional<ProgressCallable>& progress) {
  const auto robot = from_python<Robot>(given_robot, "robot");
  const auto options = from_python<DatabaseOptions>(given_options, "options");
  const Progress report = make_progress(progress);
  const GilRelease release;
  return Database::build(robot, options, report);
}

Database load(const PathLike& path, const Loose<bool>& mmap) {
  const std::filesystem::path file = as_path(path, "path");
  const auto mapped = from_python<bool>(mmap, "mmap");
  const GilRelease release;
  return Database::load(file, mapped);
}

void save(const Database& self, const PathLike& path) {
  const std::filesystem::path file = as_path(path, "path");
  const GilRelease release;
  self.save(file);
}

py::bytes to_bytes(const Database& self) {
  std::string content;
  {
    const GilRelease release;
    content = self.to_bytes();
  }
  return content;
}

Database from_bytes(const py::bytes& content) {
  const std::string copy(content);
  const GilRelease release;
  return Database::from_bytes(copy);
}

std::size_t sample_index(const Database& self, const Loose<std::size_t>& i) {
  const auto index = from_python<std::size_t>(i, "i");
  if (index >= self.size()) {
    throw InvalidArgumentError("i: expected a sample from 0 to " + std::to_string(self.size() - 1) +
                               ", got " + std::to_string(index));
  }
  return index;
}

py::array_t<std::int64_t> nearest(const Database& self, const PoseLike& pose,
                                  const Loose<std::size_t>& k) {
  const Pose T_base_tip = as_pose(pose, "pose");
  const auto found = self.nearest(T_base_tip, from_python<std::size_t>(k, "k"));
  py::array_t<std::int64_t> indices(static_cast<py::ssize_t>(found.size()));
  std::copy(found.begin(), found.end(), indices.mutable_data());
  return indices;
}

void bind_samples(py::class_<Database>& cls) {
  cls.def(
      "q",
      [](const Database& self, const Loose<std::size_t>& i) {
        return to_array(self.q(sample_index(self, i)));
      },
      py::arg("i"), "Joint values of sample i [rad or m], (dof,).");
  cls.def(
      "pose",
      [](const Database& self, const Loose<std::size_t>& i) {
        return to_array(self.pose(sample_index(self, i)));
      },
      py::arg("i"), "T_base_tip of sample i, of the tip link without the TCP, (4, 4).");
  cls.def(
      "pseudo_inverse",
      [](const Database& self, const Loose<std::size_t>& i) {
        return to_array(self.pseudo_inverse(sample_index(self, i)));
      },
      py::arg("i"), "J^+ of sample i, as in Eq. (4) of the paper, (dof, 6).");
  cls.def("nearest", &nearest, py::arg("pose"), py::arg("k"),
          "Indices of the k samples whose keys are nearest to that of a (4, 4) pose of the tip "
          "link, nearest first; Eq. (2) of the paper.");
}

void bind_files(py::class_<Database>& cls) {
  cls.def_static("load", &load, py::arg("path"), py::kw_only(), py::arg("mmap") = false,
                 R"(Reads a file, after which it may be changed or removed.

Args:
    path: what `save` wrote.
    mmap: leave the samples, most of a large file, in the file and map them read-only, so
        that processes that load one file share them. The file may then be replaced (`save`
        does so) or removed, but should not be written to: what is overwritten in place is
        not noticed, and makes seeds worse, never an answer wrong. Where a file is cut short,
        the call under way still ends, and the next one on the database or a solver of it
        raises DatabaseIoError; for this the first such load installs a handler of SIGBUS,
        which passes on what is not its own. At most 256 files are mapped at once.

Raises:
    DatabaseIoError: the file cannot be read.
    DatabaseCorruptError: the file is damaged or no database.
    DatabaseMismatchError: another format version or byte order.)");
  cls.def("save", &save, py::arg("path"),
          R"(Writes beside `path` and renames, so that a crash leaves the old file or the new one.

Removes files named iksel-*.tmp in the same folder that saves which were killed have left.

Raises:
    DatabaseIoError: the file cannot be written; an old one is untouched.)");
  cls.def("to_bytes", &to_bytes, "The content of a file, for sending.");
  cls.def_static("from_bytes", &from_bytes, py::arg("content"),
                 "The database that `to_bytes` wrote. Raises as `load`.");
}

}  // namespace

void bind_database(py::module_& m) {
  py::class_<Database> cls(m, "Database",
                           "An immutable set of samples (q_i, x_i, J_i^+) of a robot under a "
                           "KD-tree. Safe to use from many threads at once.");
  cls.def_static("build", &build, py::arg("robot"),
                 py::arg_v("options", DatabaseOptions{}, "DatabaseOptions()"),
                 py::arg("progress") = py::none(),
                 R"(Samples the joint limits and computes pose, Jacobian and pseudo-inverse.

Args:
    robot: the chain; its TCP plays no part.
    options: how to sample.
    progress: called now and then with (samples done, samples in all). What it raises ends
        the build. The GIL is released between calls, and Ctrl-C works.

Raises:
    InvalidArgumentError: an option out of range.
    DatabaseError: more samples than fit.)");
  bind_files(cls);
  add_property(
      cls, "options", [](const Database& self) { return self.options(); },
      "A copy of the options it was built with.");
  add_property(cls, "size", &Database::size, "Number of samples.");
  cls.def("__len__", &Database::size);
  add_property(cls, "dof", &Database::dof, "Degrees of freedom of its robot.");
  add_property(cls, "key_dimension", &Database::key_dimension, "Dimension of the KD-tree's key.");
  add_property(
      cls, "nbytes", &Database::bytes,
      "Bytes of all that it holds: samples, keys and pseudo-inverses, the trees over them, "
      "and the copies that are laid out for the lanes. Bytes of a mapped file are among "
      "them.");
  add_property(cls, "chain_hash", &Database::chain_hash,
               "Robot.chain_hash of the robot it belongs to.");
  bind_samples(cls);

  cls.def("__repr__", [](const Database& self) {
    return "Database(" + std::to_string(self.size()) +
           " samples, dof=" + std::to_string(self.dof()) + ", " + to_repr(self.options()) + ")";
  });
  cls.def("__copy__", [](const Database& self) { return self; });
  cls.def(
      "__deepcopy__", [](const Database& self, const py::dict&) { return self; }, py::arg("memo"));
  cls.def(py::pickle(&to_bytes, &from_bytes));

  m.def(
      "grid_counts",
      [](const Loose<int>& dof, const Loose<Scale>& scale) {
        return grid_counts(from_python<int>(dof, "dof"), from_python<Scale>(scale, "scale"));
      },
      py::arg("dof"), py::arg("scale"), "Points per joint of the paper's grid, base to tip.");
}

}  // namespace iksel::python
