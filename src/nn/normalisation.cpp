// SPDX-License-Identifier: Apache-2.0
#include "nn/normalisation.h"

#include <cmath>

#include "nn/batch_norm.h"

namespace dcnn {
namespace {

constexpr double kMomentum = 0.1;

/// Mean and sum of squared deviations, pooled over pieces of possibly different size.
struct Moments {
  std::vector<double> mean, deviations;
  double count = 0;
  explicit Moments(Index channels)
      : mean(static_cast<std::size_t>(channels)), deviations(mean.size()) {}

  /// Chan, Golub and LeVeque 1979, eq. 2.1: no cancellation however large the mean.
  void merge(const Real* part, Index part_count) {  // part: means, then deviations
    const double n = static_cast<double>(part_count), total = count + n;
    for (std::size_t c = 0; c < mean.size(); ++c) {
      const double shift = static_cast<double>(part[c]) - mean[c];
      mean[c] += shift * n / total;
      deviations[c] +=
          static_cast<double>(part[mean.size() + c]) + shift * shift * count * n / total;
    }
    count = total;
  }
};

/// Running statistics: an exponential average, of the unbiased variance as in PyTorch.
void follow(const Moments& moments, const Tensor& running_mean, const Tensor& running_variance) {
  for (std::size_t c = 0; c < moments.mean.size(); ++c) {
    const double variance = moments.deviations[c] / std::max(moments.count - 1, 1.0);
    Real &mean = running_mean.data()[c], &running = running_variance.data()[c];
    mean = static_cast<Real>((1 - kMomentum) * static_cast<double>(mean) +
                             kMomentum * moments.mean[c]);
    running =
        static_cast<Real>((1 - kMomentum) * static_cast<double>(running) + kMomentum * variance);
  }
}

/// Exact statistics of everything seen since batch 0, for batches of equal size.
void pool(const Moments& moments, double weight, const Tensor& pooled_mean,
          const Tensor& pooled_variance) {
  for (std::size_t c = 0; c < moments.mean.size(); ++c) {
    Real &mean = pooled_mean.data()[c], &variance = pooled_variance.data()[c];
    const double shift = moments.mean[c] - static_cast<double>(mean);
    const double within = moments.deviations[c] / moments.count;
    variance = static_cast<Real>((1 - weight) * static_cast<double>(variance) + weight * within +
                                 weight * (1 - weight) * shift * shift);
    mean = static_cast<Real>(static_cast<double>(mean) + weight * shift);
  }
}

Real inverse_deviation(double variance) {
  return static_cast<Real>(1.0 / std::sqrt(variance + kBatchNormEpsilon));
}

}  // namespace

Normalisation::Normalisation(Index channels)
    : gamma_({channels}, true), beta_({channels}, true), mean_({channels}), variance_({channels}) {
  std::fill_n(gamma_.data(), channels, Real(1));
  std::fill_n(variance_.data(), channels, Real(1));
}

std::vector<NamedTensor> Normalisation::state() const {
  using Role = NamedTensor::Role;
  return {{"gamma", gamma_, Role::kWeight},
          {"beta", beta_, Role::kWeight},
          {"running_mean", mean_, Role::kStatistic},
          {"running_var", variance_, Role::kStatistic}};
}

Normalisation::Statistics Normalisation::stored() const {
  Statistics s{Values(mean_.values().begin(), mean_.values().end()), {}, {}};
  for (const Real variance : variance_.values()) {
    s.inverse.push_back(inverse_deviation(static_cast<double>(variance)));
  }
  set_scale(s);
  return s;
}

void Normalisation::set_scale(Statistics& s) const {
  s.scale = s.inverse;
  for (std::size_t c = 0; c < s.scale.size(); ++c) s.scale[c] *= gamma_.data()[c];
}

void Normalisation::measure(const Real* x, Index size, Real* moments) const {
  const Index rows = size / channels();
  channel_sums(x, rows, channels(), moments);
  for (Index c = 0; c < channels(); ++c) moments[c] /= static_cast<Real>(rows);
  channel_deviations(x, moments, rows, channels(), moments + channels());
}

Normalisation::Statistics Normalisation::of_pieces(const PieceSums& parts, Index n, Index sample,
                                                   const Pass& pass) const {
  Moments moments(channels());
  const Index rows = sample / channels(), pieces = parts.pieces();
  for (Index k = 0; k < pieces; ++k) {
    moments.merge(parts.data() + k * parts.size(),
                  (piece_begin(n, pieces, k + 1) - piece_begin(n, pieces, k)) * rows);
  }
  if (pass.mode == Pass::Mode::kTrain) {
    follow(moments, mean_, variance_);
  } else {
    pool(moments, 1.0 / static_cast<double>(pass.batch_number + 1), mean_, variance_);
  }
  Statistics s{Values(moments.mean.begin(), moments.mean.end()), {}, {}, true};
  for (const double sum : moments.deviations) {
    s.inverse.push_back(inverse_deviation(sum / moments.count));
  }
  set_scale(s);
  return s;
}

void Normalisation::apply(const Statistics& s, const Real* x, Index size, Real* y) const {
  channel_affine(x, s.mean.data(), s.scale.data(), beta_.data(), size / channels(), channels(),
                 relu_, y);
}

Normalisation::Slopes Normalisation::parameter_gradients(const Statistics& s,
                                                         const PieceSums& parts,
                                                         Index count) const {
  const auto width = static_cast<std::size_t>(channels());
  Values sums(2 * width);
  sum_arrays(parts.data(), parts.pieces(), parts.size(), {sums.data(), false});
  Slopes slopes{Values(width), Values(width)};
  const Real rows = static_cast<Real>(count);
  const Tensor::GradientSlot dgamma = gamma_.gradient_slot(), dbeta = beta_.gradient_slot();
  for (std::size_t c = 0; c < width; ++c) {
    const Real sum = sums[c], product = sums[width + c] * s.inverse[c];
    dbeta.data[c] = (dbeta.add ? dbeta.data[c] : 0) + sum;
    dgamma.data[c] = (dgamma.add ? dgamma.data[c] : 0) + product;
    slopes.slope[c] = s.of_batch ? -s.scale[c] * product * s.inverse[c] / rows : 0;
    slopes.shift[c] = s.of_batch ? -s.scale[c] * sum / rows : 0;
  }
  return slopes;
}

}  // namespace dcnn
