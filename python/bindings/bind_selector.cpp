// SPDX-License-Identifier: BSD-3-Clause
#include "bindings.hpp"

namespace iksel::python {

template <>
struct FromPython<std::vector<std::size_t>> {
  static std::string text() { return "collections.abc.Sequence[int]"; }
  static std::vector<std::size_t> convert(py::handle value, const char* name) {
    return read_sequence<std::size_t>(value, name, "a sequence of ints");
  }
};

namespace {

using Doubles = py::array_t<double>;
using CandidateArrays = std::tuple<py::array_t<std::int64_t>, Doubles, Doubles, Doubles>;

CandidateArrays to_arrays(const Candidates& candidates, int dof) {
  const auto n = static_cast<py::ssize_t>(candidates.indices.size());
  py::array_t<std::int64_t> indices(n);
  std::copy(candidates.indices.begin(), candidates.indices.end(), indices.mutable_data());
  return {indices, to_array(candidates.distances), to_array(candidates.adjustments),
          stack_joints(candidates.q, dof)};
}

CandidateArrays candidates(Selector& self, const Pose& T_base_tip,
                           const std::optional<std::size_t>& count,
                           const std::optional<Ranking>& ranking) {
  const Paper& scheme = self.scheme();
  const std::size_t k = count ? *count : static_cast<std::size_t>(scheme.neighbours);
  return to_arrays(self.candidates(T_base_tip, k, ranking ? *ranking : scheme.ranking),
                   self.database().dof());
}

CandidateArrays rank(Selector& self, Ranking ranking) {
  return to_arrays(self.rank(ranking), self.database().dof());
}

Selector make_selector(const Database& database, const Paper& scheme) {
  return Selector(database, scheme);
}

py::dict selector_state(const Selector& self) {
  return py::dict("database"_a = self.database(), "scheme"_a = self.scheme());
}

}  // namespace

void bind_selector(py::module_& m) {
  auto cls = bind_class<Selector>(m, "Selector");
  def_init(cls, "database, scheme=Paper()", fn<&make_selector>,
           R"(Takes a database with a full key, as DatabaseOptions.paper() describes it.

Args:
    database: where the seeds come from.
    scheme: how they are selected; what it says of the iteration is not read.

Raises:
    InvalidArgumentError: the scheme is out of range or limit-aware, or the database's key is
        reduced: of limits, and of the joints that such a key leaves out, a database alone says
        nothing.)");
  def(cls, "candidates", "pose, count=None, ranking=None", fn<&candidates>,
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
  def(cls, "rank", "ranking", fn<&rank>,
      R"(The candidates of the last pose in another order, as `candidates` gives them.

Raises:
    InvalidArgumentError: there was no pose yet.)");
  def(
      cls, "next", "failed=()",
      [](Selector& self, const std::vector<std::size_t>& failed) { return self.next(failed); },
      R"(The sample to be tried after those that failed.

Args:
    failed: indices of the samples that were tried, in that order.

Returns:
    Its index in the database: if none has failed the first in the order, else the one that the
    scheme's re-selection takes among its `candidates` best, by default the one farthest from those
    that failed. None if there is none left.

Raises:
    InvalidArgumentError: an index that is no candidate or comes twice, or there was no pose yet.)");
  add_properties(cls, "database", &Selector::database, "scheme", &Selector::scheme);
  def_repr(cls);
  def_pickle(cls, fn<&selector_state>, "database, scheme", fn<&make_selector>);
}

}  // namespace iksel::python
