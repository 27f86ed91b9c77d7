// SPDX-License-Identifier: Apache-2.0
// The joints of a machine and a whole arm in words.
#pragma once

#include "dcnn/core/json.h"
#include "dcnn/data/system.h"

namespace dcnn {

/// [{axis, verdict, words}] from the report of each axis.
Json joints_json(const std::vector<Json>& reports, const System& system);

/// {verdict, words} of the machine: "payload of 2.6 kg, centre 4 cm off; dry and viscous friction
/// on joint1 to joint6; nothing else".
Json arm_json(const Json& report, const System& system);

}  // namespace dcnn
