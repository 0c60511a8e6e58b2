// SPDX-License-Identifier: BSD-3-Clause
#include "problem.hpp"

#include <cmath>
#include <fstream>
#include <stdexcept>

namespace baselines {
namespace {

constexpr double kPi = 3.14159265358979323846;

/// Numbers from a text file; operator>> of a stream does not know "inf".
class Reader {
 public:
  explicit Reader(const std::string& path) : file_(path) {
    if (!file_) throw std::runtime_error("cannot read " + path);
  }

  double number() {
    if (!(file_ >> word_)) throw std::runtime_error("the problem file ends early");
    return std::stod(word_);
  }

  KDL::Frame frame() {
    double m[12];
    for (double& value : m) value = number();
    return {KDL::Rotation(m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]),
            KDL::Vector(m[3], m[7], m[11])};
  }

 private:
  std::ifstream file_;
  std::string word_;
};

}  // namespace

Problem read_problem(const std::string& path) {
  Reader in(path);
  Problem problem;
  const auto dof = static_cast<unsigned>(in.number());
  std::vector<KDL::Frame> offsets;
  for (unsigned i = 0; i <= dof; ++i) offsets.push_back(in.frame());
  problem.lower.resize(dof);
  problem.upper.resize(dof);
  problem.chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::None), offsets[0]));
  for (unsigned i = 0; i < dof; ++i) {
    const bool prismatic = in.number() != 0;
    problem.lower(i) = in.number();
    problem.upper(i) = in.number();
    const KDL::Joint joint(prismatic ? KDL::Joint::TransZ : KDL::Joint::RotZ);
    problem.chain.addSegment(KDL::Segment(joint, offsets[i + 1]));
  }
  const auto count = static_cast<std::size_t>(in.number());
  for (std::size_t i = 0; i < count; ++i) {
    problem.targets.push_back(in.frame());
    KDL::JntArray start(dof);
    for (unsigned j = 0; j < dof; ++j) start(j) = in.number();
    problem.starts.push_back(start);
  }
  return problem;
}

void RandomStart::draw(KDL::JntArray& q) {
  for (unsigned i = 0; i < q.rows(); ++i) {
    const bool continuous = std::isinf(problem_.lower(i));
    const double low = continuous ? -kPi : problem_.lower(i);
    const double high = continuous ? kPi : problem_.upper(i);
    q(i) = std::uniform_real_distribution<double>(low, high)(engine_);
  }
}

bool wrap_into_limits(const Problem& problem, KDL::JntArray& q) {
  bool inside = true;
  unsigned i = 0;
  for (const KDL::Segment& segment : problem.chain.segments) {
    const auto type = segment.getJoint().getType();
    if (type == KDL::Joint::None) continue;
    const double low = problem.lower(i);
    const double high = problem.upper(i);
    if (type == KDL::Joint::RotZ && !std::isinf(low)) {
      if (q(i) < low) q(i) += 2 * kPi * std::ceil((low - q(i)) / (2 * kPi));
      if (q(i) > high) q(i) -= 2 * kPi * std::ceil((q(i) - high) / (2 * kPi));
    }
    inside = inside && q(i) >= low && q(i) <= high;
    ++i;
  }
  return inside;
}

bool reached(const KDL::Twist& error, double tolerance) {
  return error.vel.Norm() <= tolerance && error.rot.Norm() <= tolerance;
}

}  // namespace baselines
