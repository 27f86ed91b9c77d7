// SPDX-License-Identifier: Apache-2.0
// Numbers of the tool in S, their intervals, and what the motion shows of them.
#pragma once

#include "dcnn/identification/identify.h"
#include "identification/physical.h"

namespace dcnn::identification {

/// Parameters of sim.json from the point estimate and its draws, in a fixed order: mass, centre of
/// mass, inertia (with torque), mounting (where estimated), offsets.
std::vector<IdentifiedNumber> tool_estimates(const WristFit& fit, const WristState& point,
                                     const Draws& draws);

/// Marks what these logs do not show, with the motion that would.
void mark_shown(const std::vector<WristLog>& logs, const WristFit& fit,
                std::vector<IdentifiedNumber>& estimates);

/// The laws beside the tool with their intervals.
std::vector<BesideTool> beside_estimates(const std::vector<WristLog>& logs, const WristFit& fit,
                                         const WristState& point, const Draws& draws);

/// The value of the estimate of this name; nothing where there is none.
const IdentifiedNumber* find_estimate(const std::vector<IdentifiedNumber>& estimates, const std::string& name);

}  // namespace dcnn::identification
