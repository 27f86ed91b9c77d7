// SPDX-License-Identifier: Apache-2.0
// The residual of a fit as a problem of the discoverer.
#pragma once

#include <vector>

#include "dcnn/discovery/discover.h"
#include "diagnosis/scan.h"

namespace dcnn {

/// Whether searches for laws have computed as much as they may.
bool laws_are_spent(const Case& study);
/// Laws in what a fit leaves: looked for in block means, then fitted again at the log's rate.
std::vector<discovery::Discovered> laws_in(const Setting& setting, const JointFit& fit);
/// Laws of known form, fitted to what a fit leaves at the log's rate.
std::vector<discovery::Discovered> laws_fitted_to(const Setting& setting, const JointFit& fit,
                                                  const std::vector<discovery::Discovered>& laws);

}  // namespace dcnn
