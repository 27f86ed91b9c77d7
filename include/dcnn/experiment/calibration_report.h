// SPDX-License-Identifier: Apache-2.0
// A calibration as a page: the mounting in one sentence, how well the pairs agree with it.
#pragma once

#include <string>
#include <vector>

#include "dcnn/calibration/calibration.h"

namespace dcnn {

/// The answer in one sentence: turn in degrees, accuracy, residual.
std::string headline(const Calibration& calibration);
/// `warnings`, of what the check of the recordings found likely, stand below the answer.
std::string to_html(const Calibration& calibration, const ForcePairs& pairs,
                    const std::vector<std::string>& warnings = {});

}  // namespace dcnn
