#include "nn/batch_norm.h"

#include <cmath>

#include "dcnn/nn/layer.h"
#include "nn/kernels/channels.h"
#include "nn/pieces.h"

namespace dcnn {
namespace {

constexpr double kMomentum = 0.1;

using Values = std::vector<Real>;  // one per channel

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

Moments batch_moments(const Tensor& x) {
  const Index channels = x.dim(-1), rows = x.size() / x.dim(0) / channels;
  PieceSums parts(x.dim(0), 2 * channels);
  for_each_part(x.dim(0), [&](Index piece, Index begin, Index samples) {
    const Real* from = x.data() + begin * rows * channels;
    Real* mean = parts.of(piece);
    channel_sums(from, samples * rows, channels, mean);
    for (Index c = 0; c < channels; ++c) mean[c] /= static_cast<Real>(samples * rows);
    channel_products(from, mean, nullptr, samples * rows, channels, mean + channels);
  });
  Moments moments(channels);
  const Index n = x.dim(0), pieces = parts.pieces();
  for (Index k = 0; k < pieces; ++k) {
    moments.merge(parts.of(k), (piece_begin(n, pieces, k + 1) - piece_begin(n, pieces, k)) * rows);
  }
  return moments;
}

/// What a pass normalises with: (x - mean)·inverse, inverse = 1/sqrt(variance + eps).
struct Statistics {
  Values mean, inverse;
  bool of_batch;  // they depend on x, so the gradient flows through them
};

/// At inference, where no layer before it could take it (Network::folded()).
class BatchNormStep final : public PlanStep {
 public:
  BatchNormStep(Statistics statistics, Values scale, Values shift, Index rows)
      : statistics_(std::move(statistics)),
        scale_(std::move(scale)),
        shift_(std::move(shift)),
        rows_(rows) {}
  void run(const Real* x, Real* y) noexcept override {
    for (Index r = 0; r < rows_; ++r) {
      for (std::size_t c = 0; c < scale_.size(); ++c) {
        *y++ = (*x++ - statistics_.mean[c]) * scale_[c] + shift_[c];
      }
    }
  }

 private:
  Statistics statistics_;
  Values scale_, shift_;
  Index rows_;
};

/// y = gamma·(x - mean)/sqrt(variance + eps) + beta per channel over batch and positions (Ioffe and
/// Szegedy 2015). (N, …, C) in, the same shape out.
class BatchNorm final : public Layer {
 public:
  explicit BatchNorm(Index channels)
      : gamma_({channels}, true),
        beta_({channels}, true),
        mean_({channels}),
        variance_({channels}) {
    std::fill_n(gamma_.data(), channels, Real(1));
    std::fill_n(variance_.data(), channels, Real(1));
  }

  Tensor forward(const Tensor& x, Pass& pass) const override {
    Statistics statistics = choose(x, pass);
    const Index channels = gamma_.size();
    Values scale(statistics.inverse);
    for (std::size_t c = 0; c < scale.size(); ++c) scale[c] *= gamma_.data()[c];
    Tensor y = Tensor::uninitialised(x.shape());
    for_each_range(x, [&](Index begin, Index count) {
      channel_affine(x.data() + begin, statistics.mean.data(), scale.data(), beta_.data(),
                     count / channels, channels, y.data() + begin);
    });
    return record(y, {x, gamma_, beta_},
                  [x, gamma = gamma_, beta = beta_, s = std::move(statistics)](const Tensor& out) {
                    backward(x, gamma, beta, s, out.gradient_data());
                  });
  }

  std::unique_ptr<PlanStep> plan(const Shape& sample, PlanStep*) const override {
    Statistics statistics = stored();
    Values scale(statistics.inverse);
    for (std::size_t c = 0; c < scale.size(); ++c) scale[c] *= gamma_.data()[c];
    return std::make_unique<BatchNormStep>(std::move(statistics), std::move(scale),
                                           Values(beta_.values().begin(), beta_.values().end()),
                                           element_count(sample) / gamma_.size());
  }

  std::vector<NamedTensor> state() const override {
    using Role = NamedTensor::Role;
    return {{"gamma", gamma_, Role::kWeight},
            {"beta", beta_, Role::kWeight},
            {"running_mean", mean_, Role::kStatistic},
            {"running_var", variance_, Role::kStatistic}};
  }

 private:
  Statistics choose(const Tensor& x, const Pass& pass) const {
    if (pass.mode == Pass::Mode::kInfer) return stored();
    const Moments moments = batch_moments(x);
    if (pass.mode == Pass::Mode::kTrain) {
      follow(moments);
    } else {
      pool(moments, 1.0 / static_cast<double>(pass.batch_number + 1));
    }
    Statistics statistics{Values(moments.mean.begin(), moments.mean.end()), {}, true};
    for (const double sum : moments.deviations) {
      statistics.inverse.push_back(inverse_deviation(sum / moments.count));
    }
    return statistics;
  }

