// SPDX-License-Identifier: Apache-2.0
// The force of a law, sample by sample.
#include "core/elementary.h"
#include "dcnn/physics/law.h"

namespace dcnn::law {

Sample sample_of(const Motion& motion, Eigen::Index row, const Vector3d& load_S,
                 const std::vector<std::string>& signals) {
  const bool placed = motion.p_B.rows() == motion.samples();
  Sample now{motion.R_BS[static_cast<std::size_t>(row)],
             motion.euler.row(row),
             placed ? Vector3d(motion.p_B.row(row)) : Vector3d::Zero(),
             motion.v_B.row(row),
             motion.a_B.row(row),
             motion.w_S.row(row),
             motion.dw_S.row(row),
             load_S,
             motion.t(row)};
  for (std::size_t k = 0; k < signals.size(); ++k) {
    for (const LoggedSignal& logged : motion.signals) {
      if (logged.name == signals[k]) now.signals[k] = logged.values(row);
    }
  }
  return now;
}

Vector3d PreslidingRun::step(const Sample& now, double length, double h, bool first) {
  const double speed = now.v_B.norm();
  if (first) z_B_.setZero();
  if (!first && speed > 0.0) {
    z_B_ += -elementary::expm1(-speed * h / length) * (now.v_B / speed - z_B_);
  }
  return now.R_BS.transpose() * z_B_;
}

LawRun::LawRun(const Law& law) : structure_(law.structure) {
  const double* next = law.numbers.data();
  amplitude_ = *next++;
  if (*directions()[structure_.direction].unit) scale_ = *next++;
  own_ = own_vector(structure_, next);
  next += own_numbers(structure_);
  if (structure_.direction_lagged) direction_tau_ = *next++;
  if (structure_.presliding) length_ = *next++;
  if (structure_.lagged) tau_ = *next++;
  if (structure_.spread) lags_ = LagsRun(tau_, *next++);
  for (const Factor& factor : structure_.factors) {
    factors_.emplace_back(factor, next);
    next += numbers_of(factor);
  }
}

Vector3d LawRun::step(const Sample& now, double h, bool first) {
  const Vector3d n_S = direction_at(structure_.direction, now, own_);
  Vector3d direction = n_S / scale_;
  if (structure_.direction_lagged) {
    direction = direction_lag_.step(direction, direction_tau_, h, first);
  }
  if (structure_.presliding) direction = presliding_.step(now, length_, h, first);
  double strength = amplitude_;
  for (std::size_t k = 0; k < factors_.size(); ++k) {
    const std::size_t coordinate = structure_.factors[k].coordinate;
    strength *= factors_[k].step(coordinate_at(coordinate, now, n_S, own_), h, first);
  }
  if (structure_.spread) {
    strength = lags_.step(strength, h, first);
  } else if (structure_.lagged) {
    strength = lag_.step(strength, tau_, h, first);
  }
  return strength * direction;
}

}  // namespace dcnn::law
