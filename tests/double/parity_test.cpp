// SPDX-License-Identifier: Apache-2.0
// The network against two independent programs: a scalar one of this repository, and PyTorch.
#include "double/parity.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>

#include "dcnn/nn/loss.h"
#include "dcnn/nn/network.h"
#include "dcnn/nn/optimizer.h"

namespace dcnn {
namespace {

Json layers(const std::string& padding, const std::vector<int>& filters, int outputs) {
  Json list = Json::array();
  for (const int count : filters) {
    list.push_back({{"kind", "conv2d"}, {"filters", count}, {"padding", padding}});
    list.push_back({{"kind", "batch_norm"}});
    list.push_back({{"kind", "relu"}});
  }
  list.push_back({{"kind", "flatten"}});
  list.push_back({{"kind", "linear"}, {"outputs", outputs}});
  return list;
}

std::vector<NamedTensor> trained(const Network& network) {
  auto state = network.state();
  std::erase_if(state, [](const auto& t) { return t.role == NamedTensor::Role::kStatistic; });
  return state;
}

class SmallDcnn : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Padding, SmallDcnn, testing::Values("same", "valid"));

TEST_P(SmallDcnn, AgreesWithTheScalarReference) {
  const Json all = read_json(DCNN_SOURCE_DIR "/tests/reference/dcnn_small.json", Exit::kFailure);
  const Json& wanted = all.at(GetParam());
  Rng rng(1);
  const Network network(layers(GetParam(), {2, 3}, 2), {4, 3, 1}, rng);
  const auto parameters = trained(network);
  ASSERT_EQ(parameters.size(), wanted["params0"].size());
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    std::ranges::copy(wanted["params0"][i].get<Values>(), parameters[i].tensor.data());
  }
  const Tensor x = Tensor::from({4, 4, 3, 1}, wanted["input"].get<Values>());
  const Tensor target = Tensor::from({4, 2}, wanted["target"].get<Values>());
  Adam adam(network.state(), {.l2 = 1e-4});
  for (int step = 0; step < 3; ++step) {
    Pass pass{.mode = Pass::Mode::kTrain};
    const Tensor y = network.forward(x, pass), loss = half_mean_squared_error(y, target);
    loss.backward();
    if (step == 0) {
      expect_near(y.values(), wanted["outputs0"].get<Values>(), 1e-12, "outputs");
      EXPECT_NEAR(loss.data()[0], wanted["loss0"].get<double>(), 1e-12);
      for (std::size_t i = 0; i < parameters.size(); ++i) {
        expect_near(parameters[i].tensor.gradient(), wanted["gradients0"][i].get<Values>(), 1e-11,
                    parameters[i].name);
      }
    }
    adam.step(1e-2);
  }
  for (std::size_t i = 0; i < parameters.size(); ++i) {
    // Behind batch norm a bias has no gradient but rounding noise, which Adam divides by itself.
    const bool noise = parameters[i].name.find("conv2d.bias") != std::string::npos;
    expect_near(parameters[i].tensor.values(), wanted["params3"][i].get<Values>(),
                noise ? 1e-6 : 1e-9, parameters[i].name);
  }
}

