// SPDX-License-Identifier: Apache-2.0
#include "dcnn/nn/network.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/nn/optimizer.h"
#include "double/gradient_check.h"

namespace dcnn {
namespace {

Tensor random_tensor(Shape shape, std::uint64_t seed) {
  Tensor x(std::move(shape));
  Rng rng(seed);
  for (Real& value : x.values()) value = 3 + 2 * rng.normal();
  return x;
}

Network network_of(const char* json, const Shape& input) {
  Rng rng(1);
  return Network(Json::parse(json), input, rng);
}

TEST(BatchNorm, CollectsTheStatisticsOfTheWholeSet) {
  const Network network = network_of(R"([{"kind": "batch_norm"}])", {2, 3});
  double sum[3] = {}, squares[3] = {};
  for (Index k = 0; k < 4; ++k) {
    const Tensor x = random_tensor({10, 2, 3}, static_cast<std::uint64_t>(k));
    for (Index i = 0; i < x.size(); ++i) {
      x.data()[i] += static_cast<double>(k);  // the batches' means differ
      sum[i % 3] += x.data()[i];
      squares[i % 3] += x.data()[i] * x.data()[i];
    }
    Pass pass{.mode = Pass::Mode::kCollect, .batch_number = k};
    network.forward(x, pass);
  }
  for (int c = 0; c < 3; ++c) {
    const double mean = sum[c] / 80;
    EXPECT_NEAR(network.state()[2].tensor.data()[c], mean, 1e-12);
    EXPECT_NEAR(network.state()[3].tensor.data()[c], squares[c] / 80 - mean * mean, 1e-11);
  }
}

TEST(Network, FoldedIsTheSameFunction) {
  const Network network = network_of(R"([
      {"kind": "conv2d", "filters": 4}, {"kind": "batch_norm"}, {"kind": "relu"},
      {"kind": "batch_norm"}, {"kind": "flatten"},
      {"kind": "linear", "outputs": 5}, {"kind": "batch_norm"}, {"kind": "tanh"}])",
                                     {4, 3, 2});
  Rng rng(3);
  for (const auto& named : network.state()) {
    for (Real& value : named.tensor.values()) value = rng.uniform(0.1, 1);
  }
  const Network folded = network.folded();
  EXPECT_EQ(folded.layers().size(), network.layers().size() - 2);
  const Tensor x = random_tensor({6, 4, 3, 2}, 5);
  Pass pass;
  const Tensor wanted = network.forward(x, pass), got = folded.forward(x, pass);
  for (Index i = 0; i < wanted.size(); ++i) EXPECT_NEAR(got.data()[i], wanted.data()[i], 1e-12);
}

LearningRate rate_of(const char* json, Index epochs, Index steps) {
  Options options(Json::parse(json), "test", Exit::kUsage);
  LearningRate rate(options, epochs, steps);
  options.finish();
  return rate;
}

TEST(LearningRate, FollowsItsSchedule) {
  EXPECT_EQ(rate_of(R"({"lr": 0.5, "schedule": "constant"})", 10, 7).at(9, 6), 0.5);
  const auto steps = rate_of(R"({"lr": 1e-3, "drop_factor": 0.001, "drop_period": 300})", 500, 834);
  EXPECT_DOUBLE_EQ(steps.at(299, 833), 1e-3);
  EXPECT_DOUBLE_EQ(steps.at(300, 0), 1e-6);
  const auto cosine = rate_of(R"({"lr": 2e-3, "schedule": "cosine"})", 4, 10);
  EXPECT_DOUBLE_EQ(cosine.at(0, 0), 2e-3);
  EXPECT_DOUBLE_EQ(cosine.at(2, 0), 1e-3);
  EXPECT_LT(cosine.at(3, 9), 1e-5);
}

TEST(WeightAverage, FollowsTheWeightsAndSwaps) {
  const Tensor weight({1}, true);
  WeightAverage average({{"w", weight, NamedTensor::Role::kWeight}}, 0.75);
  weight.data()[0] = 8;
  average.update();
  average.update();  // 0 -> 2 -> 3.5
  average.swap();
  EXPECT_DOUBLE_EQ(weight.data()[0], 3.5);
  EXPECT_EQ(average.state()[0].name, "w.ema");
  average.swap();
  EXPECT_DOUBLE_EQ(weight.data()[0], 8);
}

}  // namespace
}  // namespace dcnn
