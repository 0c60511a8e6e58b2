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

  auto solver = bind_fields<SolverOptions>(m, FieldClass::options);
  solver.def_static("paper", &SolverOptions::paper,
                    "The paper's setting: medium grid, k = 200, best 20, Eq. (5), one "
                    "re-selection, DLS, 1e-4 m and 1e-3 rad.");
  solver.def("validate", &SolverOptions::validate,
             "Raises InvalidArgumentError naming the first option out of range.");
}

}  // namespace iksel::python