/// PyTorch's DCNN in this project's names and layouts.
class PyTorchDcnn : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(folder_)) GTEST_SKIP() << folder_ << " is not there";
    json_ = read_json(folder_ / "dcnn_valid.json", Exit::kFailure);
    Rng rng(1);
    network_ = std::make_unique<Network>(layers("valid", {8, 16, 32, 32}, 3), Shape{15, 5, 1}, rng);
    set("params0");
    set("buffers0");
    x_ = Tensor::from({8, 15, 5, 1}, data(json_["input"]));
    target_ = Tensor::from({8, 3}, data(json_["target"]));
  }

  static Values data(const Json& tensor) { return tensor.at("data").get<Values>(); }

  /// "4.batch_norm.gamma" is "bn.1.weight"; empty where PyTorch's list has something else.
  static std::string torch_name(const std::string& name) {
    const int index = std::stoi(name);
    const std::string tensor = name.substr(name.rfind('.') + 1);
    if (name.find("linear") != std::string::npos) return "fc." + tensor;
    const std::string block = std::to_string(index / 3) + ".";
    if (name.find("conv2d") != std::string::npos) return "conv." + block + tensor;
    return "bn." + block + (tensor == "gamma" ? "weight" : tensor == "beta" ? "bias" : tensor);
  }

  /// Values of PyTorch's tensor in our order: (out,in,kh,kw) to (kh,kw,in,out), fc from (c,h) to
  /// (h,c).
  static Values reordered(const std::string& name, const Json& tensor) {
    const Values from = data(tensor);
    const auto shape = tensor.at("shape").get<std::vector<std::size_t>>();
    Values to(from.size());
    if (shape.size() == 4) {
      const std::size_t outs = shape[0], ins = shape[1], taps = shape[2] * shape[3];
      for (std::size_t i = 0; i < from.size(); ++i) {
        const std::size_t tap = i % taps, in = i / taps % ins, out = i / taps / ins;
        to[(tap * ins + in) * outs + out] = from[i];
      }
      return to;
    }
    if (name != "fc.weight") return from;
    const std::size_t channels = 32, rows = 11;
    for (std::size_t i = 0; i < from.size(); ++i) {
      const std::size_t row = i % rows, channel = i / rows % channels, out = i / rows / channels;
      to[(out * rows + row) * channels + channel] = from[i];
    }
    return to;
  }

  template <class Work>
  void for_each_in(const std::string& list, const Work& work) {
    std::size_t used = 0;
    for (const auto& named : network_->state()) {
      const std::string name = torch_name(named.name);
      if (!json_[list].contains(name)) continue;
      ++used;
      work(named, reordered(name, json_[list][name]));
    }
    EXPECT_GE(used, 8U) << list;
  }

  void set(const std::string& list) {
    for_each_in(list, [](const NamedTensor& named, const Values& values) {
      std::ranges::copy(values, named.tensor.data());
    });
  }
  void expect_parameters(const std::string& list) {
    for_each_in(list, [](const NamedTensor& named, const Values& values) {
      expect_near(named.tensor.values(), values, 1e-8, named.name);
    });
  }

  Tensor train_loss() {
    Pass pass{.mode = Pass::Mode::kTrain};
    return scaled(half_mean_squared_error(network_->forward(x_, pass), target_), Real(2) / 3);
  }
  Values predict(Pass::Mode mode) {
    Pass pass{.mode = mode};
    const Tensor y = network_->forward(x_, pass);
    return {y.values().begin(), y.values().end()};
  }

  std::filesystem::path folder_ = std::filesystem::path(DCNN_SOURCE_DIR) / "../shared/reference";
  Json json_;
  std::unique_ptr<Network> network_;
  Tensor x_, target_;
};

TEST_F(PyTorchDcnn, HasTheSameOutputs) {
  expect_near(predict(Pass::Mode::kInfer), data(json_["eval_output0"]), 1e-12, "inference");
  expect_near(predict(Pass::Mode::kTrain), data(json_["train_output0"]), 1e-12, "training");
}

TEST_F(PyTorchDcnn, HasTheSameGradients) {
  const Tensor loss = train_loss();
  EXPECT_NEAR(loss.data()[0], json_["loss0"].get<double>(), 1e-12);
  loss.backward();
  for_each_in("grads0", [](const NamedTensor& named, const Values& values) {
    expect_near(named.tensor.gradient(), values, 1e-9, named.name);
  });
}

TEST_F(PyTorchDcnn, TakesTheSameAdamSteps) {
  Adam adam(network_->state(), {.l2 = 0});
  for (int step = 0; step < 3; ++step) {
    const Tensor loss = train_loss();
    EXPECT_NEAR(loss.data()[0], json_["losses"][static_cast<std::size_t>(step)].get<double>(),
                1e-9);
    loss.backward();
    adam.step(1e-3);
    if (step == 0) expect_parameters("params_after1");
  }
  expect_parameters("params_after3");
  expect_parameters("buffers_after3");
  expect_near(predict(Pass::Mode::kInfer), data(json_["eval_output_after3"]), 1e-8, "inference");
}

TEST_F(PyTorchDcnn, HasTheSameActivations) {
  const Json acts = read_json(folder_ / "dcnn_valid_activations.json", Exit::kFailure).at("acts");
  const Json all = layers("valid", {8, 16, 32, 32}, 3);
  for (std::size_t k = 0; k < 12; ++k) {
    Json some = Json::array();
    for (std::size_t i = 0; i <= k; ++i) some.push_back(all[i]);
    Rng rng(1);
    const Network part(some, {15, 5, 1}, rng);
    for (std::size_t i = 0; i < part.state().size(); ++i) {
      std::ranges::copy(network_->state()[i].tensor.values(), part.state()[i].tensor.data());
    }
    Pass pass{.mode = Pass::Mode::kTrain};
    const Tensor y = part.forward(x_, pass);
    const Values wanted = data(acts[k]);  // (N, C, H, W)
    ASSERT_EQ(wanted.size(), y.values().size());
    const Index channels = y.dim(3), places = y.dim(1) * y.dim(2);
    for (Index i = 0; i < y.size(); ++i) {
      const Index c = i % channels, place = i / channels % places, n = i / channels / places;
      EXPECT_NEAR(y.data()[i],
                  wanted[static_cast<std::size_t>((n * channels + c) * places + place)], 1e-12);
    }
  }
}

}  // namespace
}  // namespace dcnn
