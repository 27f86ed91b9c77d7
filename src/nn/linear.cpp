// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "dcnn/nn/layer.h"
#include "nn/init.h"
#include "nn/kernels/channels.h"
#include "nn/kernels/dense_chain.h"
#include "nn/kernels/elementwise.h"
#include "nn/kernels/tile.h"
#include "nn/pieces.h"

namespace dcnn {
namespace {

class LinearStep final : public PlanStep {
 public:
  LinearStep(const Tensor& weight, const Tensor& bias)
      : weight_(Tensor::from(weight.shape(), weight.values())),
        bias_(Tensor::from(bias.shape(), bias.values())) {}
  void run(const Real* x, Real* y) noexcept override {
    affine_of_one(x, weight_.data(), bias_.data(), weight_.dim(1), weight_.dim(0), y);
  }

 private:
  Tensor weight_, bias_;
};

/// Small layers and what is between them. Beyond a few outputs units in the lanes beat dot
/// products, and one call for all of them counts as much.
class DenseStep final : public PlanStep {
 public:
  DenseStep(const Tensor& weight, const Tensor& bias) { layers_.emplace_back(weight, bias); }
  static bool takes(const Tensor& weight) {
    return std::max(weight.dim(0), weight.dim(1)) <= DenseLayer::kMost;
  }

  void run(const Real* x, Real* y) noexcept override { dense_of_one(layers_, x, y); }
  bool run_many(const Real* x, Index n, Real* y) noexcept override {
    dense_of_many(layers_, x, n, y);
    return true;
  }
  bool absorb_relu() override { return absorb(Activation::kRelu); }
  bool absorb_tanh() override { return absorb(Activation::kTanh); }
  bool absorb_linear(const Tensor& weight, const Tensor& bias) override {
    if (!takes(weight)) return false;
    layers_.emplace_back(weight, bias);
    return true;
  }

 private:
  bool absorb(Activation activation) {
    if (layers_.back().activation != Activation::kNone) return false;
    layers_.back().activation = activation;
    return true;
  }

  std::vector<DenseLayer> layers_;
};

/// y = W·x + b. (N, inputs) in, (N, outputs) out; weight (outputs, inputs).
class Linear final : public Layer {
 public:
  Linear(Tensor weight, Tensor bias) : weight_(std::move(weight)), bias_(std::move(bias)) {}

  Tensor forward(const Tensor& x, Pass&) const override {
    const Index inputs = weight_.dim(1), outputs = weight_.dim(0);
    Tensor y = Tensor::uninitialised({x.dim(0), outputs});
    for_each_part(x.dim(0), [&](Index, Index begin, Index samples) {
      for (Index n = begin; n < begin + samples; ++n) {
        affine(x.data() + n * inputs, weight_.data(), bias_.data(), inputs, outputs,
               y.data() + n * outputs);
      }
    });
    return record(y, {x, weight_, bias_}, [x, weight = weight_, bias = bias_](const Tensor& out) {
      backward(x, weight, bias, out.gradient_data());
    });
  }

  std::unique_ptr<PlanStep> plan(const Shape&, PlanStep* before) const override {
    if (before && before->absorb_linear(weight_, bias_)) return nullptr;
    if (DenseStep::takes(weight_)) return std::make_unique<DenseStep>(weight_, bias_);
    return std::make_unique<LinearStep>(weight_, bias_);
  }

  std::vector<NamedTensor> state() const override {
    return {{"weight", weight_, NamedTensor::Role::kWeight},
            {"bias", bias_, NamedTensor::Role::kBias}};
  }

 private:
  static void backward(const Tensor& x, const Tensor& weight, const Tensor& bias, const Real* dy) {
    const Index inputs = weight.dim(1), outputs = weight.dim(0);
    PieceSums dweight(x.dim(0), weight.size()), dbias(x.dim(0), outputs);
    const Tensor::GradientSlot dx = x.wants_gradient() ? x.gradient_slot() : Tensor::GradientSlot{};
    for_each_part(x.dim(0), [&](Index piece, Index begin, Index samples) {
      const Real *x_piece = x.data() + begin * inputs, *dy_piece = dy + begin * outputs;
      weight_product(x_piece, dy_piece, samples, inputs, outputs, dweight.of(piece));
      channel_sums(dy_piece, samples, outputs, dbias.of(piece));
      if (!dx.data) return;
      Real* to = dx.data + begin * inputs;
      const Run run{0, 0, outputs};
      tile_product({.a = dy_piece,
                    .a_row = outputs,
                    .a_step = 1,
                    .b = weight.data(),
                    .b_step = inputs,
                    .runs = {&run, 1},
                    .out = to,
                    .out_row = inputs,
                    .start = dx.add ? to : nullptr,
                    .start_row = inputs,
                    .rows = samples,
                    .columns = inputs});
    });
    sum_pieces(dweight, weight);
    sum_pieces(dbias, bias);
  }

  static void weight_product(const Real* x, const Real* dy, Index samples, Index inputs,
                             Index outputs, Real* dweight) {
    const Run run{0, 0, samples};
    tile_product({.a = dy,
                  .a_row = 1,
                  .a_step = outputs,
                  .b = x,
                  .b_step = inputs,
                  .runs = {&run, 1},
                  .out = dweight,
                  .out_row = inputs,
                  .start = nullptr,
                  .start_row = 0,
                  .rows = outputs,
                  .columns = inputs});
  }

  Tensor weight_, bias_;
};

LayerPtr make_linear(Options& options, const Shape& input, Rng& rng) {
  const Index outputs = read_units(options, "outputs");
  require(input.size() == 1, Exit::kUsage, "linear: input ", to_string(input),
          " is not a vector; put a 'flatten' layer before it");
  Tensor weight = initial_weight(options, {outputs, input[0]}, input[0], outputs, rng);
  return std::make_unique<Linear>(weight, Tensor({outputs}, true));
}

}  // namespace

extern constinit const LayerKind linear{.name = "linear",
                                        .example = R"({"outputs": 3})",
                                        .example_input = {6, 37},
                                        .make = make_linear};

}  // namespace dcnn
