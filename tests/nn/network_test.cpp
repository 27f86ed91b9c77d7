// SPDX-License-Identifier: Apache-2.0
#include "dcnn/nn/network.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cstring>

#include "dcnn/nn/loss.h"
#include "dcnn/nn/optimizer.h"
#include "nn/dcnn_layers.h"

namespace dcnn {
namespace {

Tensor random_batch(Shape shape, std::uint64_t seed) {
  Tensor x(std::move(shape));
  Rng rng(seed);
  for (Real& value : x.values()) value = static_cast<Real>(rng.normal());
  return x;
}

std::vector<Real> all_values(const Network& network) {
  std::vector<Real> values;
  for (const auto& named : network.state()) {
    values.insert(values.end(), named.tensor.values().begin(), named.tensor.values().end());
  }
  return values;
}

/// Everything a network holds after a few steps on batches of 30.
std::vector<Real> train(const std::string& padding, int thread_count) {
  const int before = threads();
  set_threads(thread_count);
  Rng rng(1);
  const Network network(dcnn_layers(padding), {15, 5, 1}, rng);
  Adam adam(network.state(), {});
  for (std::uint64_t step = 0; step < 4; ++step) {
    const Tensor x = random_batch({30, 15, 5, 1}, step), wanted = random_batch({30, 3}, 100 + step);
    Pass pass{.mode = Pass::Mode::kTrain, .rng = Rng({1, step})};
    half_mean_squared_error(network.forward(x, pass), wanted).backward();
    adam.step(1e-3);
  }
  set_threads(before);
  return all_values(network);
}

class Dcnn : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Padding, Dcnn, testing::Values("same", "valid"));

TEST_P(Dcnn, TrainsToTheSameBytesOnOneAndTwoThreads) {
  const auto one = train(GetParam(), 1), two = train(GetParam(), 2);
  ASSERT_EQ(one.size(), two.size());
  EXPECT_EQ(std::memcmp(one.data(), two.data(), one.size() * sizeof(Real)), 0);
}

TEST_P(Dcnn, HasTheParameterCountOfTheSpecification) {
  Rng rng(1);
  const Network network(dcnn_layers(GetParam()), {15, 5, 1}, rng);
  EXPECT_EQ(network.parameter_count(), GetParam() == "same" ? 14155 : 8011);
}

TEST_P(Dcnn, PredictsASampleAloneAsInABatch) {
  Rng rng(1);
  const Network network(dcnn_layers(GetParam(), {8, 5, 35}), {15, 5, 1}, rng);
  const Tensor x = random_batch({29, 15, 5, 1}, 4);
  Pass pass;
  const Tensor all = network.forward(x, pass);
  for (Index n = 0; n < 29; ++n) {
    const Tensor single = Tensor::from({1, 15, 5, 1}, x.values().subspan(n * 75, 75));
    const Tensor y = network.forward(single, pass);
    EXPECT_EQ(std::memcmp(y.data(), all.data() + 3 * n, 3 * sizeof(Real)), 0) << "sample " << n;
  }
}

TEST_P(Dcnn, LearnsALinearTarget) {
  Rng rng(1);
  const Network network(dcnn_layers(GetParam(), {4}), {4, 3, 1}, rng);
  const int before = threads();
  set_threads(1);
  Adam adam(network.state(), {.l2 = 0});
  double first = 0, last = 0;
  const Tensor x = random_batch({40, 4, 3, 1}, 1);
  Tensor wanted({40, 3});
  for (Index i = 0; i < wanted.size(); ++i) wanted.data()[i] = x.data()[i / 3 * 12 + i % 3];
  for (int step = 0; step < 100; ++step) {
    Pass pass{.mode = Pass::Mode::kTrain, .rng = Rng({1, static_cast<std::uint64_t>(step)})};
    const Tensor loss = half_mean_squared_error(network.forward(x, pass), wanted);
    loss.backward();
    adam.step(1e-2);
    (step == 0 ? first : last) = static_cast<double>(loss.data()[0]);
  }
  set_threads(before);
  EXPECT_LT(last, 0.5 * first);
}

/// Output, gradients and statistics of one batch.
std::vector<Real> one_pass(const Network& network, Pass::Mode mode) {
  const Tensor x = Tensor::from({30, 5, 4, 2}, random_batch({30, 5, 4, 2}, 4).values(), true);
  Pass pass{.mode = mode};
  const Tensor y = network.forward(x, pass);
  std::vector<Real> all(y.values().begin(), y.values().end());
  half_mean_squared_error(y, random_batch(y.shape(), 5)).backward();
  all.insert(all.end(), x.gradient().begin(), x.gradient().end());
  for (const auto& named : network.state()) {
    const auto values =
        named.tensor.wants_gradient() ? named.tensor.gradient() : named.tensor.values();
    all.insert(all.end(), values.begin(), values.end());
  }
  return all;
}

TEST(Network, LayersThatTheOneBeforeTakesGiveTheirBits) {
  const Json nothing = {{"kind", "dropout"}, {"rate", 0}};  // none before it takes what is behind
  Json joined = Json::array(), apart = Json::array();
  for (const char* text :
       {R"({"kind": "conv2d", "filters": 3})", R"({"kind": "batch_norm"})", R"({"kind": "relu"})",
        R"({"kind": "batch_norm"})", R"({"kind": "relu"})", R"({"kind": "conv2d", "filters": 16})",
        R"({"kind": "batch_norm"})", R"({"kind": "conv2d", "filters": 5})", R"({"kind": "relu"})",
        R"({"kind": "flatten"})", R"({"kind": "linear", "outputs": 3})"}) {
    joined.push_back(Json::parse(text));
    apart.push_back(joined.back());
    apart.push_back(nothing);
  }
  for (const auto mode : {Pass::Mode::kTrain, Pass::Mode::kCollect, Pass::Mode::kInfer}) {
    Rng rng(3), same(3);
    const auto wanted = one_pass(Network(apart, {5, 4, 2}, rng), mode);
    EXPECT_EQ(one_pass(Network(joined, {5, 4, 2}, same), mode), wanted) << static_cast<int>(mode);
  }
}

std::string refusal(const Json& layers, const Shape& input) {
  try {
    Rng rng(1);
    const Network network(layers, input, rng);
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kUsage);
    return error.what();
  }
  return "";
}

