// SPDX-License-Identifier: BSD-3-Clause
#include "iksel/selector.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "array_checks.hpp"
#include "bindings.hpp"
#include "option_fields.hpp"
#include "pickle.hpp"
#include "pose_arguments.hpp"
#include "property.hpp"
#include "sequence_of.hpp"

namespace iksel::python {

/// A sequence of sample numbers.
class SamplesLike : public py::object {
  PYBIND11_OBJECT_DEFAULT(SamplesLike, object, is_any_object)
};

namespace {

using Doubles = py::array_t<double>;
using CandidateArrays = py::typing::Tuple<py::array_t<std::int64_t>, Doubles, Doubles, Doubles>;

CandidateArrays to_arrays(const Candidates& candidates, int dof) {
  const auto n = static_cast<py::ssize_t>(candidates.indices.size());
  py::array_t<std::int64_t> indices(n);
  std::copy(candidates.indices.begin(), candidates.indices.end(), indices.mutable_data());
  Doubles q({n, static_cast<py::ssize_t>(dof)});
  double* out = q.mutable_data();
  for (const JointVector& each : candidates.q) out = std::copy_n(each.data(), dof, out);
  return py::reinterpret_steal<CandidateArrays>(
      py::make_tuple(indices, Doubles(n, candidates.distances.data()),
                     Doubles(n, candidates.adjustments.data()), q)
          .release());
}

CandidateArrays candidates(Selector& self, const PoseLike& pose,
                           const std::optional<Loose<std::size_t>>& count,
                           const std::optional<Loose<Ranking>>& ranking) {
  const Pose T_base_tip = as_pose(pose, "pose");
  const Paper& scheme = self.scheme();
  const auto k = count ? from_python<std::size_t>(*count, "count")
                       : static_cast<std::size_t>(scheme.neighbours);
  const Ranking order = ranking ? from_python<Ranking>(*ranking, "ranking") : scheme.ranking;
  return to_arrays(self.candidates(T_base_tip, k, order), self.database().dof());
}

std::optional<std::size_t> next(Selector& self, const SamplesLike& failed) {
  return self.next(read_sequence(
      failed, "failed", "a sequence of ints",
      [](const py::object& item, const char* at) { return from_python<std::size_t>(item, at); }));
}

}  // namespace

void bind_selector(py::module_& m) {
  py::class_<Selector> cls(
      m, "Selector",
      "Selects seeds of a database for one target after the other, as the paper does and a Solver "
      "with the strategy Paper: query, rank, re-select. Not to be used from two threads at once.");
  cls.def(py::init([](const Loose<Database>& given, const Loose<Paper>& scheme) {
            const auto database = from_python<Database>(given, "database");
            return Selector(database, from_python<Paper>(scheme, "scheme"));
          }),
          py::arg("database"), py::arg_v("scheme", Paper{}, "Paper()"),
          R"(Takes a database with a full key, as DatabaseOptions.paper() describes it.

Args:
    database: where the seeds come from.
    scheme: how they are selected; what it says of the iteration is not read.

Raises:
    InvalidArgumentError: the scheme is out of range or limit-aware, or the database's key is
        reduced: of limits, and of the joints that such a key leaves out, a database alone says
        nothing.)");
  cls.def("candidates", &candidates, py::arg("pose"), py::arg("count") = py::none(),
          py::arg("ranking") = py::none(),
          R"(The samples nearest to a pose, the best first.

Args:
    pose: T_base_tip [m] of the tip link, without the TCP; as in Solver.solve.
    count: how many are asked from the KD-tree; None: as many as the scheme says.
    ranking: how they are put in order; None: as the scheme says.

Returns:
    (indices, distances, adjustments, q): the samples' indices in the database (k,); the distances
    of their keys from the pose's, Eq. (2) of the paper (k,); the norms of the joint adjustments
    J^+ (x_target - x_i), Eq. (5) (k,) [rad or m]; and their joint values (k, dof) [rad or m].

Raises:
    InvalidArgumentError: a pose that is not rigid, a count of 0.)");
  cls.def(
      "rank",
      [](Selector& self, const Loose<Ranking>& ranking) {
        return to_arrays(self.rank(from_python<Ranking>(ranking, "ranking")),
                         self.database().dof());
      },
      py::arg("ranking"),
      R"(The candidates of the last pose in another order, as `candidates` gives them.

Raises:
    InvalidArgumentError: there was no pose yet.)");
  cls.def("next", &next, py::arg("failed") = py::tuple(),
          R"(The sample to be tried after those that failed.

Args:
    failed: indices of the samples that were tried, in that order.

Returns:
    Its index in the database: if none has failed the first in the order, else the one that the
    scheme's re-selection takes among its `candidates` best, by default the one farthest from those
    that failed. None if there is none left.

Raises:
    InvalidArgumentError: an index that is no candidate or comes twice, or there was no pose yet.)");
  add_property(cls, "database", &Selector::database, "Where the seeds come from.");
  add_property(cls, "scheme", &Selector::scheme, "How they are selected.");
  cls.def("__repr__", [](const Selector& self) {
    return "Selector(" + py::cast<std::string>(py::repr(py::cast(self.database()))) + ")";
  });
  cls.def(py::pickle(
      [](const Selector& self) -> py::object {
        return py::make_tuple(self.database(), py::cast(self.scheme()));
      },
      [](const py::object& state) {
        PickleState in(state, "Selector", 2);
        const auto database = in.value<Database>("database");
        return Selector(database, in.value<Paper>("scheme"));
      }));
}

}  // namespace iksel::python

// NOLINTBEGIN(readability-identifier-naming): pybind11 looks for `name`.
namespace pybind11::detail {
template <>
struct handle_type_name<iksel::python::SamplesLike> {
  static constexpr auto name = const_name("collections.abc.Sequence[int]");
};
}  // namespace pybind11::detail
// NOLINTEND(readability-identifier-naming)
