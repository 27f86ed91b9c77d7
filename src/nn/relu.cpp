// SPDX-License-Identifier: Apache-2.0
#include "dcnn/nn/layer.h"
#include "nn/kernels/elementwise.h"
#include "nn/pieces.h"

namespace dcnn {
namespace {

class ReluStep final : public PlanStep {
 public:
  explicit ReluStep(Index size) : size_(size) {}
  void run(const Real* x, Real* y) noexcept override { relu_forward(x, size_, y); }

 private:
  Index size_;
};

/// y = max(x, 0). Any shape in, the same shape out.
class Relu final : public Layer {
 public:
  Tensor forward(const Tensor& x, Pass&) const override {
    Tensor y = Tensor::uninitialised(x.shape());
    for_each_range(x, [&](Index begin, Index count) {
      relu_forward(x.data() + begin, count, y.data() + begin);
    });
    return record(y, {x}, [x](const Tensor& out) {
      const Tensor::GradientSlot dx = x.gradient_slot();
      const Real* dy = out.gradient_data();
      for_each_range(x, [&](Index begin, Index count) {
        relu_gradient(out.data() + begin, dy + begin, count, {dx.data + begin, dx.add});
      });
    });
  }

  bool join(Layer& before) const override { return before.absorb_relu(); }

  std::unique_ptr<PlanStep> plan(const Shape& sample, PlanStep* before) const override {
    if (before && before->absorb_relu()) return nullptr;
    return std::make_unique<ReluStep>(element_count(sample));
  }
};

LayerPtr make_relu(Options&, const Shape&, Rng&) { return std::make_unique<Relu>(); }

}  // namespace

extern constinit const LayerKind relu{
    .name = "relu", .example = "{}", .example_input = {3, 5, 4}, .make = make_relu};

}  // namespace dcnn
