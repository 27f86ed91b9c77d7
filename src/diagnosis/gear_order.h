// How often in a turn the dry friction of an axis varies.
#pragma once

#include <vector>

#include "diagnosis/chain.h"

namespace dcnn {

/// Members of gear_friction at the order that what is left, read along the motion, varies with
/// most.
void add_gear_frictions(const Case& study, const Signals& left, std::vector<Member>& list);

/// Bins of an axis' position over the range of its motion, as many as 80 turns need.
inline constexpr double kPositionBins = 1000.0;

/// The highest order that is looked for in bins of this width [rad or m]: of a tool's angle that of
/// the catalogue, of an axis, which may be a linear one of any pitch, what the bins tell.
double highest_order(const Case& study, const ShapeParameter& order, double width);

}  // namespace dcnn
