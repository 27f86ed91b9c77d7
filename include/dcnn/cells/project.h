// SPDX-License-Identifier: Apache-2.0
// How long cells like those that have run would take elsewhere.
#pragma once

#include <cstdint>
#include <filesystem>

namespace dcnn {

struct CellProjection {
  std::int64_t measured = 0;             ///< cells whose times are known
  double mean_s = 0.0, longest_s = 0.0;  ///< of a measured cell
  double median_s = 0.0,
         late_s = 0.0;  ///< until the last worker is done; late: 95 of 100 times earlier
};

enum class CellTime { kWall, kProcessor };

/// `cells` times drawn with replacement from the measured ones, in equal shares for `workers`, as
/// shards are: 1000 draws of a fixed seed. Waiting in a queue is not in it.
CellProjection project_cells(const std::filesystem::path& folder, std::int64_t cells,
                             std::int64_t workers, CellTime time);

}  // namespace dcnn
