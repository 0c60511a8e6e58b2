// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"

namespace iksel::python {

namespace {

Database build(const Robot& robot, const DatabaseOptions& options,
               const std::optional<ProgressCallable>& progress) {
  const Progress report = make_progress(progress);
  return without_gil([&] { return Database::build(robot, options, report); });
}

Database load(const PathLike& path, bool mmap) {
  const std::filesystem::path file = as_path(path, "path");
  return without_gil([&] { return Database::load(file, mmap); });
}

void save(const Database& self, const PathLike& path) {
  const std::filesystem::path file = as_path(path, "path");
  without_gil([&] { self.save(file); });
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
  const std::string copy = content;
  return without_gil([&] { return Database::from_bytes(copy); });
}

/// What `kGet` gives of the sample.
template <auto kGet>
py::array_t<double> of_sample(const Database& self, std::size_t i) {
  if (i < self.size()) return to_array((self.*kGet)(i));
  throw InvalidArgumentError("i: expected a sample from 0 to " + std::to_string(self.size() - 1) +
                             ", got " + std::to_string(i));
}

py::array_t<std::int64_t> nearest(const Database& self, const Pose& T_base_tip, std::size_t k) {
  const auto found = self.nearest(T_base_tip, k);
  py::array_t<std::int64_t> indices(static_cast<py::ssize_t>(found.size()));
  std::copy(found.begin(), found.end(), indices.mutable_data());
  return indices;
}

void bind_samples(py::class_<Database>& cls) {
  def(cls, "q", "i", fn<&of_sample<&Database::q>>);
  def(cls, "pose", "i", fn<&of_sample<&Database::pose>>);
  def(cls, "pseudo_inverse", "i", fn<&of_sample<&Database::pseudo_inverse>>);
  def(cls, "nearest", "pose, k", fn<&nearest>);
}

void bind_files(py::class_<Database>& cls) {
  def_static(cls, "load", "path, *, mmap=False", fn<&load>,
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
  def(cls, "save", "path", fn<&save>,
      R"(Writes beside `path` and renames, so that a crash leaves the old file or the new one.

Removes files named iksel-*.tmp in the same folder that saves which were killed have left.

Raises:
    DatabaseIoError: the file cannot be written; an old one is untouched.)");
  def(cls, "to_bytes", "", fn<&to_bytes>);
  def_static(cls, "from_bytes", "content", fn<&from_bytes>,
             "The database that `to_bytes` wrote. Raises as `load`.");
}

}  // namespace

void bind_database(py::module_& m) {
  auto cls = bind_class<Database>(m, "Database", "Database.build(robot) or Database.load(path)");
  def_static(cls, "build", "robot, options=DatabaseOptions(), progress=None", fn<&build>,
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
  add_property(cls, "options", [](const Database& self) { return self.options(); });
  add_property(cls, "size", &Database::size);
  def(cls, "__len__", "", fn<&Database::size>);
  add_properties(cls, "dof", &Database::dof, "key_dimension", &Database::key_dimension);
  add_property(cls, "nbytes", &Database::bytes, header_text("Database.bytes"));
  add_property(cls, "chain_hash", &Database::chain_hash);
  bind_samples(cls);

  def_repr(cls);
  def_copies(cls);
  def(cls, "__getstate__", "", [](const Database& self) { return to_bytes(self); });
  def_init(
      cls, "state", [](const py::bytes& state) { return from_bytes(state); }, "", "__setstate__");
  def(m, "grid_counts", "dof, scale", fn<&grid_counts>,
      "Points per joint of the paper's grid, base to tip.");
}

}  // namespace iksel::python
