// SPDX-License-Identifier: BSD-3-Clause
// Newton's method on KDL's pseudo-inverse with random restarts: the first of the two searches that
// P. Beeson and B. Ames, "TRAC-IK: An open-source library for improved solving of generic inverse
// kinematics", Humanoids 2015, run beside each other. Written from the paper's description.
#include <algorithm>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>

#include "solver.hpp"

namespace baselines {
namespace {

/// A step that moves no joint by more than this, after the limits, is a local minimum [rad or m].
constexpr double kStuck = 1e-6;

class Newton final : public Solver {
 public:
  Newton(const Problem& problem, const Settings& settings)
      : problem_(problem),
        chain_(problem.chain),
        fk_(chain_),
        step_(chain_),
        random_(problem, settings.seed),
        tolerance_(settings.tolerance),
        dq_(problem.dof()),
        next_(problem.dof()) {}

  bool solve(const KDL::Frame& target, KDL::JntArray& q, const Stop& stop) override {
    while (!stop.now()) {
      KDL::Frame tip;
      fk_.JntToCart(q, tip);
      const KDL::Twist error = KDL::diff(tip, target);
      if (reached(error, tolerance_)) return true;
      step_.CartToJnt(q, error, dq_);
      KDL::Add(q, dq_, next_);
      clamp(next_);
      const double moved = (next_.data - q.data).cwiseAbs().maxCoeff();
      // Written so that a step of NaN counts as stuck.
      if (moved > kStuck) {
        q = next_;
      } else {
        random_.draw(q);
      }
    }
    return false;
  }

 private:
  void clamp(KDL::JntArray& q) const {
    if (wrap_into_limits(problem_, q)) return;
    for (unsigned i = 0; i < q.rows(); ++i) {
      q(i) = std::min(std::max(q(i), problem_.lower(i)), problem_.upper(i));
    }
  }

  const Problem& problem_;
  KDL::Chain chain_;
  KDL::ChainFkSolverPos_recursive fk_;
  KDL::ChainIkSolverVel_pinv step_;
  RandomStart random_;
  double tolerance_;
  KDL::JntArray dq_, next_;
};

}  // namespace

std::unique_ptr<Solver> make_newton(const Problem& problem, const Settings& settings) {
  return std::make_unique<Newton>(problem, settings);
}

}  // namespace baselines
