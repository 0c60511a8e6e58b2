// SPDX-License-Identifier: BSD-3-Clause
#include "structure/coupled_form.hpp"

#include <algorithm>

#include "base/constants.hpp"

namespace iksel {

static_assert(lanes::kMostCoupled == kMaxCoupledLimits);

std::shared_ptr<const lanes::CoupledForm> make_coupled_form(const ChainModel& model,
                                                            const ClosedFormChain& chain) {
  const JointSpace& joints = model.joints;
  if (joints.coupled.empty()) return nullptr;
  auto made = std::make_shared<lanes::CoupledForm>();
  lanes::CoupledForm& form = *made;
  for (const CoupledRow& row : joints.coupled) {
    form.lower[form.rows] = row.lower / row.size;
    form.upper[form.rows] = row.upper / row.size;
    ++form.rows;
  }
  form.images = static_cast<int>(joints.coupled_images.size());
  for (int i = 0; i < 7; ++i) {
    const int j = i < 6 ? chain.joints[i] : chain.held;
    if (i == 6 && !chain.form.is_held) continue;
    if (j >= model.dof) continue;
    for (int r = 0; r < form.rows; ++r) {
      const CoupledRow& row = joints.coupled[static_cast<std::size_t>(r)];
      form.coefficient[r][i] = row.c[j] / row.size;
    }
    if (i == 6) form.held_offset = model.kernel.joints[static_cast<std::size_t>(j)].offset;
    if (!joints.has_coupled_images(j)) continue;
    form.joint[form.turning++] = i;
    form.middle[i] = 0.5 * (joints.lower[j] + joints.upper[j]);
    form.reach[i] = 0.5 * (joints.upper[j] - joints.lower[j]);
    for (int image = 0; image < form.images; ++image) {
      form.turned[image][i] = kTwoPi * joints.coupled_images[static_cast<std::size_t>(image)][j];
    }
  }
  return made;
}

bool suits_coupled_limits(const ChainModel& model, const ClosedFormChain& chain) {
  const auto& rows = model.joints.coupled;
  return std::none_of(rows.begin(), rows.end(), [&](const CoupledRow& row) {
    for (int j = 0; j < model.dof; ++j) {
      if (row.c[j] != 0 && chain.turns_freely(j)) return true;
    }
    return false;
  });
}

}  // namespace iksel
