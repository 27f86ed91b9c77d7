// SPDX-License-Identifier: Apache-2.0
// Findings on an axis of a machine in words.
#pragma once

#include <string>

#include "dcnn/core/json.h"
#include "dcnn/data/system.h"

namespace dcnn {

/// One finding of the report, with its published parameters, in words; `strength` is the one that a
/// logged signal drives.
std::string axis_words(const Json& finding, const Axis& axis, const std::string& strength);

/// Of an axis whose reading opposes the motion, for a note.
std::string reaction_words(const Axis& axis);

}  // namespace dcnn