TEST(Network, RefusesUnknownKindsAndKeysWithASuggestion) {
  const Shape input{15, 5, 1};
  EXPECT_NE(refusal({{{"kind", "conv2"}, {"filters", 8}}}, input).find("'conv2d'"),
            std::string::npos);
  EXPECT_NE(refusal({{{"kind", "conv2d"}, {"filter", 8}}}, input).find("filters"),
            std::string::npos);
  EXPECT_NE(refusal({{{"kind", "relu"}, {"slope", 1}}}, input).find("slope"), std::string::npos);
}

TEST(Network, ValidOnTooSmallAnInputNamesSame) {
  EXPECT_NE(refusal(dcnn_layers("valid"), {15, 4, 1}).find("'same'"), std::string::npos);
}

TEST(Network, DropoutDependsOnThePassAlone) {
  Rng rng(1);
  const Network network(Json::parse(R"([{"kind": "dropout", "rate": 0.25}])"), {10000}, rng);
  Tensor x({1, 10000});
  std::ranges::fill(x.values(), Real(1));
  const auto drop = [&](std::uint64_t seed) {
    Pass pass{.mode = Pass::Mode::kTrain, .rng = Rng(seed)};
    const Tensor y = network.forward(x, pass);
    return std::vector<Real>(y.values().begin(), y.values().end());
  };
  EXPECT_EQ(drop(1), drop(1));
  EXPECT_NE(drop(1), drop(2));
  EXPECT_NEAR(static_cast<double>(std::ranges::count(drop(1), Real(0))), 2500, 150);
}

TEST(Network, DropoutDrawsTheSameByEveryInstructionSet) {
  for (const Index width : {1, 2, 7, 33, 64}) {
    Rng rng(1);
    const Network network(Json::parse(R"([{"kind": "dropout", "rate": 0.4}])"), {width}, rng);
    Tensor x({29, width});  // pieces that begin anywhere
    std::ranges::fill(x.values(), Real(1));
    const std::uint64_t key = Rng(6).bits();
    for (const auto target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      Pass pass{.mode = Pass::Mode::kTrain, .rng = Rng(6)};
      const Tensor y = network.forward(x, pass);
      for (Index i = 0; i < y.size(); ++i) {
        const std::uint64_t word = mix_bits(key + static_cast<std::uint64_t>(i / 2));
        const auto drawn = static_cast<std::uint32_t>(i % 2 ? word >> 32 : word);
        const Real wanted =
            drawn < static_cast<std::uint32_t>(0.4 * 0x1p32) ? Real(0) : Real(1 / 0.6);
        ASSERT_EQ(y.data()[i], wanted) << width << ", " << i << ", " << hwy::TargetName(target);
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace
}  // namespace dcnn
