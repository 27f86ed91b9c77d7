// SPDX-License-Identifier: Apache-2.0
#include "check/kind.h"

namespace dcnn::check {

/// Found with the other readings of a wrist's torque; see torque_axes.cpp.
const FaultKind torque_sign_fault{
    "torque_sign", true, "turn the sign of these columns", "", nullptr, nullptr, true};

}  // namespace dcnn::check
