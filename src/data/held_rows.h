// SPDX-License-Identifier: Apache-2.0
// Values that a slower source holds from one row of a log to the next.
#pragma once

#include <string>
#include <vector>

#include "dcnn/data/recording.h"

namespace dcnn {

/// Whether all rows, one at least, have the same value.
bool never_changes(const Eigen::VectorXd& column);

/// Rows for which the values of these columns together are held: k, where 95 % of the distances
/// from one change to the next are multiples of k; 1 where every row may bring a new one, or fewer
/// than 20 changes tell.
Index held_rows(const Recording& recording, const std::vector<std::string>& columns);

/// Leaves the rows in which the slowest source of each recording has new values, so that all
/// recordings keep one rate, and notes so: other rows repeat a reading beside a pose that has moved
/// on, or a pose beside a reading that has. A reading that is new in every row loses its spikes and
/// is low-passed first, without delay, to what the rate that is left can hold. Where a declared
/// low-pass lies above that all rows stay.
void keep_new_rows(const std::vector<Recording*>& recordings, const System& system);

}  // namespace dcnn
