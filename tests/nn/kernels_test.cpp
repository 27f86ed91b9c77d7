// SPDX-License-Identifier: Apache-2.0
// Every instruction set this machine has computes the same network.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>
#include <limits>

#include "dcnn/nn/network.h"
#include "dcnn/nn/optimizer.h"

namespace dcnn {
namespace {

struct Size {
  int filters, window_h, window_w;
  Shape input;
};

/// Outputs, gradient of the input and parameters after one Adam step, at the given size of images
/// (all sizes end in a batch norm, a relu and a linear layer).
std::vector<Real> step(const Size& size, Index samples, const std::string& padding) {
  Rng rng(2);
  const Json layers = {{{"kind", "conv2d"},
                        {"filters", size.filters},
                        {"padding", padding},
                        {"window", {size.window_h, size.window_w}}},
                       {{"kind", "batch_norm"}},
                       {{"kind", "relu"}},
                       {{"kind", "flatten"}},
                       {{"kind", "linear"}, {"outputs", 4}}};
  const Network network(layers, size.input, rng);
  Shape shape{samples};
  shape.insert(shape.end(), size.input.begin(), size.input.end());
  Tensor x(shape, true);
  for (Real& value : x.values()) value = static_cast<Real>(rng.normal());
  Pass pass{.mode = Pass::Mode::kTrain};
  const Tensor y = network.forward(x, pass);
  Tensor sum({1});
  record(sum, {y}, [y](const Tensor&) {
    for (Index i = 0; i < y.size(); ++i) y.gradient_data()[i] = y.data()[i];
  }).backward();
  std::vector<Real> all(y.values().begin(), y.values().end());
  all.insert(all.end(), x.gradient().begin(), x.gradient().end());
  for (const auto& named : network.state()) {
    all.insert(all.end(), named.tensor.values().begin(), named.tensor.values().end());
    if (!named.tensor.wants_gradient()) continue;
    all.insert(all.end(), named.tensor.gradient().begin(), named.tensor.gradient().end());
  }
  return all;
}

TEST(Kernels, AllInstructionSetsAgree) {
  std::vector<Size> sizes{{1, 1, 1, {1, 1, 1}},   {8, 2, 2, {15, 5, 1}},
                                {33, 2, 2, {5, 3, 17}}, {70, 3, 1, {4, 2, 5}},
                                {7, 1, 4, {2, 9, 31}},  {48, 3, 3, {3, 3, 16}}};
  if (const char* seed = std::getenv("DCNN_SHAPE_SEED")) {  // tools/fuzz --differential draws others
    Rng rng(std::strtoull(seed, nullptr, 10));
    for (Size& size : sizes) {
      const auto drawn = [&](Index most) { return 1 + static_cast<Index>(rng.uniform() * static_cast<double>(most)); };
      size.input = {drawn(20), drawn(12), drawn(24)};
      size.filters = static_cast<int>(drawn(80));
      size.window_h = static_cast<int>(std::min(drawn(4), size.input[0]));
      size.window_w = static_cast<int>(std::min(drawn(4), size.input[1]));
    }
  }
  std::vector<std::int64_t> targets;
  for (const std::int64_t target : {HWY_EMU128, HWY_SSE4, HWY_AVX2, HWY_AVX3}) {
    if (hwy::SupportedTargets() & target) targets.push_back(target);
  }
  for (const auto& size : sizes) {
    for (const Index samples : {1, 3, 13, 54}) {
      for (const char* padding : {"same", "valid"}) {
        std::vector<Real> first;
        for (const auto target : targets) {
          hwy::SetSupportedTargetsForTest(target);
          const auto now = step(size, samples, padding);
          if (first.empty()) first = now;
          ASSERT_EQ(now.size(), first.size());
          Real largest = 1;
          for (const Real value : first) largest = std::max(largest, std::abs(value));
          for (std::size_t i = 0; i < now.size(); ++i) {
            ASSERT_NEAR(now[i], first[i], 2e-5 * static_cast<double>(largest))
                << hwy::TargetName(target) << ", " << size.filters << " filters, " << samples
                << " samples, " << padding << ", value " << i;
          }
        }
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace
}  // namespace dcnn
