// SPDX-License-Identifier: Apache-2.0
// The terms in which the closed-form identifiers are linear: force = weights^T · terms.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "dcnn/data/features.h"

namespace dcnn {

/// What a closed-form identifier is linear in. On a wrist u = R_BS^T·e_z is the direction of the
/// vertical, everything else is in the frame of u:
///   gravity  u, 1                                                        (cf)
///   fourier  the 27 products of {1, sin, cos} of the three angles; where only u is there (feature
///            set body), those of {1, u_i, u_i^2}                         (cf)
///   rigid    u, acceleration of the origin, angular acceleration, the 6 products w_i·w_j
///            (xx, yy, zz, xy, xz, yz), 1                                 (rigid)
/// and with a system of axes, where every target sees every axis:
///   gravity  q, sin q, cos q of each axis, 1
///   fourier  the same with sin 2q, cos 2q
///   rigid    q, sin q, cos q, velocity, acceleration of each axis, every signal, 1
/// A block that is not among the features is left out.
enum class Terms { kGravity, kFourier, kRigid };

class Regressors {
 public:
  virtual ~Regressors() = default;
  Index count() const { return static_cast<Index>(groups_.size()); }
  /// (count) terms of one kind have the same number.
  const std::vector<Index>& groups() const { return groups_; }
  /// Terms of rows of features: (n, F) to (n, count).
  Eigen::MatrixXd of(const Eigen::MatrixXd& x) const;
  /// Of one row (F) to (count); allocates nothing.
  virtual void write(const Eigen::RowVectorXd& x, Eigen::RowVectorXd& terms) const = 0;

 protected:
  /// Enrols `terms` more terms of one new kind.
  void add_group(Index terms);

 private:
  std::vector<Index> groups_;
};

/// Shared: a predictor keeps the terms of its model.
std::shared_ptr<const Regressors> make_regressors(const FeatureLayout& layout, Terms terms);

/// Where the blocks of three begin among the features of a wrist; -1 where one is left out.
struct WristColumns {
  Index orientation = -1, angular_velocity = -1, acceleration = -1, angular_acceleration = -1;
};
WristColumns wrist_columns(const FeatureLayout& layout);

/// The parts of make_regressors().
std::shared_ptr<const Regressors> wrist_regressors(const FeatureLayout& layout, Terms terms);
std::shared_ptr<const Regressors> axis_regressors(const FeatureLayout& layout, Terms terms);

}  // namespace dcnn
