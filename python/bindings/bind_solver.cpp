// SPDX-License-Identifier: BSD-3-Clause
#include "angle_warning.hpp"
#include "bindings.hpp"
#include "keywords.hpp"

namespace iksel::python {

/// What solve_batch takes besides a request.
struct BatchOptions {
  int threads = 0;
};

template <>
struct Members<BatchOptions> {
  template <class Use>
  static void visit(const Use& use) {
    use("DatabaseOptions.threads", &BatchOptions::threads);
  }
};

namespace {

Solver make_solver(const Robot& robot, const std::optional<SolverOptions>& given,
                   const std::optional<Database>& database, const std::optional<Robot>& nominal,
                   const std::optional<std::array<double, 2>>& max_deviation) {
  const SolverOptions options = given.value_or(SolverOptions());
  options.validate();
  CalibrationDeviation bound = Solver::kMaxCalibrationDeviation;
  if (max_deviation) bound = {(*max_deviation)[0], (*max_deviation)[1]};
  bound.validate();
  // Built here and not by Solver, so that Ctrl-C ends a long build.
  const GilRelease release;
  if (robot.tips() > 1) {
    if (database || nominal || max_deviation) {
      throw InvalidArgumentError(
          "database, nominal, max_calibration_deviation: they are of a robot with one tip; one "
          "with several builds a database for each of its chains");
    }
    return Solver(robot, options);
  }
  const Robot& sampled = nominal ? *nominal : robot;
  const Database seeds =
      database ? *database : Database::build(sampled, options.database, interruptible());
  return nominal ? Solver(robot, options, seeds, *nominal, bound) : Solver(robot, options, seeds);
}

/// (N, dof) values, or (dof,) for all targets, which go into the request.
std::optional<DoubleArray> as_near(py::handle value, py::ssize_t n, const Robot& robot,
                                   SolveRequest& request) {
  if (value.is_none()) return std::nullopt;
  const DoubleArray array = as_doubles(value, "near");
  if (array.ndim() == 1) {
    request.near = as_joints(array, robot.dof(), "near");
    warn_of_degrees(robot, {*request.near}, "near");
    return std::nullopt;
  }
  if (array.ndim() != 2 || array.shape(0) != n || array.shape(1) != robot.dof()) {
    const std::string d = std::to_string(robot.dof());
    throw_wrong_shape("near", "a (" + d + ",) or (" + std::to_string(n) + ", " + d + ") array",
                      array);
  }
  return array;
}

PyBatchResult solve_batch(const Solver& self, py::handle poses, const Given& given) {
  const int joints = self.robot().dof();
  SolveRequest request = read_request(self, given, /*except=*/"near");
  const DoubleArray targets = as_rows(self, poses, request);
  const int threads = given.read<BatchOptions>(joints).threads;
  const py::ssize_t n = targets.shape(0) / self.robot().tips();
  const py::ssize_t dof = joints;
  const auto nears = as_near(given["near"], n, self.robot(), request);
  PyBatchResult out{py::array_t<double>({n, dof}), py::array_t<bool>(n),
                    py::array_t<std::uint8_t>(n),  py::array_t<double>(n),
                    py::array_t<double>(n),        py::array_t<std::int32_t>(n),
                    py::array_t<std::int32_t>(n),  py::array_t<double>(n),
                    py::array_t<std::uint8_t>(n),  py::array_t<std::int32_t>(n)};
  const BatchView view{out.q.mutable_data(),
                       out.status.mutable_data(),
                       out.position_error.mutable_data(),
                       out.rotation_error.mutable_data(),
                       out.attempts.mutable_data(),
                       out.iterations.mutable_data(),
                       out.move.mutable_data(),
                       out.proof.mutable_data(),
                       out.unreachable_tip.mutable_data()};
  bool* success = out.success.mutable_data();
  const double* in = targets.data();
  {
    const GilRelease release;
    self.solve_batch(in, static_cast<std::size_t>(n), request, nears ? nears->data() : nullptr,
                     view, threads, interruptible());
    std::transform(view.status, view.status + n, success, [](std::uint8_t status) {
      return static_cast<Status>(status) == Status::solved;
    });
  }
  return out;
}

py::dict solver_state(const Solver& self) {
  const bool has_one_tip = self.robot().tips() == 1;
  const py::object none = py::none();
  return py::dict("robot"_a = self.robot(), "options"_a = self.options(),
                  "database"_a = has_one_tip ? py::cast(self.database()) : none,
                  "nominal"_a = has_one_tip ? py::cast(self.nominal()) : none);
}

Solver solver_from_state(const Robot& robot, const SolverOptions& options,
                         const std::optional<Database>& given, const std::optional<Robot>& of) {
  if (robot.tips() > 1) return Solver(robot, options);
  if (!given || !of) refuse_state("pickled Solver, database", "a Database and its Robot", "None");
  const Database& database = *given;
  const Robot& nominal = *of;
  if (nominal.chain_hash() == robot.chain_hash()) return Solver(robot, options, database);
  // It was within its bound when it was made.
  constexpr double kAny = std::numeric_limits<double>::infinity();
  return Solver(robot, options, database, nominal, CalibrationDeviation{kAny, kAny});
}

void bind_construction(py::class_<Solver>& cls) {
  def_init(cls,
           "robot, options=None, database=None, *, nominal=None, max_calibration_deviation=None",
           fn<&make_solver>,
           R"(Uses a database, or builds one by `options.database` if it is given none.

Args:
    robot: the chain to solve for.
    options: SolverOptions() if None.
    database: built for the same chain; its TCP may differ.
    nominal: for a calibrated arm, the chain that the database was built for, whose constants
        differ a little. Seeds come from it; iterations, tolerances and limits are the robot's.
    max_calibration_deviation: the largest deviation of the robot from `nominal`,
        (position [m], rotation [rad]); None: (0.05, 0.1).

Raises:
    InvalidArgumentError: an option out of range.
    DatabaseMismatchError: the database belongs to another chain, or the deviation is too
        large.)");
}

void bind_properties(py::class_<Solver>& cls) {
  add_property(cls, "nominal", &Solver::nominal);
  add_property(
      cls, "calibration_deviation",
      [](const Solver& self) {
        const CalibrationDeviation deviation = self.calibration_deviation();
        return std::make_pair(deviation.position, deviation.rotation);
      },
      "The largest difference between the robot's tip link and `nominal`'s at the same joint "
      "values over 2000 configurations: (position [m], rotation [rad]).");
  add_property(cls, "robot", &Solver::robot);
  add_property(cls, "options", [](const Solver& self) { return self.options(); });
  add_property(cls, "database", &Solver::database);
  def(cls, "chain_solver", "tip",
      [](const Solver& self, int tip) { return self.chain_solver(tip); });
  add_property(cls, "work_bound", &Solver::work_bound);
  add_property(
      cls, "task_hint",
      [](const Solver& self) {
        return self.robot().tips() == 1 ? task_hint(self.robot(), self.options().task)
                                        : std::string();
      },
      "For an arm with fewer joints than its task has axes, which hardly any target suits: tasks "
      "whose axes its joints can all move, in a sentence; else empty.");
}

void bind_batch(py::class_<Solver>& cls) {
  def_method<BatchOptions, SolveRequest>(
      cls,
      {"solve_batch",
       R"(Solves many targets with the GIL released; row i belongs to target i.

A row has the same bits whatever the number of threads and whatever else is in the batch. Its
status is that of solve(), and so are its bits, but for seeds in SIMD lanes (the default preset): there a
target has a lane to itself. Where all joints are solved in closed form, only `attempts` differs,
which counts no branches after the first that is an answer; else the answer may be another of the
target's solutions, within the same tolerances. The request holds for each target by itself.)",
       "poses",
       "T_base_tip, (N, 4, 4) [m], or others as in solve. Doubles in C order are read in place.",
       R"(Raises:
    InvalidArgumentError: wrong shape or dtype, a bad argument, or with on_invalid_pose="raise"
        a bad pose.)"},
      1,
      {"threads", "near", "weights", "norm", "seeds", "database_seeds", "scene", "exact", "filter",
       "deadline", "task", "objective", "closest", "prove", "on_invalid_pose", "tasks",
       "in_frame_of"},
      fn<&solve_batch>);
}

}  // namespace

void bind_solver(py::module_& m) {
  bind_enums<MoveNorm, SolutionOrder>(m);

  auto cls = bind_class<Solver>(m, "Solver");
  bind_construction(cls);
  bind_properties(cls);
  bind_requests(m, cls);
  bind_path(m, cls);
  bind_self_motion(m, cls);
  bind_batch(cls);
  def_repr(cls);
  def_copies(cls);
  def_pickle(cls, fn<&solver_state>, "robot, options, database, nominal", fn<&solver_from_state>);
}

}  // namespace iksel::python
