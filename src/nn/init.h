// SPDX-License-Identifier: Apache-2.0
// How weights begin.
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "dcnn/core/options.h"
#include "dcnn/core/random.h"
#include "dcnn/core/tensor.h"

namespace dcnn {

// A configuration or a model file cannot ask for more than this: far above any network for this
// task, far below what would exhaust the memory.
inline constexpr Index kMostUnits = Index{1} << 14;    // of one layer
inline constexpr Index kMostWeights = Index{1} << 24;  // of one network

/// The number of filters or outputs under `key`.
inline Index read_units(Options& options, const std::string& key) {
  const Index units = options.get<Index>(key);
  if (units < 1 || units > kMostUnits) {
    options.reject(key, "must be between 1 and ", kMostUnits, ", not ", units);
  }
  return units;
}

/// Key `init`: "glorot" (uniform within ±sqrt(6/(fan_in + fan_out)), Glorot and Bengio 2010),
/// "narrow" (normal, standard deviation 0.01) or "zero" (the last layer of a network that
/// learns a remainder: it begins as nothing). Fans count the window.
inline Tensor initial_weight(Options& options, Shape shape, Index fan_in, Index fan_out, Rng& rng) {
  const auto init = options.choice("init", "glorot", {"glorot", "narrow", "zero"});
  require(element_count(shape) <= kMostWeights, Exit::kUsage, "a weight of shape ",
          to_string(shape), " is larger than ", kMostWeights,
          " numbers; use fewer filters or outputs");
  const double limit = std::sqrt(6.0 / static_cast<double>(fan_in + fan_out));
  Tensor weight(std::move(shape), true);
  if (init == "zero") return weight;
  for (Real& w : weight.values()) {
    w = static_cast<Real>(init == "glorot" ? rng.uniform(-limit, limit) : 0.01 * rng.normal());
  }
  return weight;
}

/// Makes the rows of a (rows, columns) matrix orthonormal, rows <= columns, by Gram and Schmidt's
/// method in double. Uniform rows leave it in a random direction each.
inline void orthonormal_rows(const Tensor& matrix) {
  const Index columns = matrix.dim(1);
  std::vector<double> rows(matrix.values().begin(), matrix.values().end());
  for (Index r = 0; r < matrix.dim(0); ++r) {
    double* row = rows.data() + r * columns;
    const auto product = [&](const double* other) {
      return std::inner_product(row, row + columns, other, 0.0);
    };
    for (Index k = 0; k < r; ++k) {
      const double* done = rows.data() + k * columns;
      const double along = product(done);
      for (Index c = 0; c < columns; ++c) row[c] -= along * done[c];
    }
    const double length = std::sqrt(product(row));
    for (Index c = 0; c < columns; ++c) row[c] /= length;
  }
  std::transform(rows.begin(), rows.end(), matrix.data(),
                 [](double value) { return static_cast<Real>(value); });
}

}  // namespace dcnn
