// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/structure.hpp"

#include <string>

#include "bindings.hpp"
#include "fields.hpp"

namespace iksel::python {

template <>
struct FieldTable<Structure> {
  static constexpr const char* kName = "Structure";
  static constexpr const char* kDoc = "What follows from how the axes of a chain lie.";
  static std::vector<Field> fields() {
    return {field("kind", &Structure::kind, "How the solutions of a pose can be found."),
            field("description", &Structure::description,
                  "Which axes, numbered from 1, are parallel or meet, or that none do that would "
                  "help; a sentence without its full stop.")};
  }
};

void bind_structure(py::module_& m) {
  bind_enum<StructureKind>(m);
  auto cls = bind_fields<Structure>(m, "Robot.structure");
  def(cls, "__repr__", "", [](const Structure& self) {
    return std::string("Structure(") + enum_name(self.kind) + ": " + self.description + ")";
  });
}

}  // namespace iksel::python
