// SPDX-License-Identifier: Apache-2.0
// The LSTM against PyTorch's.
#include <gtest/gtest.h>

#include <filesystem>

#include "dcnn/nn/loss.h"
#include "dcnn/nn/network.h"
#include "double/parity.h"

namespace dcnn {
namespace {

/// PyTorch's LSTM with an output at every step. Its weights are (4H, inputs) where ours are
/// (inputs, 4H), the gates in the same order i, f, g, o; its two biases are our one.
class PyTorchLstm : public testing::Test {
 protected:
  static constexpr Index kSteps = 10, kInputs = 15, kUnits = 8, kOutputs = 3;

  void SetUp() override {
    const auto file =
        std::filesystem::path(DCNN_SOURCE_DIR) / "../shared/reference/lstm_h8_T10.json";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not there";
    json_ = read_json(file, Exit::kFailure);
    Rng rng(1);
    const Json lstm = {{{"kind", "lstm"}, {"units", kUnits}, {"sequence", true}}};
    const Json linear = {{{"kind", "linear"}, {"outputs", kOutputs}}};
    lstm_ = std::make_unique<Network>(lstm, Shape{kSteps, kInputs}, rng);
    linear_ = std::make_unique<Network>(linear, Shape{kUnits}, rng);
    const Json& from = json_["params0"];
    set(0, transposed(from["lstm.weight_ih_l0"]));
    set(1, transposed(from["lstm.weight_hh_l0"]));
    Values bias = data(from["lstm.bias_ih_l0"]);
    const Values more = data(from["lstm.bias_hh_l0"]);
    for (std::size_t i = 0; i < bias.size(); ++i) bias[i] += more[i];
    set(2, bias);
    set(3, data(from["fc.weight"]));
    set(4, data(from["fc.bias"]));
    x_ = Tensor::from({8, kSteps, kInputs}, data(json_["input"]));
    target_ = Tensor::from({8 * kSteps, kOutputs}, data(json_["target"]));
  }

  static Values data(const Json& tensor) { return tensor.at("data").get<Values>(); }

  static Values transposed(const Json& tensor) {
    const Values from = data(tensor);
    const auto rows = tensor.at("shape")[0].get<std::size_t>();
    const std::size_t columns = from.size() / rows;
    Values to(from.size());
    for (std::size_t i = 0; i < from.size(); ++i) to[i % columns * rows + i / columns] = from[i];
    return to;
  }

  const NamedTensor& parameter(std::size_t k) const {
    return k < 3 ? lstm_->state()[k] : linear_->state()[k - 3];
  }
  void set(std::size_t k, const Values& values) {
    ASSERT_EQ(values.size(), parameter(k).tensor.values().size());
    std::ranges::copy(values, parameter(k).tensor.data());
  }

  /// The fully connected layer sees every step as a sample of its own.
  Tensor outputs(Pass::Mode mode) {
    Pass pass{.mode = mode};
    return linear_->forward(lstm_->forward(x_, pass).reshaped({8 * kSteps, kUnits}), pass);
  }

  Json json_;
  std::unique_ptr<Network> lstm_, linear_;
  Tensor x_, target_;
};

TEST_F(PyTorchLstm, HasTheSameOutputs) {
  expect_near(outputs(Pass::Mode::kInfer).values(), data(json_["eval_output0"]), 1e-9, "inference");
  const NoGradient guard;
  expect_near(outputs(Pass::Mode::kInfer).values(), data(json_["eval_output0"]), 1e-9, "no trace");
}

TEST_F(PyTorchLstm, HasTheSameGradients) {
  const Tensor loss =
      scaled(half_mean_squared_error(outputs(Pass::Mode::kTrain), target_), Real(2) / 3);
  EXPECT_NEAR(loss.data()[0], json_["loss0"].get<double>(), 1e-9);
  loss.backward();
  const Json& wanted = json_["grads0"];
  const std::vector<Values> gradients{
      transposed(wanted["lstm.weight_ih_l0"]), transposed(wanted["lstm.weight_hh_l0"]),
      data(wanted["lstm.bias_ih_l0"]), data(wanted["fc.weight"]), data(wanted["fc.bias"])};
  for (std::size_t k = 0; k < gradients.size(); ++k) {
    expect_near(parameter(k).tensor.gradient(), gradients[k], 1e-9, parameter(k).name);
  }
}

TEST_F(PyTorchLstm, GivesTheNewestStepOfTheSequence) {
  Rng rng(1);
  const Json layers = {{{"kind", "lstm"}, {"units", kUnits}}};
  const Network newest(layers, {kSteps, kInputs}, rng);
  for (std::size_t k = 0; k < 3; ++k) {
    std::ranges::copy(parameter(k).tensor.values(), newest.state()[k].tensor.data());
  }
  Pass pass;
  const Tensor all = lstm_->forward(x_, pass), last = newest.forward(x_, pass);
  ASSERT_EQ(last.shape(), (Shape{8, kUnits}));
  for (Index i = 0; i < last.size(); ++i) {
    const Index n = i / kUnits, unit = i % kUnits;
    EXPECT_EQ(last.data()[i], all.data()[(n * kSteps + kSteps - 1) * kUnits + unit]);
  }
}

}  // namespace
}  // namespace dcnn
