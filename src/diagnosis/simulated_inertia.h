// SPDX-License-Identifier: Apache-2.0
// What forces that somebody else simulated hold.
#pragma once

#include "diagnosis/case.h"

namespace dcnn {

/// Whether they hold the inertia of a mass: of what gravity and a constant in the sensor leave of
/// them, the acceleration explains most. False where they are zero or nothing accelerates.
bool simulates_inertia(const std::vector<Log>& logs);

}  // namespace dcnn
