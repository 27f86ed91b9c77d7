// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "dcnn/core/random.h"
#include "models/noisy_blocks.h"

namespace dcnn {

std::vector<Index> Stream::segment_begins() const {
  std::vector<Index> begins(static_cast<std::size_t>(rows()), 0);
  for (const Segment& segment : segments) {
    std::fill(begins.begin() + segment.begin, begins.begin() + segment.end, segment.begin);
  }
  return begins;
}

Stream noisy(const Samples& samples, const NoiseSpec& spec, const InputMap& map, SnrLevel snr,
             std::uint64_t key) {
  Stream stream = samples;
  if (!snr) return stream;
  const bool on_features = spec.on == NoiseSpec::Signal::kFeatures ||
                           (spec.on == NoiseSpec::Signal::kBoth && Rng({key, 1}).below(2) == 0);
  if (on_features) {
    stream.x = with_noise(std::move(stream.x), noise_deviation(spec, map, samples.x, snr), key);
    return stream;
  }
  require(!samples.pose_noise.empty(), Exit::kUsage,
          "noise.on 'pose' needs features derived from a pose; use the feature set 'pose'");
  const auto draw = Rng(key).below(samples.pose_noise.size());
  stream.x += std::pow(10.0, -*snr / 20.0) * samples.pose_noise[draw];
  return stream;
}

std::vector<std::size_t> block_levels(const Samples& samples, const NoiseSpec& spec,
                                      std::uint64_t key) {
  std::vector<std::size_t> level_of(static_cast<std::size_t>(samples.rows()));
  const auto begins = samples.segment_begins();
  Rng draw({key, 1});
  for (std::size_t row = 0; row < level_of.size(); ++row) {
    const auto place = static_cast<Index>(row) - begins[row];
    level_of[row] =
        place % spec.block_rows == 0 ? draw.below(spec.levels.size()) : level_of[row - 1];
  }
  return level_of;
}

Stream noisy_blocks(const Samples& samples, const NoiseSpec& spec, const InputMap& map,
                    std::uint64_t key) {
  const auto level_of = block_levels(samples, spec, key);
  Stream stream = samples;
  for (std::size_t level = 0; level < spec.levels.size(); ++level) {
    if (!spec.levels[level]) continue;
    const Eigen::MatrixXd x = noisy(samples, spec, map, spec.levels[level], key).x;
    for (std::size_t row = 0; row < level_of.size(); ++row) {
      const auto i = static_cast<Index>(row);
      if (level_of[row] == level) stream.x.row(i) = x.row(i);
    }
  }
  return stream;
}

}  // namespace dcnn
