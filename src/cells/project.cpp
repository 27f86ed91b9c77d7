// SPDX-License-Identifier: Apache-2.0
#include "dcnn/cells/project.h"

#include <algorithm>
#include <numeric>

#include "dcnn/cells/pack.h"
#include "dcnn/core/random.h"

namespace dcnn {

CellProjection project_cells(const std::filesystem::path& folder, std::int64_t cells,
                             std::int64_t workers, CellTime time) {
  constexpr int kDraws = 1000;
  std::vector<double> times;
  const PackIndex index = read_packs(folder, [](const std::string&) { return true; });
  for (const auto& [key, packed] : index.results) {
    times.push_back(time == CellTime::kWall ? packed.result.seconds : packed.result.cpu_seconds);
  }
  require(!times.empty(), Exit::kUsage, folder.string(),
          ": no cell has run, so no time is known; run some with --limit 30");
  CellProjection projection;
  projection.measured = static_cast<std::int64_t>(times.size());
  projection.mean_s =
      std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(times.size());
  projection.longest_s = *std::max_element(times.begin(), times.end());
  std::vector<double> ends;
  for (int draw = 0; draw < kDraws; ++draw) {
    Rng rng({0x63656c6c73, static_cast<std::uint64_t>(draw)});
    std::vector<double> share(static_cast<std::size_t>(workers));
    for (std::int64_t k = 0; k < cells; ++k) {
      share[static_cast<std::size_t>(k % workers)] += times[rng.below(times.size())];
    }
    ends.push_back(*std::max_element(share.begin(), share.end()));
  }
  std::sort(ends.begin(), ends.end());
  projection.median_s = ends[kDraws / 2];
  projection.late_s = ends[kDraws * 95 / 100];
  return projection;
}

}  // namespace dcnn
