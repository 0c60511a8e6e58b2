// SPDX-License-Identifier: BSD-3-Clause
#include "angle_warning.hpp"
#include "bindings.hpp"

namespace iksel::python {

/// Types of joints, or their names.
template <>
struct FromPython<std::vector<JointType>> {
  static std::string text() { return "collections.abc.Sequence[iksel_cpp.JointType | str]"; }
  static std::vector<JointType> convert(py::handle value, const char* name) {
    return read_sequence<JointType>(value, name, "a list of joint types");
  }
};

namespace {

using Column = std::optional<ArrayLike>;

void check_rows(std::size_t got, std::size_t rows, const char* name) {
  if (got == rows) return;
  throw InvalidArgumentError(std::string(name) + ": expected " + std::to_string(rows) +
                             " as of a, got " + std::to_string(got));
}

/// Sets a field of each row from a column of the table. Gives the numbers.
std::vector<double> set_column(const ArrayLike& value, const char* name, double DhJoint::*field,
                               std::vector<DhJoint>& rows) {
  const DoubleArray column = as_shaped(value, name, {-1}, "an (N,) array, a number for each joint");
  const std::vector<double> numbers(column.data(), column.data() + column.size());
  check_rows(numbers.size(), rows.size(), name);
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].*field = numbers[i];
  return numbers;
}

/// As set_column, of angles; of limits, only those of joints that turn.
void set_angles(const ArrayLike& value, const char* name, double DhJoint::*field,
                std::vector<DhJoint>& rows, bool is_limit) {
  std::vector<double> angles;
  const std::vector<double> numbers = set_column(value, name, field, rows);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (is_limit && rows[i].type == JointType::prismatic) continue;
    angles.push_back(numbers[i]);
  }
  const auto count = static_cast<std::ptrdiff_t>(angles.size());
  if (look_like_degrees(angles.data(), count)) warn_of_degrees(name);
}

Robot from_dh(const ArrayLike& a, const ArrayLike& alpha, const ArrayLike& d, const Column& theta,
              DhConvention convention, const std::optional<std::vector<JointType>>& types,
              const Column& lower, const Column& upper, const Column& velocity,
              const std::optional<Names>& names, const std::optional<Pose>& base,
              const std::optional<Pose>& tcp, const std::string& name) {
  DhTable table;
  const DoubleArray first = as_shaped(a, "a", {-1}, "an (N,) array, a number for each joint");
  table.joints.resize(static_cast<std::size_t>(first.size()));
  auto& rows = table.joints;
  if (types) {
    check_rows(types->size(), rows.size(), "types");
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].type = (*types)[i];
  }
  if (names) {
    check_rows(names->size(), rows.size(), "names");
    for (std::size_t i = 0; i < rows.size(); ++i) rows[i].name = (*names)[i];
  }
  set_column(a, "a", &DhJoint::a, rows);
  set_angles(alpha, "alpha", &DhJoint::alpha, rows, false);
  set_column(d, "d", &DhJoint::d, rows);
  if (theta) set_angles(*theta, "theta", &DhJoint::theta, rows, false);
  if (lower) set_angles(*lower, "lower", &DhJoint::lower, rows, true);
  if (upper) set_angles(*upper, "upper", &DhJoint::upper, rows, true);
  if (velocity) set_column(*velocity, "velocity", &DhJoint::velocity, rows);
  table.convention = convention;
  if (base) table.T_base_link0 = check_pose(*base, "base");
  table.robot_name = name;
  RobotOptions options;
  if (tcp) options.tcp = check_pose(*tcp, "tcp");
  return Robot::from_dh(table, options);
}

}  // namespace

void bind_dh(py::module_& m, py::class_<Robot>& robot) {
  bind_enums<DhConvention>(m);
  const DhTable defaults;
  const std::string convention = std::string("'") + enum_name(defaults.convention) + "'";
  def_static(
      robot, "from_dh",
      "a, alpha, d, theta=None, *, convention=" + convention +
          ", types=None, lower=None, upper=None, velocity=None, names=None, base=None, tcp=None, "
          "name='" +
          defaults.robot_name + "'",
      fn<&from_dh>,
      R"(Makes an arm of Denavit and Hartenberg's parameters, a column of the table each.

The links are `base`, in whose frame poses are, and the table's frames `link0` to `linkN`, of which
the last is the tip. Other links of the chain, locked joints and coupled limits: make another robot of
`robot.urdf` by from_urdf.

Args:
    a: lengths along x [m], (N,).
    alpha: turns about x [rad], (N,).
    d: offsets along z [m], (N,); the value of a prismatic joint is added.
    theta: turns about z [rad], (N,), to which the value of a joint that turns is added; None: 0.
    convention: "standard": Rz(theta) Tz(d) Tx(a) Rx(alpha), as of Denavit and Hartenberg,
        Siciliano, Spong; "modified": Rx(alpha) Tx(a) Rz(theta) Tz(d), as of Craig, where a and
        alpha are those of the link before.
    types: how each joint moves; None: all are revolute.
    lower: lower limits [rad or m], (N,), -inf for none; without limits, a revolute joint is
        continuous, and a prismatic one is refused.
    upper: upper limits [rad or m], (N,), inf for none.
    velocity: velocity limits [rad/s or m/s], (N,), inf for none.
    names: names of the joints; None: `joint1` to `jointN`.
    base: T_base_link0, (4, 4); None: the identity.
    tcp: T_linkN_tcp, (4, 4): the tool, whose pose is solved for; None: the identity.
    name: name of the robot.

Raises:
    InvalidArgumentError: columns that are no numbers or not as long as a, a number that is not
        finite, a name that is there twice, one limit without the other, or a prismatic joint
        without limits.
    UrdfError: limits that leave a joint no range, or a length or joint value beyond 1e8.)");
}

}  // namespace iksel::python
