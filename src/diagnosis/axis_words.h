// Findings on an axis of a machine in words.
#pragma once

#include <string>

#include "dcnn/core/json.h"
#include "dcnn/data/system.h"

namespace dcnn {

/// One finding of the report, with its published parameters, in words.
std::string axis_words(const Json& finding, const Axis& axis);

}  // namespace dcnn
