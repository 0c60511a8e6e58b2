// SPDX-License-Identifier: BSD-3-Clause
#include "refine/self_motion.hpp"

#include "refine/descent.hpp"

namespace iksel {

template bool converge(const Goal&, int, double, bool, JointVector&, int&);
template int descend_self_motion(const Goal&, const JointCost&, int, JointVector&);
template int descend_to_near(const Goal&, const JointMove&, const JointVector&, JointVector&);

}  // namespace iksel
