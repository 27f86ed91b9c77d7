// SPDX-License-Identifier: Apache-2.0
// Plans in 16-bit integers: within their bound of an exact reference, by every instruction set.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

#include "dcnn/nn/batch_plan.h"
#include "nn/dcnn_layers.h"
#include "nn/kernels/pair_convolution.h"

namespace dcnn {
namespace {

/// An image (h, w, channels) in double and, channel by channel, how far that of the integers may be
/// from it.
struct Image {
  Index h, w, channels;
  std::vector<double> values, error;

  double at(Index i, Index j, Index c) const {
    return i < h && j < w ? values[static_cast<std::size_t>((i * w + j) * channels + c)] : 0.0;
  }
  double largest() const {
    double most = 0.0;
    for (const double value : values) most = std::max(most, std::abs(value));
    return most + *std::ranges::max_element(error);
  }
};

/// A 2x2 convolution and its ReLU in double; integers from the second one on.
Image convolved(const Image& x, const Tensor& weight, const Tensor& bias, bool same) {
  const Index lost = same ? 0 : 1, filters = bias.size();
  Image y{x.h - lost, x.w - lost, filters, {}, {}};
  const auto w = [&](Index tap, Index c, Index f) {
    return static_cast<double>(weight.data()[(tap * x.channels + c) * filters + f]);
  };
  for (Index i = 0; i < y.h; ++i) {
    for (Index j = 0; j < y.w; ++j) {
      for (Index f = 0; f < filters; ++f) {
        double sum = static_cast<double>(bias.data()[f]);
        for (Index tap = 0; tap < 4; ++tap) {
          for (Index c = 0; c < x.channels; ++c)
            sum += w(tap, c, f) * x.at(i + tap / 2, j + tap % 2, c);
        }
        y.values.push_back(std::max(0.0, sum));
      }
    }
  }
  const ConvShape shape{x.h, x.w, x.channels, y.h, y.w, filters, 2, 2, 0, 0};
  const auto integers = PairConvolution::make(shape, weight);
  for (Index f = 0; f < filters; ++f) {
    double error = integers ? integers->bound(f, x.largest()) : 0.0;
    for (Index tap = 0; tap < 4; ++tap) {
      for (Index c = 0; c < x.channels; ++c) {
        error += std::abs(w(tap, c, f)) * x.error[static_cast<std::size_t>(c)];
      }
    }
    y.error.push_back(error);
  }
  return y;
}

struct Wanted {
  std::vector<double> y, error;
};

/// Outputs of a folded DCNN in double, and how far integers may be from each.
Wanted reference(const Network& network, const Real* x) {
  const auto& state = network.state();
  Image image{network.input()[0], network.input()[1], 1, {}, {0.0}};
  image.values.assign(x, x + image.h * image.w);
  std::size_t at = 0;
  for (; state[at].tensor.shape().size() == 4; at += 2) {
    const bool same = network.layers()[0].value("padding", "same") == "same";
    image = convolved(image, state[at].tensor, state[at + 1].tensor, same);
  }
  const Tensor &weight = state[at].tensor, &bias = state[at + 1].tensor;
  Wanted wanted;
  for (Index o = 0; o < bias.size(); ++o) {
    double sum = static_cast<double>(bias.data()[o]), error = 0.0;
    for (Index k = 0; k < weight.dim(1); ++k) {
      const auto w = static_cast<double>(weight.data()[o * weight.dim(1) + k]);
      sum += w * image.values[static_cast<std::size_t>(k)];
      error += std::abs(w) * image.error[static_cast<std::size_t>(k % image.channels)];
    }
    wanted.y.push_back(sum);
    wanted.error.push_back(error);
  }
  return wanted;
}

struct PairCase {
  const char* padding;
  Index rows;
  std::uint64_t seed = 3;
};

/// tools/fuzz --differential draws other rows, weights and values.
std::vector<PairCase> pair_cases() {
  std::vector<PairCase> cases{{"valid", 15}, {"same", 15}, {"valid", 5}, {"same", 1}, {"same", 40}};
  if (const char* seed = std::getenv("DCNN_SHAPE_SEED")) {
    Rng rng(std::strtoull(seed, nullptr, 10));
    for (PairCase& c : cases) {
      const Index fewest = c.padding == std::string("valid") ? 5 : 1;  // four windows of two rows
      c.rows = fewest + static_cast<Index>(rng.below(40));
      c.seed = rng.bits();
    }
  }
  return cases;
}

Tensor drawn(Index rows, double size, std::uint64_t seed = 0) {
  Tensor x({rows, 5, 1});
  Rng rng(seed + static_cast<std::uint64_t>(rows));
  for (Real& value : x.values()) value = static_cast<Real>(size * rng.normal());
  return x;
}

/// Weights of one sign for every other filter, so that sums are as large as they can be.
Network network_of(const PairCase& c) {
  Rng rng(c.seed);
  Network network(dcnn_layers(c.padding), {c.rows, 5, 1}, rng);
  for (const auto& named : network.state()) {
    if (named.tensor.shape().size() != 4) continue;
    const Index filters = named.tensor.dim(3);
    for (Index k = 0; k < named.tensor.size(); ++k) {
      Real& value = named.tensor.data()[k];
      if (k % filters % 2 == 0) value = std::abs(value);
    }
  }
  return network.folded();
}

/// Those that this file is compiled for too, and 0: the best of those that the kernels are, which
/// alone is VNNI.
std::vector<std::int64_t> all_targets() {
  auto targets = hwy::SupportedAndGeneratedTargets();
  targets.push_back(0);
  return targets;
}

/// Roundings of hundreds of products hardly ever add up as a bound must assume.
constexpr double kUsual = 1e-3;

TEST(Int16, StaysWithinItsBoundWhateverTheInstructions) {
  for (const PairCase& c : pair_cases()) {
    const Network network = network_of(c);
    for (const double size : {1.0, 0.0, 1e-36, 1e6}) {
      const Tensor x = drawn(c.rows, size, c.seed - 3);
      const Wanted wanted = reference(network, x.data());
      for (const auto target : all_targets()) {
        hwy::SetSupportedTargetsForTest(target);
        Plan plan = network.plan(Precision::kInt16), exact = network.plan();
        const Real *y = plan.run(x.data()), *single = exact.run(x.data());
        bool differs = false;
        double most = 0.0, largest = 0.0;
        for (std::size_t o = 0; o < wanted.y.size(); ++o) {
          const double rounding = 1e-5 * (std::abs(wanted.y[o]) + 1e-3 * size);
          ASSERT_LE(std::abs(static_cast<double>(y[o]) - wanted.y[o]), wanted.error[o] + rounding)
              << c.padding << " " << c.rows << ", " << hwy::TargetName(target) << ", " << size;
          most = std::max(most, std::abs(static_cast<double>(y[o]) - wanted.y[o]));
          largest = std::max(largest, std::abs(wanted.y[o]));
          differs |= y[o] != single[o];
        }
        if (size < 1.0) continue;
        EXPECT_LE(most, kUsual * largest) << c.padding << " " << c.rows;
        EXPECT_EQ(differs, true) << c.padding << " " << c.rows << hwy::TargetName(target);
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(Int16, IntegersAreTheSameForAllInstructionsWithFusedProducts) {
  Rng rng(4);
  const Network network(
      {{{"kind", "conv2d"}, {"filters", 32}, {"padding", "valid"}}, {{"kind", "relu"}}},
      {12, 3, 16}, rng);
  Tensor x({12, 3, 16});
  for (Real& value : x.values()) value = static_cast<Real>(rng.normal());
  std::vector<Real> first;
  for (const auto target : all_targets()) {
    if (target > HWY_AVX2) continue;
    hwy::SetSupportedTargetsForTest(target);
    Plan plan = network.plan(Precision::kInt16);
    const Real* y = plan.run(x.data());
    if (first.empty()) first.assign(y, y + plan.outputs());
    EXPECT_TRUE(std::equal(first.begin(), first.end(), y)) << hwy::TargetName(target);
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(Int16, ASampleIsTheSameAloneAndAmongOthers) {
  const Network network = network_of({"valid", 15});
  const Index n = 100, cells = 75;
  Rng rng(6);
  Tensor x({n, 15, 5, 1}), y({n, 3});
  for (Real& value : x.values()) value = static_cast<Real>(rng.normal());
  BatchPlan(network, Precision::kInt16).run(x.data(), n, y.data());
  Plan plan = network.plan(Precision::kInt16);
  for (Index i = 0; i < n; ++i) {
    const Real* alone = plan.run(x.data() + i * cells);
    ASSERT_TRUE(std::equal(alone, alone + 3, y.data() + i * 3)) << i;
  }
}

TEST(Int16, WhatIsNotFiniteGoesTheWayOfFloats) {
  const Network network = network_of({"valid", 15});
  for (const Real bad : {HUGE_VALF, -HUGE_VALF, std::nanf("")}) {
    Tensor x = drawn(15, 1.0);
    x.data()[37] = bad;
    Plan plan = network.plan(Precision::kInt16), exact = network.plan();
    const Real *y = plan.run(x.data()), *wanted = exact.run(x.data());
    for (Index o = 0; o < 3; ++o) {
      EXPECT_EQ(std::isfinite(y[o]), std::isfinite(wanted[o])) << bad;
    }
    const Tensor clean = drawn(15, 0.0);
    EXPECT_TRUE(std::isfinite(plan.run(clean.data())[0]));
  }
}

TEST(Int16, ANetworkWithoutSuchLayersIsRefused) {
  Rng rng(1);
  const Network network({{{"kind", "linear"}, {"outputs", 3}}}, {15}, rng);
  EXPECT_THROW(network.plan(Precision::kInt16), Error);
  EXPECT_THROW(BatchPlan(network, Precision::kInt16), Error);
}

}  // namespace
}  // namespace dcnn
