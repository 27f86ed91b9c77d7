#include <cmath>

#include "dcnn/core/random.h"
#include "dcnn/models/model.h"

namespace dcnn {

Stream noisy(const Samples& samples, const NoiseSpec& spec, const InputMap& map, SnrLevel snr,
             std::uint64_t key) {
  Stream stream = samples;
  if (!snr) return stream;
  if (spec.on == NoiseSpec::Signal::kFeatures) {
    stream.x = with_noise(std::move(stream.x), noise_deviation(spec, map, samples.x, snr), key);
    return stream;
  }
  require(!samples.pose_noise.empty(), Exit::kUsage,
          "noise.on 'pose' needs features derived from a pose; use the feature set 'pose'");
  const auto draw = Rng(key).below(samples.pose_noise.size());
  stream.x += std::pow(10.0, -*snr / 20.0) * samples.pose_noise[draw];
  return stream;
}

}  // namespace dcnn
