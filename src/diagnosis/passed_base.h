// SPDX-License-Identifier: Apache-2.0
// What delays and low-passes make of a machine's linear base simulator.
#pragma once

#include "diagnosis/joint_fit.h"

namespace dcnn {

/// Whether a member delays or low-passes all that the reading shows. Of effects with a strength, as
/// creep, the base follows the strength alone, step by step (Search::settle).
bool passes_base(const Member& member);

/// Derivatives of the whitened prediction by the coefficients of the base's columns: each as these
/// members pass it, (rows, regressors of a recording).
Eigen::MatrixXd passed_base(const Setting& setting, const std::vector<Member>& members);

/// Chi-square that a lag or delay leaves beside the chain's members, the base refitted as it passes
/// it: where the lag is long the base that was fitted without it is another one, which no lag
/// improves. The base's columns of `tangent`, the fit's, begin at `first_of_base`.
double left_beside_base(const Setting& setting, const Chain& chain, Eigen::MatrixXd tangent,
                        Index first_of_base, const Member& lag);

}  // namespace dcnn
