// SPDX-License-Identifier: Apache-2.0
// Rows of a file that are no samples: cut telegrams, lines of another layout.
#pragma once

#include <cstddef>
#include <vector>

namespace dcnn {

/// `rows` without those whose time is out of order, or further off than the log is long, and those
/// with a value beyond 1e12 and a million times what its column has in 99 of 100 rows: a packet
/// that was read from the wrong byte has both. All of them where more than one in a hundred would
/// go: a clock that was set anew is no broken row. `times` may be empty; `columns` are indexed by
/// row.
std::vector<std::size_t> unbroken_rows(const std::vector<std::size_t>& rows,
                                       const std::vector<double>& times,
                                       const std::vector<std::vector<double>>& columns);

}  // namespace dcnn
