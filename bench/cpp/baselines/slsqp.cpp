// SPDX-License-Identifier: BSD-3-Clause
// Sequential quadratic programming on the sum of squares of the pose error (NLopt's SLSQP), the
// second of TRAC-IK's two searches (Beeson and Ames 2015, "SQP-SS"), with random restarts.
#include <cmath>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>
#include <nlopt.hpp>

#include "solver.hpp"

namespace baselines {
namespace {

class Slsqp final : public Solver {
 public:
  Slsqp(const Problem& problem, const Settings& settings)
      : problem_(problem),
        chain_(problem.chain),
        fk_(chain_),
        jacobian_(chain_),
        random_(problem, settings.seed + 1),
        tolerance_(settings.tolerance),
        optimizer_(nlopt::LD_SLSQP, problem.dof()),
        J_(problem.dof()),
        q_(problem.dof()),
        x_(problem.dof()) {
    const auto dof = problem.dof();
    optimizer_.set_lower_bounds({problem.lower.data.data(), problem.lower.data.data() + dof});
    optimizer_.set_upper_bounds({problem.upper.data.data(), problem.upper.data.data() + dof});
    optimizer_.set_min_objective(&Slsqp::objective, this);
    // A little below what is asked for, so that both parts of the error are inside.
    optimizer_.set_stopval(tolerance_ * tolerance_);
    optimizer_.set_xtol_abs(1e-9);
    optimizer_.set_maxeval(500);
  }

  bool solve(const KDL::Frame& target, KDL::JntArray& q, const Stop& stop) override {
    target_ = target;
    stop_ = &stop;
    while (!stop.now()) {
      for (unsigned i = 0; i < q.rows(); ++i) x_[i] = q(i);
      try {
        double value = 0;
        optimizer_.optimize(x_, value);
      } catch (const nlopt::forced_stop&) {
        return false;
      } catch (const std::runtime_error&) {
        // Rounding, or a singular subproblem: what x holds is looked at all the same.
      }
      for (unsigned i = 0; i < q.rows(); ++i) q(i) = x_[i];
      KDL::Frame tip;
      fk_.JntToCart(q, tip);
      if (reached(KDL::diff(tip, target_), tolerance_)) {
        // Where a continuous joint has gone to does not matter.
        return wrap_into_limits(problem_, q);
      }
      random_.draw(q);
    }
    return false;
  }

 private:
  /// |e|^2 with e = [p_target - p; rotation vector of R_target R^T]; its gradient is -2 J^T e,
  /// exactly.
  static double objective(const std::vector<double>& x, std::vector<double>& gradient, void* self) {
    auto& s = *static_cast<Slsqp*>(self);
    if (s.stop_->now()) throw nlopt::forced_stop();
    for (unsigned i = 0; i < s.q_.rows(); ++i) s.q_(i) = x[i];
    KDL::Frame tip;
    s.fk_.JntToCart(s.q_, tip);
    const KDL::Twist error = KDL::diff(tip, s.target_);
    if (!gradient.empty()) {
      s.jacobian_.JntToJac(s.q_, s.J_);
      for (unsigned i = 0; i < s.q_.rows(); ++i) {
        const KDL::Twist column = s.J_.getColumn(i);
        gradient[i] = -2 * (KDL::dot(column.vel, error.vel) + KDL::dot(column.rot, error.rot));
      }
    }
    return KDL::dot(error.vel, error.vel) + KDL::dot(error.rot, error.rot);
  }

  const Problem& problem_;
  KDL::Chain chain_;
  KDL::ChainFkSolverPos_recursive fk_;
  KDL::ChainJntToJacSolver jacobian_;
  RandomStart random_;
  double tolerance_;
  nlopt::opt optimizer_;
  KDL::Jacobian J_;
  KDL::JntArray q_;
  std::vector<double> x_;
  KDL::Frame target_;
  const Stop* stop_ = nullptr;
};

}  // namespace

std::unique_ptr<Solver> make_slsqp(const Problem& problem, const Settings& settings) {
  return std::make_unique<Slsqp>(problem, settings);
}

}  // namespace baselines
