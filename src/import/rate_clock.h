// SPDX-License-Identifier: Apache-2.0
// What rates in a log say of the clock of its rows.
#pragma once

#include <optional>

#include "dcnn/import/log.h"

namespace dcnn {

/// s per unit of `clock` (per row where it is empty), by which the stream's angles and positions
/// change as its rates of them say: sum(dx sign(v))/sum(|v| dclock) of each pair of columns. The
/// median of the pairs that move; nothing where there is none, and where they disagree.
std::optional<double> seconds_by_rates(const LogStream& stream, const std::vector<double>& clock);

}  // namespace dcnn
