// SPDX-License-Identifier: Apache-2.0
// The noise of held-out recordings.
#include <algorithm>
#include <cmath>

#include "diagnosis/axis_case.h"
#include "diagnosis/holdout.h"

namespace dcnn {

std::vector<Floor> HoldOut::floors(const Search& search) const {
  // What a free matrix on gravity leaves of poses at rest is no noise of theirs.
  if (study_.is_static()) return search.floors();
  std::vector<Floor> floors = blocks_ ? search.floors() : own_floors(search);
  // Nor is noise more than what is left in all, where its level changes too much to be evened.
  const std::vector<double> errors = rmse(search.fit().members, search.fit().base);
  for (std::size_t j = 0; j < floors.size(); ++j) {
    const double share = std::min(1.0, errors[j] / std::max(1e-300, floors[j].deviation()));
    floors[j].amplify(share * share);
    floors[j].rounding *= share * share;
  }
  return floors;
}

/// The fitted noise, whose colour is the sensor's, as loud as the band above the motion says: what
/// a model leaves within the motion's band of recordings that decided nothing is no evidence of
/// noise.
std::vector<Floor> HoldOut::own_floors(const Search& search) const {
  const JointFit& fit = search.fit();
  Case study = study_;
  study.motion_hz = search.study().motion_hz;
  study.rounding_step = search.study().rounding_step;
  study.rounding_noise = search.study().rounding_noise;
  if (fit.base.size() > 0) set_base(study, fit.base);
  const Signals left = unfiltered_left(study, fit.members),
                fitted = unfiltered_left(search.study(), fit.members);
  // Without the ends, as the errors are.
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    study.logs[k].motion.segments = inner_segments(study, k);
  }
  const Signals levels = noise_level(study, left);
  const auto above = quiet_density(study, left, levels);
  const auto before = quiet_density(search.study(), fitted, noise_level(search.study(), fitted));
  std::vector<Floor> floors = search.floors();
  for (std::size_t j = 0; j < floors.size(); ++j) {
    if (above[j] > 0.0 && before[j] > 0.0) floors[j].amplify(above[j] / before[j]);
    floors[j].bounds.clear();
  }
  bound_by_residual(study, left, levels, floors);
  add_pose_noise(study, floors);
  add_position_noise(study, fit.members, left, floors);
  add_rounding(study, floors);
  return floors;
}

}  // namespace dcnn
