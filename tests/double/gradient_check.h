// SPDX-License-Identifier: Apache-2.0
// Analytic gradients against central differences: the truth every layer is held to.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "dcnn/core/random.h"
#include "dcnn/core/tensor.h"

namespace dcnn {

/// Fills with values whose distance from 0 is at least 0.05 (the kink of relu is no place to
/// differentiate).
inline void fill_random(const Tensor& tensor, Rng& rng) {
  for (Real& value : tensor.values()) {
    value = static_cast<Real>((rng.uniform() < 0.5 ? -1 : 1) * rng.uniform(0.05, 1.0));
  }
}

/// A scalar from any tensor: the sum of weights·y with fixed random weights.
inline Tensor weighted_sum(const Tensor& y) {
  Rng rng(99);
  std::vector<Real> weights(static_cast<std::size_t>(y.size()));
  Tensor sum({1});
  for (Index i = 0; i < y.size(); ++i) {
    const auto k = static_cast<std::size_t>(i);
    weights[k] = static_cast<Real>(rng.uniform(-1, 1));
    sum.data()[0] += weights[k] * y.data()[i];
  }
  return record(sum, {y}, [y, weights](const Tensor& out) {
    for (Index i = 0; i < y.size(); ++i) {
      y.gradient_data()[i] += weights[static_cast<std::size_t>(i)] * out.gradient()[0];
    }
  });
}

/// The largest |analytic - numeric| / max(1, |numeric|) over all elements of `tensors`. `loss`
/// computes the scalar anew from the tensors' present values.
inline double gradient_error(const std::function<Tensor()>& loss,
                             const std::vector<Tensor>& tensors) {
  for (const Tensor& tensor : tensors) tensor.clear_gradient();
  loss().backward();
  const double h = 1e-5;
  double worst = 0;
  const NoGradient guard;
  for (const Tensor& tensor : tensors) {
    for (Index i = 0; i < tensor.size(); ++i) {
      Real& value = tensor.data()[i];
      const Real before = value;
      value = before + h;
      const double above = loss().data()[0];
      value = before - h;
      const double below = loss().data()[0];
      value = before;
      const double numeric = (above - below) / (2 * h);
      const double error = std::abs(tensor.gradient()[static_cast<std::size_t>(i)] - numeric);
      worst = std::max(worst, error / std::max(1.0, std::abs(numeric)));
    }
  }
  return worst;
}

}  // namespace dcnn
