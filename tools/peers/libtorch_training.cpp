// SPDX-License-Identifier: Apache-2.0
#include "peers/libtorch_training.h"

#include <torch/torch.h>

#include "experiment/peers/training.h"

namespace dcnn::peers {
namespace {

namespace nn = torch::nn;

/// The newest step's output of an LSTM over windows (N, T, 15), the rest as in the networks here.
struct TorchLstm : nn::Module {
  TorchLstm() { register_module("lstm", lstm), register_module("linear", linear); }
  torch::Tensor forward(const torch::Tensor& x) {
    const auto h = std::get<0>(lstm->forward(x)).select(1, x.size(1) - 1);
    return linear->forward(torch::dropout(h, 0.5, true));
  }
  nn::LSTM lstm{nn::LSTMOptions(15, kLstmUnits).batch_first(true)};
  nn::Linear linear{kLstmUnits, 3};
};

nn::Sequential torch_dcnn(bool same) {
  nn::Sequential network;
  std::int64_t channels = 1;
  for (const std::int64_t filters : {8, 16, 32, 32}) {
    if (same) network->push_back(nn::ZeroPad2d(nn::ZeroPad2dOptions({0, 1, 0, 1})));
    network->push_back(nn::Conv2d(nn::Conv2dOptions(channels, filters, 2)));
    network->push_back(nn::BatchNorm2d(filters));
    network->push_back(nn::ReLU(nn::ReLUOptions(true)));
    channels = filters;
  }
  network->push_back(nn::Dropout(0.5));
  network->push_back(nn::Flatten());
  network->push_back(nn::Linear(same ? 2400 : 352, 3));
  return network;
}

/// The loss, clipping and optimiser of training.h around a network of libtorch.
template <class Network>
class TorchTraining final : public Trainee {
 public:
  TorchTraining(Network network, torch::IntArrayRef input, const Task& task)
      : network_(std::move(network)),
        task_(task),
        adam_(network_->parameters(), torch::optim::AdamOptions(1e-3).weight_decay(1e-4)) {
    std::vector<std::int64_t> shape(input.begin(), input.end());
    shape.insert(shape.begin(), kSamples);
    x_ = torch::randn(shape);
    wanted_ = torch::randn({kSamples, 3});
  }

  void epoch() override {
    const auto batch = task_.batch;
    for (Index first = 0; first + batch <= kSamples; first += batch) {
      adam_.zero_grad();
      const auto predicted = network_->forward(x_.narrow(0, first, batch));
      const auto error = predicted - wanted_.narrow(0, first, batch);
      (0.5 * error.square().sum() / static_cast<double>(batch)).backward();
      if (task_.clip > 0) {
        for (const auto& p : network_->parameters()) nn::utils::clip_grad_norm_(p, task_.clip);
      }
      adam_.step();
    }
  }

 private:
  Network network_;
  Task task_;
  torch::optim::Adam adam_;
  torch::Tensor x_, wanted_;
};

template <class Network>
std::unique_ptr<Trainee> training(Network network, torch::IntArrayRef input, const Task& task) {
  return std::make_unique<TorchTraining<Network>>(std::move(network), input, task);
}

}  // namespace

std::unique_ptr<Trainee> make_trainee(const std::string& network) {
  const Task task = named_task(network);
  if (task.input.size() == 3) {
    return training(torch_dcnn(network == "dcnn-same"), {1, task.input[0], task.input[1]}, task);
  }
  return training(std::make_shared<TorchLstm>(), task.input, task);
}

}  // namespace dcnn::peers
