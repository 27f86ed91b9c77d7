// SPDX-License-Identifier: Apache-2.0
// Where a machine stands still.
#pragma once

#include <utility>
#include <vector>

#include "diagnosis/case.h"
#include "diagnosis/span.h"

namespace dcnn {

/// Stretches of at least half a second in which an axis moves by less than a hundredth of what it
/// does at its 95th percentile of speed. Friction there is any force up to that which breaks loose,
/// a constant of its own in each of them, and no law tells it. None where the axis moves for less
/// than a tenth of the time, where rows at rest count as others do (resting_search.h), or of a
/// tool.
std::vector<Span> rests(const Case& study);

/// The rows of a recording in a span: the first, and the first after the last.
std::pair<Index, Index> rows_of(const Motion& motion, const Span& span);

/// The share of the rows that are in one of the spans.
double share_within(const Case& study, const std::vector<Span>& spans);

}  // namespace dcnn
