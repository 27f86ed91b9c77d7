// SPDX-License-Identifier: Apache-2.0
// How a base simulator that is known may be off.
#pragma once

#include "diagnosis/case.h"

namespace dcnn {

constexpr double kErrorRidge = 1e-9;  ///< of a column's information, in solving for such errors

/// What errors of a known base make of the reading, a standard deviation each, low-passed as the
/// case is; none where the base is fitted or nobody knows its errors.
std::vector<Signals> base_errors(const Case& study);

/// Sizes of a known base's errors, the columns of the nuisance from `first` on, in deviations:
/// (N'N + d P)^-1 N'y, P = 1 for them and 0 for others. d is the variance in which the rows say
/// something of them, that with which sixths of the rows that were left out are predicted best:
/// errors of laws that are not known yet are none of the base.
Eigen::VectorXd likeliest_errors(const Eigen::MatrixXd& nuisance, Index first, Index count,
                                 const Eigen::VectorXd& left);

}  // namespace dcnn
