// SPDX-License-Identifier: Apache-2.0
#include "nn/batch_norm.h"

#include "nn/normalisation.h"

namespace dcnn {
namespace {

/// At inference, where no layer before it could take it (Network::folded()).
class BatchNormStep final : public PlanStep {
 public:
  BatchNormStep(const Normalisation& norm, Index rows)
      : statistics_(norm.stored()),
        shift_(norm.beta().values().begin(), norm.beta().values().end()),
        rows_(rows) {}
  void run(const Real* x, Real* y) noexcept override {
    for (Index r = 0; r < rows_; ++r) {
      for (std::size_t c = 0; c < shift_.size(); ++c) {
        *y++ = (*x++ - statistics_.mean[c]) * statistics_.scale[c] + shift_[c];
      }
    }
  }

 private:
  Normalisation::Statistics statistics_;
  Normalisation::Values shift_;
  Index rows_;
};

/// Where no convolution before it takes it.
class BatchNorm final : public Layer {
 public:
  explicit BatchNorm(Index channels) : norm_(channels) {}

  Tensor forward(const Tensor& x, Pass& pass) const override {
    Normalisation::Statistics s;
    const Tensor y = norm_.forward(
        x, pass, [](Index, Index) {}, s);
    return record(y, {x, norm_.gamma(), norm_.beta()},
                  [x, norm = norm_, s = std::move(s)](const Tensor& out) {
                    const auto dx = x.wants_gradient() ? x.gradient_slot() : Tensor::GradientSlot{};
                    norm.backward(x, s, out, dx, [](Index, Index, Index) {});
                  });
  }
  bool join(Layer& before) const override { return before.absorb_norm(norm_); }
  bool absorb_relu() override {
    norm_.absorb_relu();
    return true;
  }

  std::unique_ptr<PlanStep> plan(const Shape& sample, PlanStep*) const override {
    return std::make_unique<BatchNormStep>(norm_, element_count(sample) / norm_.channels());
  }

  std::vector<NamedTensor> state() const override { return norm_.state(); }

 private:
  Normalisation norm_;
};

LayerPtr make_batch_norm(Options&, const Shape& input, Rng&) {
  return std::make_unique<BatchNorm>(input.back());
}

}  // namespace

extern constinit const LayerKind batch_norm{
    .name = "batch_norm", .example = "{}", .example_input = {6, 4, 3, 5}, .make = make_batch_norm};

}  // namespace dcnn
