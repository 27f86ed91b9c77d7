// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "dcnn/nn/layer.h"
#include "nn/pieces.h"

namespace dcnn {
namespace {

class TanhStep final : public PlanStep {
 public:
  explicit TanhStep(Index size) : size_(size) {}
  void run(const Real* x, Real* y) noexcept override {
    for (Index i = 0; i < size_; ++i) y[i] = std::tanh(x[i]);
  }

 private:
  Index size_;
};

/// y = tanh(x). Any shape in, the same shape out.
class Tanh final : public Layer {
 public:
  Tensor forward(const Tensor& x, Pass&) const override {
    Tensor y = Tensor::uninitialised(x.shape());
    for_each_range(x, [&](Index begin, Index count) {
      for (Index i = begin; i < begin + count; ++i) y.data()[i] = std::tanh(x.data()[i]);
    });
    return record(y, {x}, [x](const Tensor& out) {
      const Real *dy = out.gradient_data(), *value = out.data();
      Real* dx = x.gradient_data();
      for_each_range(x, [&](Index begin, Index count) {
        for (Index i = begin; i < begin + count; ++i) dx[i] += dy[i] * (1 - value[i] * value[i]);
      });
    });
  }

  std::unique_ptr<PlanStep> plan(const Shape& sample, PlanStep* before) const override {
    if (before && before->absorb_tanh()) return nullptr;
    return std::make_unique<TanhStep>(element_count(sample));
  }
};

LayerPtr make_tanh(Options&, const Shape&, Rng&) { return std::make_unique<Tanh>(); }

}  // namespace

extern constinit const LayerKind tanh{
    .name = "tanh", .example = "{}", .example_input = {3, 5, 4}, .make = make_tanh};

}  // namespace dcnn
