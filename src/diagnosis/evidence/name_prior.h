// SPDX-License-Identifier: Apache-2.0
// How likely an effect with such numbers is, before the recordings.
#pragma once

#include "diagnosis/joint_fit.h"

namespace dcnn::evidence {

/// ln of the odds that such an effect acts, before the recordings.
double log_odds_of_name(const Case& study, const EffectKind& kind);

/// ln of the prior density of the numbers of member `m` of a fit at their estimates, with the
/// probability of its name (priors.h).
double log_prior(const Setting& setting, const JointFit& fit, std::size_t m);

}  // namespace dcnn::evidence
