// SPDX-License-Identifier: BSD-3-Clause
// Arms whose constants differ a little from those that a database was built with.
#include <algorithm>

#include "base/message_text.hpp"
#include "iksel/error.hpp"
#include "iksel/pose.hpp"
#include "solver/solver_impl.hpp"

namespace iksel {

CalibrationDeviation measure_calibration_deviation(const Robot& robot, const Robot& nominal,
                                                   std::size_t samples) {
  if (robot.dof() != nominal.dof()) {
    throw InvalidArgumentError("nominal: robot '" + nominal.name() + "' has " +
                               std::to_string(nominal.dof()) + " joints, '" + robot.name() + "' " +
                               std::to_string(robot.dof()));
  }
  const Robot a = robot.with_tcp(Pose::Identity());
  const Robot b = nominal.with_tcp(Pose::Identity());
  CalibrationDeviation deviation;
  const Matrix q = nominal.random_configurations(samples, 0);
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const JointVector joints = q.row(i);
    const Eigen::Matrix<double, 6, 1> e = pose_error(a.fk(joints), b.fk(joints));
    deviation.position = std::max(deviation.position, e.head<3>().norm());
    deviation.rotation = std::max(deviation.rotation, e.tail<3>().norm());
  }
  return deviation;
}

void CalibrationDeviation::validate() const {
  for (const double part : {position, rotation}) {
    // Written so that NaN fails.
    if (part >= 0) continue;
    throw InvalidArgumentError("option max_calibration_deviation: " + number_text(part) +
                               " is not in 0 .. inf");
  }
}

Solver::Solver(const Robot& robot, const SolverOptions& options, const Database& database,
               const Robot& nominal, const CalibrationDeviation& bound) {
  options.validate();
  bound.validate();
  if (robot.dof() != nominal.dof()) {
    throw DatabaseMismatchError("robot '" + robot.name() + "' has " + std::to_string(robot.dof()) +
                                " joints, its nominal chain " + std::to_string(nominal.dof()));
  }
  const CalibrationDeviation deviation = measure_calibration_deviation(robot, nominal);
  // Written so that a robot's NaN is beyond.
  if (!(deviation.position <= bound.position && deviation.rotation <= bound.rotation)) {
    MessageStream text;
    text << "robot '" << robot.name() << "' deviates by " << deviation.position << " m and "
         << deviation.rotation << " rad from the chain of the database, more than "
         << bound.position << " m or " << bound.rotation << " rad: build a database for it";
    throw DatabaseMismatchError(text.str());
  }
  const auto impl = std::make_shared<Impl>(robot, options, database, nominal);
  impl->deviation = deviation;
  impl_ = impl;
}

const Robot& Solver::nominal() const { return impl_->nominal; }
CalibrationDeviation Solver::calibration_deviation() const { return impl_->deviation; }

}  // namespace iksel
