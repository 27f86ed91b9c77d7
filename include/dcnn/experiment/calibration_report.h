// A calibration as a page: the mounting in one sentence, how well the pairs agree with it.
#pragma once

#include <string>

#include "dcnn/calibration/calibration.h"

namespace dcnn {

/// The answer in one sentence: turn in degrees, accuracy, residual.
std::string headline(const Calibration& calibration);
std::string to_html(const Calibration& calibration, const ForcePairs& pairs);

}  // namespace dcnn
