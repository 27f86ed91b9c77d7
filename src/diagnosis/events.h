// SPDX-License-Identifier: Apache-2.0
// What happens at a time: a contact, a step of the offset.
#pragma once

#include "diagnosis/scan.h"

namespace dcnn {

/// The best interval for a force that is constant in base axes, its ends refined; no gain where
/// another interval apart from it would gain half as much, since one event is to be named and not
/// the waves of something else. Only one recording is touched.
Trial find_contact(const Scan& scan);

/// The best instant for an offset that jumps and stays. Within 2.5 s of either end of the clock it
/// is a bias, not a step.
Trial find_step(const Scan& scan);

}  // namespace dcnn
