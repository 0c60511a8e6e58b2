// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"

namespace iksel::python {

template <>
struct FieldTable<Structure> : HeaderTable<Structure> {};

void bind_structure(py::module_& m) {
  bind_enums<StructureKind>(m);
  bind_fields<Structure>(m, "Robot.structure");
}

}  // namespace iksel::python
