// How weights begin.
#pragma once

#include <cmath>
#include <string>

#include "dcnn/core/options.h"
#include "dcnn/core/random.h"
#include "dcnn/core/tensor.h"

namespace dcnn {

/// Key `init`: "glorot" (uniform within ±sqrt(6/(fan_in + fan_out)), Glorot and Bengio 2010) or
/// "narrow" (normal, standard deviation 0.01, spec 2.4). Fans count the window.
inline Tensor initial_weight(Options& options, Shape shape, Index fan_in, Index fan_out, Rng& rng) {
  const bool glorot = options.choice("init", "glorot", {"glorot", "narrow"}) == "glorot";
  const double limit = std::sqrt(6.0 / static_cast<double>(fan_in + fan_out));
  Tensor weight(std::move(shape), true);
  for (Real& w : weight.values()) {
    w = static_cast<Real>(glorot ? rng.uniform(-limit, limit) : 0.01 * rng.normal());
  }
  return weight;
}

}  // namespace dcnn
