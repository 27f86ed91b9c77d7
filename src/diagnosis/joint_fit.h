// SPDX-License-Identifier: Apache-2.0
// All members of a model fitted together through the exact chain.
#pragma once

#include <vector>

#include "dcnn/diagnosis/decision.h"
#include "diagnosis/columns.h"
#include "diagnosis/whitener.h"

namespace dcnn {

/// What every fit of a diagnosis shares.
struct Setting {
  const Case& study;
  Whitener whitener;
  Case coarse;               ///< the case at a stride at which searches are quick
  Whitener coarse_whitener;  ///< with the same rows
  Signals measured;
  /// Whitened columns that are always fitted beside the members: of the case's regressors, of the
  /// own offsets of recordings (flat_columns() in all), then of the errors of a known base
  /// (base_errors.h), then of other filters of the pose.
  Eigen::MatrixXd nuisance;
  Eigen::VectorXd mask;         ///< 0 for rows that an impact disturbs, else 1
  double price = kNumberPrice;  ///< of chi-square, per fitted number, that an effect must gain

  Eigen::VectorXd whitened(const Signals& signals) const;
  /// Nuisance columns of numbers that nothing is known of beforehand.
  Index flat_columns() const;
};

/// Whether the offset of this recording is fitted beside everything: of one that was zeroed; where
/// zeros differ, of each but the first, beside which stands the common offset.
bool has_own_offset(const Case& study, std::size_t log);

/// 1 in one channel of one of these recordings, for each of them: what its own offset adds.
std::vector<Signals> own_offsets(const Case& study);

struct JointFit {
  std::vector<Member> members;
  Eigen::VectorXd residual;  ///< whitened, after members and nuisance
  Eigen::MatrixXd tangent;   ///< whitened derivatives by the free parameters, then the nuisance
  Eigen::VectorXd nuisance;  ///< coefficients
  /// Coefficients of the case's regressors, in all; of a known base those of its errors, each with
  /// its deviation as a prior.
  Eigen::VectorXd base;
  double chi2 = 0.0;

  /// Free parameters before the nuisance in `tangent`.
  Index free_parameters() const { return tangent.cols() - nuisance.size(); }
};

/// Gauss-Newton over amplitudes and shapes (on their search scales) of all members that are not
/// fixed, by differences through the chain, with step halving.
JointFit joint_fit(const Setting& setting, std::vector<Member> members);

/// Whether the rest of a tool's spring is as far as it goes: no estimate, but a constant.
bool rests_at_bound(const Case& study, const Member& member);

}  // namespace dcnn
