// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <cstring>

#include "dcnn/nn/loss.h"
#include "dcnn/nn/network.h"
#include "dcnn/nn/optimizer.h"

namespace dcnn {
namespace {

constexpr Index kSteps = 6, kInputs = 15;

Network make_network(Index units, Index outputs = 3) {
  Rng rng(1);
  return Network(Json{{{"kind", "lstm"}, {"units", units}},
                      {{"kind", "dropout"}, {"rate", 0.2}},
                      {{"kind", "linear"}, {"outputs", outputs}}},
                 {kSteps, kInputs}, rng);
}

Tensor random_tensor(Shape shape, std::uint64_t seed, double scale = 1.0) {
  Tensor x(std::move(shape));
  Rng rng(seed);
  for (Real& value : x.values()) value = static_cast<Real>(scale * rng.normal());
  return x;
}

/// Everything the network holds after some clipped steps.
std::vector<Real> train(int thread_count) {
  const int before = threads();
  set_threads(thread_count);
  const Network network = make_network(21);
  Adam adam(network.state(), {.clip = 0.1});
  for (std::uint64_t step = 0; step < 3; ++step) {
    Pass pass{.mode = Pass::Mode::kTrain, .rng = Rng({1, step})};
    const Tensor x = random_tensor({101, kSteps, kInputs}, step);
    half_mean_squared_error(network.forward(x, pass), random_tensor({101, 3}, 50 + step))
        .backward();
    adam.step(1e-2);
  }
  set_threads(before);
  std::vector<Real> values;
  for (const auto& named : network.state()) {
    values.insert(values.end(), named.tensor.values().begin(), named.tensor.values().end());
  }
  return values;
}

TEST(Lstm, TrainsToTheSameBytesOnOneAndTwoThreads) {
  const auto one = train(1), two = train(2);
  EXPECT_EQ(std::memcmp(one.data(), two.data(), one.size() * sizeof(Real)), 0);
}

TEST(Lstm, ASampleDoesNotDependOnItsNeighboursOrOnBeingRecorded) {
  for (const Index units : {1, 7, 33, 150}) {
    const Network network = make_network(units);
    const Tensor x = random_tensor({107, kSteps, kInputs}, 4);
    Pass pass;
    const Tensor all = network.forward(x, pass);
    const NoGradient guard;
    for (Index n = 0; n < 107; n += 7) {
      constexpr Index kCells = kSteps * kInputs;
      const Tensor single =
          Tensor::from({1, kSteps, kInputs}, x.values().subspan(n * kCells, kCells));
      const Tensor y = network.forward(single, pass);
      EXPECT_EQ(std::memcmp(y.data(), all.data() + 3 * n, 3 * sizeof(Real)), 0)
          << units << " units, sample " << n;
    }
  }
}

TEST(Lstm, AllInstructionSetsAgree) {
  std::vector<Real> wanted;
  for (const std::int64_t target : {HWY_EMU128, HWY_SSE4, HWY_AVX2, HWY_AVX3}) {
    if (!(hwy::SupportedTargets() & target)) continue;
    hwy::SetSupportedTargetsForTest(target);
    const Network network = make_network(21);
    Pass pass{.mode = Pass::Mode::kTrain};
    half_mean_squared_error(network.forward(random_tensor({29, kSteps, kInputs}, 1), pass),
                            random_tensor({29, 3}, 2))
        .backward();
    std::vector<Real> gradients;
    for (const auto& named : network.state()) {
      const auto values = named.tensor.gradient();
      gradients.insert(gradients.end(), values.begin(), values.end());
    }
    if (wanted.empty()) wanted = gradients;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      EXPECT_NEAR(gradients[i], wanted[i], 1e-5 * std::max<Real>(1, std::abs(wanted[i])));
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(Lstm, StartsOrthonormalWithAnOpenForgetGate) {
  const Network network = make_network(12);
  EXPECT_EQ(network.state()[1].name, "0.lstm.recurrent_weight");
  const Tensor& weight = network.state()[1].tensor;
  for (Index a = 0; a < 12; ++a) {
    for (Index b = 0; b < 12; ++b) {
      double product = 0.0;
      for (Index k = 0; k < 48; ++k) {
        product += static_cast<double>(weight.data()[a * 48 + k] * weight.data()[b * 48 + k]);
      }
      EXPECT_NEAR(product, a == b ? 1.0 : 0.0, 1e-6);
    }
  }
  const Real* bias = network.state()[2].tensor.data();
  for (Index k = 0; k < 48; ++k) EXPECT_EQ(bias[k], k / 12 == 1 ? Real(1) : Real(0)) << k;
}

TEST(Lstm, HasTheParameterCountOfTheSpecification) {
  EXPECT_EQ(make_network(150).parameter_count(), 100053);
}

TEST(Lstm, SaturatedGatesStayFinite) {
  const Network network = make_network(9);
  Pass pass{.mode = Pass::Mode::kTrain};
  const Tensor x = random_tensor({20, kSteps, kInputs}, 3, 1e6);
  half_mean_squared_error(network.forward(x, pass), random_tensor({20, 3}, 2)).backward();
  for (const auto& named : network.state()) {
    for (const Real value : named.tensor.gradient()) EXPECT_TRUE(std::isfinite(value));
  }
}

TEST(Lstm, RefusesAnImageAndTooManyUnits) {
  Rng rng(1);
  const Json layers = {{{"kind", "lstm"}, {"units", 4}}};
  EXPECT_THROW(Network(layers, {15, 5, 1}, rng), Error);
  EXPECT_THROW(Network(Json{{{"kind", "lstm"}, {"units", 100000}}}, {5, 3}, rng), Error);
}

/// A gradient of (3, 4) and of (0, 0.5) on two parameters.
std::vector<Real> clipped_step(double clip, double l2) {
  const Tensor a({2}, true), b({2}, true);
  b.data()[0] = 2;
  Adam adam({{"a", a, NamedTensor::Role::kWeight}, {"b", b, NamedTensor::Role::kWeight}},
            {.beta1 = 0.5, .l2 = l2, .clip = clip});
  a.gradient_data()[0] = 3;
  a.gradient_data()[1] = 4;
  b.gradient_data()[1] = Real(0.5);
  adam.step(0.0);
  std::vector<Real> halves;  // the first moments: half of what Adam was given
  for (const auto& moment : {adam.state()[0], adam.state()[2]}) {
    halves.insert(halves.end(), moment.tensor.values().begin(), moment.tensor.values().end());
  }
  return halves;
}

TEST(Adam, ClipsEachTensorByItsOwnNorm) {
  const std::vector<Real> wanted{Real(0.3), Real(0.4), 0, Real(0.25)};
  const auto got = clipped_step(1, 0);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(got[i], wanted[i], 1e-7) << i;
  EXPECT_EQ(clipped_step(0, 0), (std::vector<Real>{1.5, 2, 0, 0.25}));
  EXPECT_EQ(clipped_step(5, 0), clipped_step(0, 0));
  EXPECT_NEAR(clipped_step(1, 0.25)[2], 0.25, 1e-7) << "L2 is not clipped";
}

}  // namespace
}  // namespace dcnn
