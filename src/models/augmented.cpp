// SPDX-License-Identifier: Apache-2.0
#include "models/augmented.h"

#include "dcnn/core/random.h"
#include "models/random_streams.h"

namespace dcnn {
namespace {

// Streams of random numbers that one seed feeds.
/// Number of the level of each row.
std::vector<std::size_t> levels_of_rows(Index rows, std::size_t levels, std::uint64_t seed) {
  std::vector<std::size_t> result;
  result.reserve(static_cast<std::size_t>(rows) + levels);
  for (std::uint64_t block = 0; static_cast<Index>(result.size()) < rows; ++block) {
    Rng rng({seed, kLevelOrder, block});
    for (const std::int64_t level : permutation(static_cast<std::int64_t>(levels), rng)) {
      result.push_back(static_cast<std::size_t>(level));
    }
  }
  return result;
}

}  // namespace

Samples augmented(const Samples& samples, const NoiseSpec& spec, const InputMap& map,
                  std::uint64_t seed) {
  Samples result;
  result.x = samples.x;
  result.y = samples.y;
  result.segments = samples.segments;
  const auto level_of = levels_of_rows(samples.rows(), spec.levels.size(), seed);
  for (std::size_t level = 0; level < spec.levels.size(); ++level) {
    if (!spec.levels[level]) continue;
    const Eigen::MatrixXd x =
        noisy(samples, spec, map, spec.levels[level], Rng({seed, kLevelNoise, level}).bits()).x;
    for (Index row = 0; row < samples.rows(); ++row) {
      if (level_of[static_cast<std::size_t>(row)] == level) result.x.row(row) = x.row(row);
    }
  }
  return result;
}

}  // namespace dcnn
