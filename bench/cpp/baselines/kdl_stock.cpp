// SPDX-License-Identifier: BSD-3-Clause
// KDL's own position solvers, with random restarts and joint wrapping around them.
#include <Eigen/Core>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainiksolverpos_lma.hpp>
#include <kdl/chainiksolverpos_nr_jl.hpp>
#include <kdl/chainiksolvervel_pinv.hpp>

#include "solver.hpp"

namespace baselines {
namespace {

constexpr int kIterations = 100;

/// One of KDL's solvers, started anew until an answer lies inside the limits.
class Restarted : public Solver {
 public:
  Restarted(const Problem& problem, const Settings& settings)
      : chain_(problem.chain),
        fk_(chain_),
        tolerance_(settings.tolerance),
        problem_(problem),
        random_(problem, settings.seed),
        starts_(settings.starts),
        answer_(problem.dof()) {}

  bool solve(const KDL::Frame& target, KDL::JntArray& q, const Stop&) override {
    for (int start = 0; start < starts_; ++start) {
      if (start > 0) random_.draw(q);
      search(q, target, answer_);
      if (!answer_.data.allFinite() || !wrap_into_limits(problem_, answer_)) continue;
      KDL::Frame tip;
      fk_.JntToCart(answer_, tip);
      if (reached(KDL::diff(tip, target), tolerance_)) {
        q = answer_;
        return true;
      }
    }
    return false;
  }

 protected:
  virtual void search(const KDL::JntArray& from, const KDL::Frame& target, KDL::JntArray& q) = 0;

  KDL::Chain chain_;
  KDL::ChainFkSolverPos_recursive fk_;
  double tolerance_;

 private:
  const Problem& problem_;
  RandomStart random_;
  int starts_;
  KDL::JntArray answer_;
};

class Lma final : public Restarted {
 public:
  Lma(const Problem& problem, const Settings& settings)
      : Restarted(problem, settings),
        // A radian weighs as much as a metre: with KDL's own 0.01 the tolerance would not hold for
        // the rotation.
        solver_(chain_, Eigen::Matrix<double, 6, 1>::Ones(), tolerance_, kIterations, 1e-12) {}

 private:
  void search(const KDL::JntArray& from, const KDL::Frame& target, KDL::JntArray& q) override {
    solver_.CartToJnt(from, target, q);
  }

  KDL::ChainIkSolverPos_LMA solver_;
};

class NewtonWithLimits final : public Restarted {
 public:
  NewtonWithLimits(const Problem& problem, const Settings& settings)
      : Restarted(problem, settings),
        step_(chain_),
        solver_(chain_, problem.lower, problem.upper, fk_, step_, kIterations, tolerance_) {}

 private:
  void search(const KDL::JntArray& from, const KDL::Frame& target, KDL::JntArray& q) override {
    solver_.CartToJnt(from, target, q);
  }

  KDL::ChainIkSolverVel_pinv step_;
  KDL::ChainIkSolverPos_NR_JL solver_;
};

}  // namespace

std::unique_ptr<Solver> make_kdl_lma(const Problem& problem, const Settings& settings) {
  return std::make_unique<Lma>(problem, settings);
}

std::unique_ptr<Solver> make_kdl_nr_jl(const Problem& problem, const Settings& settings) {
  return std::make_unique<NewtonWithLimits>(problem, settings);
}

}  // namespace baselines
