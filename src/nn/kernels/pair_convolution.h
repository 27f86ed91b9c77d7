// SPDX-License-Identifier: Apache-2.0
// Convolutions in 16-bit integers: the products of two channels in one instruction.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "nn/kernels/fixed_convolution.h"

namespace dcnn {

/// A convolution of fixed_convolution.h, behind a ReLU, in integers. Each image is scaled by its
/// own largest value to whole numbers up to `most`, each filter to whole numbers whose magnitudes
/// sum up to at most 2^31/most: no sum of products overflows, whatever the image, and integers add
/// to the same sum in every order. Rounding changes an output y by at most
///   largest·(S/(2·most) + K·u/2) + K·u·largest/(4·most),
/// S the sum of the filter's magnitudes, K the number of its weights, u = units[filter] the value
/// of its last bit, besides single precision.
class PairConvolution {
 public:
  /// Null where no kernel has this shape.
  static std::unique_ptr<PairConvolution> make(const ConvShape& shape, const Tensor& weights);

  /// As fixed_convolution(): y or the outputs of `linear`. False, and nothing done, where x is not
  /// finite.
  bool run(const Real* x, const Real* bias, const FixedLinear& linear, Real* y) noexcept;

  /// The most that rounding of weights and image can change output `filter` by, for an image up to
  /// `largest`.
  double bound(Index filter, double largest) const;

 private:
  PairConvolution(int kind, const ConvShape& shape, const Tensor& weights);

  [[maybe_unused]] int kind_;
  [[maybe_unused]] Index in_h_, cells_, products_;  // of an image; of an output
  Real most_;
  std::vector<std::int32_t> weights_;  // (2, 2, channels/2, filters) pairs
  std::vector<Real> units_;
  std::vector<double> magnitudes_;  // S
  std::vector<std::int32_t> x_;  // the image, (h, w, channels/2) pairs
};

}  // namespace dcnn
