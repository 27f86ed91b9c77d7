// SPDX-License-Identifier: Apache-2.0
// The parts of sim.json that parse_tool_model and parse_simulator share.
#pragma once

#include "dcnn/core/options.h"
#include "dcnn/physics/tool_model.h"

namespace dcnn {

/// Reads the keys of a ToolModel and leaves the others (and finish()) to the caller.
ToolModel read_tool_model(Options& options);

}  // namespace dcnn
