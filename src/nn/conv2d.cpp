#include <algorithm>

#include "dcnn/nn/layer.h"
#include "nn/init.h"
#include "nn/kernels/channels.h"
#include "nn/kernels/convolution_plan.h"
#include "nn/pieces.h"

namespace dcnn {
namespace {

class Conv2dStep final : public PlanStep {
 public:
  Conv2dStep(const ConvShape& shape, const Tensor& weight, const Tensor& bias)
      : plan_(shape, weight, bias) {}
  void run(const Real* x, Real* y) noexcept override { plan_.run(x, relu_, y); }
  bool absorb_relu() override { return !plan_.absorbed() && (relu_ = true); }
  bool absorb_linear(const Tensor& weight, const Tensor& bias) override {
    return relu_ && plan_.absorb(weight, bias);
  }
  bool use_int16() override { return relu_ && plan_.use_int16(); }

 private:
  ConvolutionPlan plan_;
  bool relu_ = false;
};

/// Cross-correlation, stride 1, plus bias. (N, H, W, C) in, (N, H', W', filters) out; weight
/// (window_h, window_w, C, filters). With `same` H' = H, W' = W and the odd zero of an even window
/// lies at the bottom and at the right (spec 2.4).
class Conv2d final : public Layer {
 public:
  Conv2d(const ConvShape& shape, Tensor weight, Tensor bias)
      : shape_(shape), weight_(std::move(weight)), bias_(std::move(bias)) {}

  Tensor forward(const Tensor& x, Pass&) const override {
    const ConvShape& s = shape_;
    Tensor y = Tensor::uninitialised({x.dim(0), s.out_h, s.out_w, s.out_c});
    for_each_part(x.dim(0), [&](Index, Index begin, Index samples) {
      convolve(s, samples, x.data() + begin * s.in_size(), weight_.data(), bias_.data(),
               y.data() + begin * s.out_size(), false);
    });
    return record(y, {x, weight_, bias_},
                  [s, x, weight = weight_, bias = bias_](const Tensor& out) {
                    backward(s, x, weight, bias, out.gradient_data());
                  });
  }

  std::unique_ptr<PlanStep> plan(const Shape&, PlanStep*) const override {
    return std::make_unique<Conv2dStep>(shape_, weight_, bias_);
  }

  std::vector<NamedTensor> state() const override {
    return {{"weight", weight_, NamedTensor::Role::kWeight},
            {"bias", bias_, NamedTensor::Role::kBias}};
  }

 private:
  static void backward(const ConvShape& s, const Tensor& x, const Tensor& weight,
                       const Tensor& bias, const Real* dy) {
    PieceSums dweight(x.dim(0), weight.size()), dbias(x.dim(0), s.out_c);
    Tensor flipped;
    Tensor::GradientSlot dx{};
    if (x.wants_gradient()) {
      flipped = Tensor::uninitialised(weight.shape());
      flip_weights(s, weight.data(), flipped.data());
      dx = x.gradient_slot();
    }
    for_each_part(x.dim(0), [&](Index piece, Index begin, Index samples) {
      const Real* dy_piece = dy + begin * s.out_size();
      weight_gradient(s, samples, x.data() + begin * s.in_size(), dy_piece, dweight.of(piece));
      channel_sums(dy_piece, samples * s.out_h * s.out_w, s.out_c, dbias.of(piece));
      if (!dx.data) return;
      convolve(transposed(s), samples, dy_piece, flipped.data(), nullptr,
               dx.data + begin * s.in_size(), dx.add);
    });
    sum_pieces(dweight, weight);
    sum_pieces(dbias, bias);
  }

  ConvShape shape_;
  Tensor weight_, bias_;
};

/// `window`: [height, width], each from 1 to the input's.
std::vector<Index> read_window(Options& options) {
  const auto window = options.get<std::vector<Index>>("window", {2, 2});
  constexpr Index kMost = 64;
  if (window.size() != 2 || std::min(window[0], window[1]) < 1 ||
      std::max(window[0], window[1]) > kMost) {
    options.reject("window", "must be two whole numbers from 1 to ", kMost, ": [height, width]");
  }
  return window;
}

LayerPtr make_conv2d(Options& options, const Shape& input, Rng& rng) {
  require(input.size() == 3, Exit::kUsage, "conv2d: input ", to_string(input),
          " is not an image (height, width, channels)");
  const Index filters = read_units(options, "filters");
  const auto window = read_window(options);
  const bool same = options.choice("padding", "same", {"same", "valid"}) == "same";
  const Index h = window[0], w = window[1], channels = input[2];
  require(same || (input[0] >= h && input[1] >= w), Exit::kUsage, "conv2d: padding 'valid' with a ",
          h, "x", w, " window needs a larger input than ", to_string(input),
          "; use padding 'same'");
  ConvShape shape{.in_h = input[0],
                  .in_w = input[1],
                  .in_c = channels,
                  .out_h = same ? input[0] : input[0] - h + 1,
                  .out_w = same ? input[1] : input[1] - w + 1,
                  .out_c = filters,
                  .window_h = h,
                  .window_w = w,
                  .before_h = same ? (h - 1) / 2 : 0,
                  .before_w = same ? (w - 1) / 2 : 0};
  Tensor weight =
      initial_weight(options, {h, w, channels, filters}, h * w * channels, h * w * filters, rng);
  return std::make_unique<Conv2d>(shape, weight, Tensor({filters}, true));
}

}  // namespace

extern constinit const LayerKind conv2d{.name = "conv2d",
                                        .example = R"({"filters": 5, "window": [2, 3]})",
                                        .example_input = {6, 5, 4, 3},
                                        .make = make_conv2d};

}  // namespace dcnn
