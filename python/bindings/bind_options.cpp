// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"
#include "option_fields.hpp"

namespace iksel::python {

namespace {

template <class Options>
void def_validate(py::class_<Options>& cls) {
  def(cls, "validate", "", fn<&Options::validate>,
      "Raises InvalidArgumentError naming the first option out of range.");
}

}  // namespace

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

  auto database = bind_keyword_class<DatabaseOptions>(m, /*writable=*/true);
  def_static(database, "paper", "year=2025", fn<&DatabaseOptions::paper>,
             "The paper's: grid, medium, rotation vectors, unweighted. Of 2026: 2,048 samples by "
             "kmeans. Raises InvalidArgumentError on another year.");
  def_validate(database);

  // Immutable, so that nobody changes the copy that SolverOptions.strategy is.
  auto lanes = bind_keyword_class<Lanes>(m, /*writable=*/false);
  def_validate(lanes);
  auto paper = bind_keyword_class<Paper>(m, /*writable=*/false);
  def(paper, "validate", "", fn<&Paper::validate>,
      "Raises InvalidArgumentError naming the first option that is out of range, or that is set "
      "though nothing reads it.");

  auto solver = bind_keyword_class<SolverOptions>(m, /*writable=*/true);
  def_static(solver, "paper", "year=2025", fn<&SolverOptions::paper>,
             "The paper's setting: medium grid, the defaults of Paper, one re-selection, 1e-4 m "
             "and 1e-3 rad. Of 2026: its authors' newer one, as their repository "
             "wanweiwei07/one runs it at commit 96c863f1. Raises InvalidArgumentError on another "
             "year.");
  def_validate(solver);
}

}  // namespace iksel::python
