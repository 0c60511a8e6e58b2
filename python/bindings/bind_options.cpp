// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"
#include "option_fields.hpp"

namespace iksel::python {

void bind_options(py::module_& m) {
  bind_enum<Sampling>(m);
  bind_enum<Scale>(m);
  bind_enum<KeyScheme>(m);
  bind_enum<RotationKey>(m);
  bind_enum<Ranking>(m);
  bind_enum<RotationDifference>(m);
  bind_enum<Iteration>(m);
  bind_enum<Reselection>(m);
  bind_enum<GrowthStop>(m);

  auto database = bind_fields<DatabaseOptions>(m, FieldClass::options);
  database.def_static("paper", &DatabaseOptions::paper,
                      "The paper's: grid, medium, rotation vectors, unweighted.");
  database.def("validate", &DatabaseOptions::validate,
               "Raises InvalidArgumentError naming the first option out of range.");

  // Immutable, so that nobody changes the copy that SolverOptions.strategy is.
  bind_fields<Lanes>(m, FieldClass::immutable)
      .def("validate", &Lanes::validate,
           "Raises InvalidArgumentError naming the first option out of range.");
  bind_fields<Paper>(m, FieldClass::immutable)
      .def("validate", &Paper::validate,
           "Raises InvalidArgumentError naming the first option that is out of range, or that is "
           "set though nothing reads it.");

  auto solver = bind_fields<SolverOptions>(m, FieldClass::options);
  solver.def_static("paper", &SolverOptions::paper,
                    "The paper's setting: medium grid, the defaults of Paper, one re-selection, "
                    "1e-4 m and 1e-3 rad.");
  solver.def("validate", &SolverOptions::validate,
             "Raises InvalidArgumentError naming the first option out of range.");
}

}  // namespace iksel::python
