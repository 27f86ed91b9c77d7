// SPDX-License-Identifier: Apache-2.0
// Every registered layer: its gradient is that of its forward pass.
#include <gtest/gtest.h>

#include "dcnn/nn/layer.h"
#include "dcnn/nn/loss.h"
#include "double/gradient_check.h"

namespace dcnn {
namespace {

struct Case {
  std::string label, kind, options;
  Shape input;
  Pass::Mode mode = Pass::Mode::kTrain;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const LayerKind* kind : layer_kinds()) {
    all.push_back({kind->name, kind->name, kind->example, kind->example_input});
  }
  const std::string same = R"({"filters": 4, "padding": "same"})";
  const std::string valid = R"({"filters": 19, "padding": "valid"})";
  all.push_back({"conv2d_same", "conv2d", same, {5, 4, 3, 2}});
  all.push_back({"conv2d_valid", "conv2d", valid, {5, 4, 3, 2}});
  all.push_back(
      {"conv2d_window_of_three", "conv2d", R"({"filters": 2, "window": [3, 3]})", {14, 4, 2, 3}});
  all.push_back({"batch_norm_of_vectors", "batch_norm", "{}", {7, 6}});
  all.push_back({"batch_norm_of_eight", "batch_norm", "{}", {5, 3, 2, 8}});
  all.push_back({"batch_norm_stored", "batch_norm", "{}", {5, 3, 2, 4}, Pass::Mode::kInfer});
  all.push_back({"linear_of_one_sample", "linear", R"({"outputs": 4})", {1, 9}});
  all.push_back({"lstm_of_one_step", "lstm", R"({"units": 3})", {5, 1, 4}});
  all.push_back({"lstm_sequence", "lstm", R"({"units": 4, "sequence": true})", {3, 5, 2}});
  all.push_back({"lstm_of_many_units", "lstm", R"({"units": 9})", {27, 3, 17}});
  return all;
}

const LayerKind& kind_named(const std::string& name) {
  for (const LayerKind* kind : layer_kinds()) {
    if (kind->name == name) return *kind;
  }
  fail(Exit::kFailure, "no kind ", name);
}

class EveryLayer : public testing::TestWithParam<Case> {};

TEST_P(EveryLayer, GradientMatchesFiniteDifference) {
  const Case& test = GetParam();
  Rng rng(7);
  Options options(parse_json(test.options, "test", Exit::kUsage), "test", Exit::kUsage);
  const LayerPtr layer =
      kind_named(test.kind).make(options, Shape(test.input.begin() + 1, test.input.end()), rng);
  Tensor x(test.input, true);
  fill_random(x, rng);
  std::vector<Tensor> tensors{x};
  for (const auto& named : layer->state()) {
    if (named.role == NamedTensor::Role::kStatistic) continue;
    fill_random(named.tensor, rng);
    tensors.push_back(named.tensor);
  }
  const auto loss = [&] {
    Pass pass{.mode = test.mode, .rng = Rng(3)};
    return weighted_sum(layer->forward(x, pass));
  };
  EXPECT_LT(gradient_error(loss, tensors), 1e-7);
}

TEST_P(EveryLayer, AddsToAGradientThatIsThere) {
  const Case& test = GetParam();
  Rng rng(7);
  Options options(parse_json(test.options, "test", Exit::kUsage), "test", Exit::kUsage);
  const LayerPtr layer =
      kind_named(test.kind).make(options, Shape(test.input.begin() + 1, test.input.end()), rng);
  Tensor x(test.input, true);
  fill_random(x, rng);
  const auto backward = [&] {
    Pass pass{.mode = test.mode, .rng = Rng(3)};
    weighted_sum(layer->forward(x, pass)).backward();
    return std::vector<Real>(x.gradient().begin(), x.gradient().end());
  };
  const auto once = backward(), twice = backward();
  for (std::size_t i = 0; i < once.size(); ++i) EXPECT_NEAR(twice[i], 2 * once[i], 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Layers, EveryLayer, testing::ValuesIn(cases()),
                         [](const auto& test) { return test.param.label; });

TEST(GradientCheck, SaysNoToAWrongGradient) {
  Tensor x({2, 3}, true);
  Rng rng(1);
  fill_random(x, rng);
  const auto square = [&](Real factor) {
    Tensor y(x.shape());
    for (Index i = 0; i < x.size(); ++i) y.data()[i] = x.data()[i] * x.data()[i];
    return weighted_sum(record(y, {x}, [x, factor](const Tensor& out) {
      for (Index i = 0; i < x.size(); ++i) {
        x.gradient_data()[i] += factor * x.data()[i] * out.gradient_data()[i];
      }
    }));
  };
  EXPECT_LT(gradient_error([&] { return square(2); }, {x}), 1e-7);
  EXPECT_GT(gradient_error([&] { return square(Real(2.001)); }, {x}), 1e-5);
}

TEST(Loss, GradientMatchesFiniteDifference) {
  Rng rng(5);
  Tensor predicted({4, 3}, true), wanted({4, 3});
  fill_random(predicted, rng);
  fill_random(wanted, rng);
  const auto loss = [&] { return half_mean_squared_error(predicted, wanted); };
  EXPECT_LT(gradient_error(loss, {predicted}), 1e-7);
}

TEST(Loss, IsHalfTheSquaredErrorPerSample) {
  const std::vector<Real> zero(4), three{3, 0, 4, 1};
  const Tensor loss =
      half_mean_squared_error(Tensor::from({2, 2}, zero), Tensor::from({2, 2}, three));
  EXPECT_DOUBLE_EQ(loss.data()[0], 0.5 * (9 + 16 + 1) / 2);
}

}  // namespace
}  // namespace dcnn
