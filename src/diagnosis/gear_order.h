// How often in a turn the dry friction of an axis varies.
#pragma once

#include <vector>

#include "diagnosis/chain.h"

namespace dcnn {

/// Members of gear_friction at the order that what is left, read along the motion, varies with
/// most.
void add_gear_frictions(const Case& study, const Signals& left, std::vector<Member>& list);

}  // namespace dcnn
