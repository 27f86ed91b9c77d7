// SPDX-License-Identifier: Apache-2.0
// Findings in the coordinates in which their laws are curves.
#pragma once

#include "dcnn/diagnosis/diagnose.h"
#include "diagnosis/search.h"

namespace dcnn {

/// Force against velocity for friction, against the angle for springs and cogging, against time for
/// drifts, steps, contacts and offsets, each coordinate of a law without a name, on the axis where
/// the finding is strongest: what is left without it, and the law. None for effects that have no
/// such picture.
std::vector<Portrait> portraits(const Search& search);

}  // namespace dcnn
