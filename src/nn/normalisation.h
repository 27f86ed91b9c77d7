// SPDX-License-Identifier: Apache-2.0
// Batch normalisation piece by piece, so that a convolution can do it to what is still in the
// cache.
#pragma once

#include <vector>

#include "dcnn/nn/layer.h"
#include "nn/kernels/channels.h"
#include "nn/pieces.h"

namespace dcnn {

/// y = gamma·(x - mean)/sqrt(variance + eps) + beta per channel over batch and positions (Ioffe and
/// Szegedy 2015), or the positive part of it. (N, …, C) in, the same shape out. Copies share their
/// parameters.
class Normalisation {
 public:
  using Values = std::vector<Real>;  // one per channel

  /// What a pass normalises with: (x - mean)·scale + beta, scale = gamma·inverse.
  struct Statistics {
    Values mean, inverse, scale;
    bool of_batch = false;  // they depend on x, so the gradient flows through them
  };

  explicit Normalisation(Index channels);
  Index channels() const { return gamma_.size(); }
  const Tensor& gamma() const { return gamma_; }
  const Tensor& beta() const { return beta_; }
  std::vector<NamedTensor> state() const;
  void absorb_relu() { relu_ = true; }

  /// Of the inference passes.
  Statistics stored() const;

  /// y of x, after make(first sample, number of samples) has written that piece of x.
  template <class Make>
  Tensor forward(const Tensor& x, const Pass& pass, const Make& make, Statistics& s) const {
    const Index n = x.dim(0), sample = x.size() / std::max<Index>(n, 1);
    const bool of_batch = pass.mode != Pass::Mode::kInfer;
    Tensor y = Tensor::uninitialised(x.shape());
    const auto apply = [&](Index, Index begin, Index samples) {
      this->apply(s, x.data() + begin * sample, samples * sample, y.data() + begin * sample);
    };
    if (!of_batch) s = stored();
    PieceSums moments(n, 2 * channels());
    for_each_part(n, [&](Index piece, Index begin, Index samples) {
      make(begin, samples);
      if (!of_batch) return apply(piece, begin, samples);
      measure(x.data() + begin * sample, samples * sample, moments.of(piece));
    });
    if (!of_batch) return y;
    moments.share();
    s = of_pieces(moments, n, sample, pass);
    for_each_part(n, apply);
    return y;
  }

  /// From dLoss/dy and y to the gradients of gamma and beta and, where there is memory for it, to
  /// dLoss/dx, which may take the place of x; then(piece, first sample, number of samples) once
  /// that piece of it is written.
  template <class Then>
  void backward(const Tensor& x, const Statistics& s, const Tensor& y, Tensor::GradientSlot dx,
                const Then& then) const {
    const Index n = x.dim(0), sample = x.size() / std::max<Index>(n, 1);
    const OutputGradient gradient{y.gradient_data(), relu_ ? y.data() : nullptr};
    PieceSums sums(n, 2 * channels());
    for_each_part(n, [&](Index piece, Index begin, Index samples) {
      const Index first = begin * sample;
      channel_gradient_sums(gradient.from(first), x.data() + first, s.mean.data(),
                            samples * sample / channels(), channels(), sums.of(piece));
    });
    sums.share();
    const Slopes slopes = parameter_gradients(s, sums, x.size() / channels());
    if (!dx.data) return;
    for_each_part(n, [&](Index piece, Index begin, Index samples) {
      const Index first = begin * sample;
      channel_gradient(gradient.from(first), s.scale.data(), x.data() + first, s.mean.data(),
                       slopes.slope.data(), slopes.shift.data(), samples * sample / channels(),
                       channels(), {dx.data + first, dx.add});
      then(piece, begin, samples);
    });
  }

 private:
  /// dLoss/dx = dLoss/dy·scale + (x - mean)·slope + shift.
  struct Slopes {
    Values slope, shift;
  };

  /// Mean, then sum of squared deviations of each channel of so many values.
  void measure(const Real* x, Index size, Real* moments) const;
  Statistics of_pieces(const PieceSums& moments, Index n, Index sample, const Pass& pass) const;
  void apply(const Statistics& s, const Real* x, Index size, Real* y) const;
  Slopes parameter_gradients(const Statistics& s, const PieceSums& sums, Index rows) const;
  void set_scale(Statistics& s) const;

  Tensor gamma_, beta_, mean_, variance_;
  bool relu_ = false;
};

}  // namespace dcnn
