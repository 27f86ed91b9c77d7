// SPDX-License-Identifier: Apache-2.0
// dcnn-peer-libtorch: libtorch beside dcnn-bench, predictions and training epochs.
#include <torch/torch.h>

#include "peers/libtorch_training.h"
#include "peers/serve.h"

namespace dcnn::peers {
namespace {

using torch::Tensor;
using Layer = std::function<Tensor(const Tensor&)>;

Tensor stored(const ExportedNetwork& network, Index layer, const char* name) {
  const auto& shape = network.tensor(layer, name).shape;
  return torch::from_blob(const_cast<float*>(network.values(layer, name)),
                          std::vector<std::int64_t>(shape.begin(), shape.end()))
      .clone();
}

/// (windows h, w, C, filters) for channels-first images.
Layer convolution(const ExportedNetwork& network, Index layer) {
  const Tensor weight = stored(network, layer, "weight").permute({3, 2, 0, 1}).contiguous();
  const Tensor bias = stored(network, layer, "bias");
  const std::int64_t h = weight.size(2) - 1, w = weight.size(3) - 1;
  if (network.layers[layer].value("padding", "same") != "same") {
    return [=](const Tensor& x) { return torch::conv2d(x, weight, bias); };
  }
  const std::vector<std::int64_t> zeros{w / 2, w - w / 2, h / 2, h - h / 2};
  return [=](const Tensor& x) {
    return torch::conv2d(torch::constant_pad_nd(x, zeros), weight, bias);
  };
}

/// `image`: (H, W, C) of what was flattened channels-first, or empty.
Layer linear(const ExportedNetwork& network, Index layer, const Shape& image) {
  Tensor weight = stored(network, layer, "weight");
  if (image.size() == 3) {
    weight = weight.view({weight.size(0), image[0] * image[1], image[2]})
                 .transpose(1, 2)
                 .reshape({weight.size(0), -1})
                 .contiguous();
  }
  const Tensor bias = stored(network, layer, "bias");
  return [=](const Tensor& x) { return torch::linear(x, weight, bias); };
}

/// h and c of an LSTM after a call, undefined before the first.
struct State {
  Tensor h, c;
};

/// From `state`, which is then that after it; null: from zero.
Layer lstm(const ExportedNetwork& network, Index layer, State* state) {
  const Tensor input = stored(network, layer, "input_weight").t().contiguous();
  const Tensor recurrent = stored(network, layer, "recurrent_weight").t().contiguous();
  const Tensor bias = stored(network, layer, "bias");
  const std::vector<Tensor> weights{input, recurrent, bias, torch::zeros_like(bias)};
  return [=, units = recurrent.size(1)](const Tensor& x) {
    State before;
    if (state) before = *state;
    if (!before.h.defined()) before.h = before.c = torch::zeros({1, x.size(0), units});
    const auto [all, h, c] =
        torch::lstm(x, {before.h, before.c}, weights, true, 1, 0.0, false, false, true);
    if (state) *state = {h, c};
    return h.squeeze(0);
  };
}

class TorchRunner final : public Runner {
 public:
  TorchRunner(const ExportedNetwork& network, Index batch) {
    Shape shape = network.input;
    Shape image;
    if (shape.size() == 3) {
      image = shape;
      shape = {shape[2], shape[0], shape[1]};
    }
    shape_.assign(shape.begin(), shape.end());
    shape_.insert(shape_.begin(), batch);
    for (Index i = 0; i < static_cast<Index>(network.layers.size()); ++i) {
      const auto kind = network.layers[i].at("kind").get<std::string>();
      if (kind == "conv2d") layers_.push_back(convolution(network, i));
      if (kind == "conv2d") image = after_convolution(network, i, image);
      if (kind == "linear") layers_.push_back(linear(network, i, image));
      if (kind == "linear") image.clear();
      if (kind == "lstm") layers_.push_back(lstm(network, i, network.carries ? &state_ : nullptr));
      if (kind == "relu") layers_.push_back([](Tensor x) { return x.relu_(); });
      if (kind == "tanh") layers_.push_back([](Tensor x) { return x.tanh_(); });
      if (kind == "flatten") layers_.push_back([](const Tensor& x) { return x.flatten(1); });
    }
    const std::vector<float> zeros(static_cast<std::size_t>(torch::zeros(shape_).numel()));
    run(zeros.data());
    outputs_ = y_.numel() / batch;
  }

  const float* run(const float* samples) override {
    const c10::InferenceMode guard;
    Tensor x = torch::from_blob(const_cast<float*>(samples), shape_);
    for (const Layer& layer : layers_) x = layer(x);
    y_ = x.contiguous();
    return y_.data_ptr<float>();
  }
  Index outputs() const override { return outputs_; }
  void begin() override { state_ = {}; }

 private:
  static Shape after_convolution(const ExportedNetwork& network, Index layer, Shape image) {
    const auto& weight = network.tensor(layer, "weight").shape;
    if (network.layers[layer].value("padding", "same") != "same") {
      image[0] -= weight[0] - 1;
      image[1] -= weight[1] - 1;
    }
    image[2] = weight[3];
    return image;
  }

  std::vector<std::int64_t> shape_;
  State state_;
  std::vector<Layer> layers_;
  Tensor y_;
  Index outputs_ = 0;
};

}  // namespace
}  // namespace dcnn::peers

int main() {
  using namespace dcnn;
  return peers::serve({.name = "libtorch",
                       .version = TORCH_VERSION,
                       .load =
                           [](const peers::ExportedNetwork& network, Index batch, int threads) {
                             torch::set_num_threads(threads);
                             return std::make_unique<peers::TorchRunner>(network, batch);
                           },
                       .train =
                           [](const std::string& network, int threads) {
                             torch::set_num_threads(threads);
                             return peers::make_trainee(network);
                           }});
}
