// dcnn_bench_libtorch [pairs]: epochs of the same training, ours and libtorch's in turn, in one
// process.
#include <torch/torch.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>

#include "bench/training.h"

namespace {

/// The network, loss and optimiser of bench/training.h in libtorch.
class TorchTraining {
 public:
  explicit TorchTraining(bool same) : adam_(build(same)) {
    x_ = torch::randn({dcnn::kSamples, 1, 15, 5});
    wanted_ = torch::randn({dcnn::kSamples, 3});
  }

  void epoch() {
    for (dcnn::Index first = 0; first + dcnn::kBatch <= dcnn::kSamples; first += dcnn::kBatch) {
      adam_.zero_grad();
      const auto predicted = network_->forward(x_.narrow(0, first, dcnn::kBatch));
      const auto error = predicted - wanted_.narrow(0, first, dcnn::kBatch);
      (0.5 * error.square().sum() / static_cast<double>(dcnn::kBatch)).backward();
      adam_.step();
    }
  }

 private:
  torch::optim::Adam build(bool same) {
    namespace nn = torch::nn;
    std::int64_t channels = 1;
    for (const std::int64_t filters : {8, 16, 32, 32}) {
      if (same) network_->push_back(nn::ZeroPad2d(nn::ZeroPad2dOptions({0, 1, 0, 1})));
      network_->push_back(nn::Conv2d(nn::Conv2dOptions(channels, filters, 2)));
      network_->push_back(nn::BatchNorm2d(filters));
      network_->push_back(nn::ReLU(nn::ReLUOptions(true)));
      channels = filters;
    }
    network_->push_back(nn::Dropout(0.5));
    network_->push_back(nn::Flatten());
    network_->push_back(nn::Linear(same ? 2400 : 352, 3));
    return torch::optim::Adam(network_->parameters(),
                              torch::optim::AdamOptions(1e-3).weight_decay(1e-4));
  }

  torch::nn::Sequential network_;
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

void compare(const char* padding, int pairs) {
  dcnn::Training ours(padding);
  TorchTraining theirs(std::string(padding) == "same");
  std::vector<double> own, other, ratio;
  for (int i = 0; i < pairs; ++i) {
    own.push_back(seconds([&] { ours.epoch(); }));
    other.push_back(seconds([&] { theirs.epoch(); }));
    ratio.push_back(other.back() / own.back());
  }
  const double best = *std::min_element(own.begin(), own.end());
  const double work = dcnn::training_products(padding) *
                      static_cast<double>(dcnn::kSamples / dcnn::kBatch * dcnn::kBatch);
  std::printf("%-5s epoch: ours %.3f s (least %.3f), libtorch %.3f s, ratio %.2f; %.1f%% of peak\n",
              padding, median(own), best, median(other), median(ratio),
              100 * work / best / dcnn::peak_multiply_adds());
}

}  // namespace

int main(int argc, char** argv) {
  const int pairs = argc > 1 ? std::max(1, std::atoi(argv[1])) : 5;
  torch::set_num_threads(dcnn::threads());
  std::printf("%d threads, batch %d, %d pairs of epochs\n", dcnn::threads(),
              static_cast<int>(dcnn::kBatch), pairs);
  std::setvbuf(stdout, nullptr, _IOLBF, 0);  // results as they come
  compare("valid", pairs);
  compare("same", pairs);
}
