// SPDX-License-Identifier: Apache-2.0
// How often in a turn the dry friction of an axis varies.
#pragma once

#include <vector>

#include "diagnosis/chain.h"

namespace dcnn {

/// Members of gear_friction at the order that what is left, read along the motion, varies with
/// most.
void add_gear_frictions(const Case& study, const Signals& left, std::vector<Member>& list);

/// The members, of which that of gear_friction gives way to the dry friction that it has at any
/// position, where no other makes it.
std::vector<Member> with_even_gears(const Case& study, std::vector<Member> members,
                                    std::size_t gear);

}  // namespace dcnn
