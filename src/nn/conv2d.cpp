// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <optional>

#include "dcnn/nn/layer.h"
#include "nn/init.h"
#include "nn/kernels/channels.h"
#include "nn/kernels/convolution_plan.h"
#include "nn/normalisation.h"
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
/// lies at the bottom and at the right (as in the paper's toolbox).
class Conv2d final : public Layer {
 public:
  Conv2d(const ConvShape& shape, Tensor weight, Tensor bias)
      : shape_(shape), weight_(std::move(weight)), bias_(std::move(bias)) {}

  Tensor forward(const Tensor& x, Pass& pass) const override {
    Tensor z = Tensor::uninitialised({x.dim(0), shape_.out_h, shape_.out_w, shape_.out_c});
    const auto convolve_piece = [&](Index begin, Index samples) {
      convolve(shape_, samples, x.data() + begin * shape_.in_size(), weight_.data(), bias_.data(),
               z.data() + begin * shape_.out_size(), false);
    };
    if (norm_) return forward_normalised(x, pass, z, convolve_piece);
    for_each_part(x.dim(0),
                  [&](Index, Index begin, Index samples) { convolve_piece(begin, samples); });
    return record(z, {x, weight_, bias_},
                  [s = shape_, x, weight = weight_, bias = bias_](const Tensor& out) {
                    WayBack back(s, x, weight, bias, out.gradient_data());
                    for_each_part(x.dim(0), [&](Index piece, Index begin, Index samples) {
                      back.piece(piece, begin, samples);
                    });
                    back.finish();
                  });
  }
  bool absorb_norm(const Normalisation& norm) override {
    if (norm_) return false;
    norm_ = norm;
    return true;
  }
  bool absorb_relu() override {
    if (norm_) norm_->absorb_relu();
    return norm_.has_value();
  }

  std::unique_ptr<PlanStep> plan(const Shape&, PlanStep*) const override {
    return std::make_unique<Conv2dStep>(shape_, weight_, bias_);
  }

  std::vector<NamedTensor> state() const override {
    return {{"weight", weight_, NamedTensor::Role::kWeight},
            {"bias", bias_, NamedTensor::Role::kBias}};
  }

 private:
  /// From dLoss/dz, piece by piece.
  class WayBack {
   public:
    WayBack(const ConvShape& s, const Tensor& x, const Tensor& weight, const Tensor& bias,
            const Real* dz)
        : s_(s),
          x_(x),
          weight_(weight),
          bias_(bias),
          dz_(dz),
          dweight_(x.dim(0), weight.size()),
          dbias_(x.dim(0), s.out_c) {
      if (!x.wants_gradient()) return;
      flipped_ = Tensor::uninitialised(weight.shape());
      flip_weights(s, weight.data(), flipped_.data());
      dx_ = x.gradient_slot();
    }
    void piece(Index piece, Index begin, Index samples) {
      const Real* dz = dz_ + begin * s_.out_size();
      weight_gradient(s_, samples, x_.data() + begin * s_.in_size(), dz, dweight_.of(piece));
      channel_sums(dz, samples * s_.out_h * s_.out_w, s_.out_c, dbias_.of(piece));
      if (!dx_.data) return;
      convolve(transposed(s_), samples, dz, flipped_.data(), nullptr,
               dx_.data + begin * s_.in_size(), dx_.add);
    }
    void finish() {
      sum_pieces(dweight_, weight_);
      sum_pieces(dbias_, bias_);
    }

   private:
    const ConvShape& s_;
    const Tensor &x_, &weight_, &bias_;
    const Real* dz_;
    PieceSums dweight_, dbias_;
    Tensor flipped_;
    Tensor::GradientSlot dx_{};
  };

  /// On the way back dLoss/dz takes the place of z.
  template <class Convolve>
  Tensor forward_normalised(const Tensor& x, const Pass& pass, const Tensor& z,
                            const Convolve& convolve_piece) const {
    Normalisation::Statistics s;
    const Tensor y = norm_->forward(z, pass, convolve_piece, s);
    return record(y, {x, weight_, bias_, norm_->gamma(), norm_->beta()},
                  [shape = shape_, x, weight = weight_, bias = bias_, norm = *norm_, z,
                   s = std::move(s)](const Tensor& out) {
                    WayBack back(shape, x, weight, bias, z.data());
                    norm.backward(z, s, out, {z.data(), false},
                                  [&](Index piece, Index begin, Index samples) {
                                    back.piece(piece, begin, samples);
                                  });
                    back.finish();
                  });
  }

  ConvShape shape_;
  Tensor weight_, bias_;
  std::optional<Normalisation> norm_;  // of what it makes
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
