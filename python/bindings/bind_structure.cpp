// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/structure.hpp"

#include <string>

#include "bindings.hpp"
#include "enums.hpp"
#include "pickle.hpp"
#include "property.hpp"

namespace iksel::python {

namespace {

py::object structure_state(const Structure& self) {
  return py::make_tuple(enum_name(self.kind), self.description);
}

Structure structure_from_state(const py::object& state) {
  PickleState in(state, "Structure", 2);
  Structure structure;
  structure.kind = in.value<StructureKind>("kind");
  structure.description = in.value<std::string>("description");
  return structure;
}

}  // namespace

void bind_structure(py::module_& m) {
  bind_enum<StructureKind>(m);
  py::class_<Structure> cls(m, "Structure", "What follows from how the axes of a chain lie.");
  add_property(cls, "kind", &Structure::kind, "How the solutions of a pose can be found.");
  add_property(cls, "description", &Structure::description,
               "Which axes, numbered from 1, are parallel or meet, or that none do that would "
               "help; a sentence without its full stop.");
  cls.def(py::pickle(&structure_state, &structure_from_state));
  cls.def("__repr__", [](const Structure& self) {
    return std::string("Structure(") + enum_name(self.kind) + ": " + self.description + ")";
  });
}

}  // namespace iksel::python