  Statistics stored() const {
    Statistics statistics{Values(mean_.values().begin(), mean_.values().end()), {}, false};
    for (const Real variance : variance_.values()) {
      statistics.inverse.push_back(inverse_deviation(static_cast<double>(variance)));
    }
    return statistics;
  }

  static Real inverse_deviation(double variance) {
    return static_cast<Real>(1.0 / std::sqrt(variance + kBatchNormEpsilon));
  }

  /// Running statistics: an exponential average, of the unbiased variance as in PyTorch.
  void follow(const Moments& moments) const {
    for (std::size_t c = 0; c < moments.mean.size(); ++c) {
      const double variance = moments.deviations[c] / std::max(moments.count - 1, 1.0);
      Real &mean = mean_.data()[c], &running = variance_.data()[c];
      mean = static_cast<Real>((1 - kMomentum) * static_cast<double>(mean) +
                               kMomentum * moments.mean[c]);
      running =
          static_cast<Real>((1 - kMomentum) * static_cast<double>(running) + kMomentum * variance);
    }
  }

  /// Exact statistics of everything seen since batch 0, for batches of equal size.
  void pool(const Moments& moments, double weight) const {
    for (std::size_t c = 0; c < moments.mean.size(); ++c) {
      Real &mean = mean_.data()[c], &variance = variance_.data()[c];
      const double shift = moments.mean[c] - static_cast<double>(mean);
      const double within = moments.deviations[c] / moments.count;
      variance = static_cast<Real>((1 - weight) * static_cast<double>(variance) + weight * within +
                                   weight * (1 - weight) * shift * shift);
      mean = static_cast<Real>(static_cast<double>(mean) + weight * shift);
    }
  }

  static void backward(const Tensor& x, const Tensor& gamma, const Tensor& beta,
                       const Statistics& s, const Real* dy) {
    const Index channels = gamma.size();
    const Tensor sums = gradient_sums(x, s, dy);
    const auto width = static_cast<std::size_t>(channels);
    Values scale(width), slope(width), shift(width);
    const Real rows = static_cast<Real>(x.size() / channels);
    const Tensor::GradientSlot dgamma = gamma.gradient_slot(), dbeta = beta.gradient_slot();
    for (std::size_t c = 0; c < width; ++c) {
      const Real sum = sums.data()[c], product = sums.data()[width + c] * s.inverse[c];
      dbeta.data[c] = (dbeta.add ? dbeta.data[c] : 0) + sum;
      dgamma.data[c] = (dgamma.add ? dgamma.data[c] : 0) + product;
      scale[c] = gamma.data()[c] * s.inverse[c];
      slope[c] = s.of_batch ? -scale[c] * product * s.inverse[c] / rows : 0;
      shift[c] = s.of_batch ? -scale[c] * sum / rows : 0;
    }
    if (!x.wants_gradient()) return;
    const Tensor::GradientSlot dx = x.gradient_slot();
    for_each_range(x, [&](Index begin, Index count) {
      channel_gradient(dy + begin, scale.data(), x.data() + begin, s.mean.data(), slope.data(),
                       shift.data(), count / channels, channels, {dx.data + begin, dx.add});
    });
  }

  /// (2, C): sums of dy and of dy·(x - mean).
  static Tensor gradient_sums(const Tensor& x, const Statistics& s, const Real* dy) {
    const Index channels = x.dim(-1), per_sample = x.size() / x.dim(0);
    PieceSums parts(x.dim(0), 2 * channels);
    for_each_part(x.dim(0), [&](Index piece, Index begin, Index samples) {
      const Index first = begin * per_sample, rows = samples * per_sample / channels;
      channel_sums(dy + first, rows, channels, parts.of(piece));
      channel_products(x.data() + first, s.mean.data(), dy + first, rows, channels,
                       parts.of(piece) + channels);
    });
    Tensor sums = Tensor::uninitialised({2, channels});
    sum_arrays(parts.data(), parts.pieces(), parts.size(), {sums.data(), false});
    return sums;
  }

  Tensor gamma_, beta_, mean_, variance_;
};

LayerPtr make_batch_norm(Options&, const Shape& input, Rng&) {
  return std::make_unique<BatchNorm>(input.back());
}

}  // namespace

extern constinit const LayerKind batch_norm{
    .name = "batch_norm", .example = "{}", .example_input = {6, 4, 3, 5}, .make = make_batch_norm};

}  // namespace dcnn
