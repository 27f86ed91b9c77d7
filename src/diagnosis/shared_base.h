// SPDX-License-Identifier: Apache-2.0
// The rigid body of an arm, for all its joints at once.
#pragma once

#include "diagnosis/load.h"

namespace dcnn {

/// Of an arm whose simulator is given: adds to it a payload, or corrects its links, where that is
/// missing (given_arm.h), and returns the finding of the whole arm, else null.
///
/// Else gives the cases of an arm's joints one set of base parameters: least squares over all
/// joints, each weighted by what it leaves, beside dry and viscous friction of each joint (what
/// else acts is found later), shrunk as sixths of the recordings that were left out bear out. A
/// joint that a set of its own predicts so much better there that it is likelier, by the prior of a
/// name, as one that logs another unit, keeps that set. Does nothing for machines without an arm.
Json share_base(std::vector<LoadedCase>& cases);

}  // namespace dcnn
