// dcnn_bench_libtorch [pairs [dcnn|lstm]]: epochs of the same training, ours and libtorch's in
// turn, in one process.
#include <torch/torch.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "bench/training.h"

namespace {

namespace nn = torch::nn;

/// The newest step's output of an LSTM over windows (N, T, 15), the rest as in spec 2.5.
struct TorchLstm : nn::Module {
  TorchLstm() { register_module("lstm", lstm), register_module("linear", linear); }
  torch::Tensor forward(const torch::Tensor& x) {
    const auto h = std::get<0>(lstm->forward(x)).select(1, x.size(1) - 1);
    return linear->forward(torch::dropout(h, 0.5, true));
  }
  nn::LSTM lstm{nn::LSTMOptions(15, dcnn::kLstmUnits).batch_first(true)};
  nn::Linear linear{dcnn::kLstmUnits, 3};
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

/// The loss, clipping and optimiser of bench/training.h around a network of libtorch.
template <class Network>
class TorchTraining {
 public:
  TorchTraining(Network network, torch::IntArrayRef input, const dcnn::Task& task)
      : network_(std::move(network)),
        task_(task),
        adam_(network_->parameters(), torch::optim::AdamOptions(1e-3).weight_decay(1e-4)) {
    std::vector<std::int64_t> shape(input.begin(), input.end());
    shape.insert(shape.begin(), dcnn::kSamples);
    x_ = torch::randn(shape);
    wanted_ = torch::randn({dcnn::kSamples, 3});
  }

  void epoch() {
    const auto batch = task_.batch;
    for (dcnn::Index first = 0; first + batch <= dcnn::kSamples; first += batch) {
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
  dcnn::Task task_;
  torch::optim::Adam adam_;
  torch::Tensor x_, wanted_;
};

template <class Work>
double seconds(const Work& work) {
  using Clock = std::chrono::steady_clock;
  const auto begin = Clock::now();
  work();
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

template <class Theirs>
void compare(const dcnn::Task& task, Theirs theirs, int pairs) {
  dcnn::Training ours(task);
  std::vector<double> own, other, ratio;
  for (int i = 0; i < pairs; ++i) {
    own.push_back(seconds([&] { ours.epoch(); }));
    other.push_back(seconds([&] { theirs.epoch(); }));
    ratio.push_back(other.back() / own.back());
  }
  const double best = *std::min_element(own.begin(), own.end());
  const double work = task.training_products * static_cast<double>(task.batches() * task.batch);
  std::printf(
      "%-10s epoch: ours %.3f s (least %.3f), libtorch %.3f s, ratio %.2f; %.1f%% of peak\n",
      task.name.c_str(), median(own), best, median(other), median(ratio),
      100 * work / best / dcnn::peak_multiply_adds());
}

void compare_dcnn(const std::string& padding, int pairs) {
  const dcnn::Task task = dcnn::dcnn_task(padding);
  compare(task, TorchTraining(torch_dcnn(padding == "same"), {1, 15, 5}, task), pairs);
}

void compare_lstm(dcnn::Index steps, int pairs) {
  const dcnn::Task task = dcnn::lstm_task(steps);
  compare(task, TorchTraining(std::make_shared<TorchLstm>(), {steps, 15}, task), pairs);
}

}  // namespace

int main(int argc, char** argv) {
  const int pairs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
  const std::string only = argc > 2 ? argv[2] : "";
  torch::set_num_threads(dcnn::threads());
  std::printf("%d threads, %d pairs of epochs\n", dcnn::threads(), pairs);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // results as they come
  if (only != "lstm") compare_dcnn("valid", pairs);
  if (only != "lstm") compare_dcnn("same", pairs);
  if (only == "dcnn") return 0;
  for (const dcnn::Index steps : {1, 10, 25}) compare_lstm(steps, pairs);
}
