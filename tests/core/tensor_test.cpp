// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/tensor.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>

namespace dcnn {
namespace {

Tensor doubled(const Tensor& x) {
  Tensor y(x.shape());
  for (Index i = 0; i < x.size(); ++i) y.data()[i] = 2 * x.data()[i];
  return record(y, {x}, [x](const Tensor& out) {
    for (Index i = 0; i < x.size(); ++i) x.gradient_data()[i] += 2 * out.gradient_data()[i];
  });
}

Tensor sum(const Tensor& a, const Tensor& b) {
  Tensor y(a.shape());
  for (Index i = 0; i < a.size(); ++i) y.data()[i] = a.data()[i] + b.data()[i];
  return record(y, {a, b}, [a, b](const Tensor& out) {
    for (Index i = 0; i < a.size(); ++i) {
      a.gradient_data()[i] += out.gradient_data()[i];
      b.gradient_data()[i] += out.gradient_data()[i];
    }
  });
}

TEST(Tensor, StartsAtZeroAndIsAligned) {
  const Tensor x({3, 5});
  for (const Real value : x.values()) EXPECT_EQ(value, 0);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(x.data()) % 64, 0U);
  EXPECT_EQ(x.dim(-1), 5);
  EXPECT_EQ(to_string(x.shape()), "(3, 5)");
}

TEST(Tensor, AddsTheGradientsOfAllPaths) {
  const Tensor x({1}, true);
  const Tensor y = doubled(x);
  sum(doubled(y), sum(x, y)).backward();  // 4x + x + 2x
  EXPECT_EQ(x.gradient()[0], 7);
}

TEST(Tensor, GradientsFlowThroughReshaping) {
  const Tensor x({1}, true);
  const Tensor y = doubled(x);
  sum(y.reshaped({1, 1}), y).backward();
  EXPECT_EQ(x.gradient()[0], 4);
}

TEST(Tensor, SurvivesAGraphDeeperThanTheStack) {
  const Tensor x({1}, true);
  for (const bool differentiate : {true, false}) {
    Tensor y = x;
    for (int i = 0; i < 200000; ++i) y = sum(y, x);
    if (differentiate) y.backward();
  }
  EXPECT_EQ(x.gradient()[0], 200001);
}

TEST(Tensor, BackwardFreesTheRecord) {
  const auto witness = std::make_shared<int>(1);
  const Tensor x({1}, true);
  const Tensor y = record(Tensor({1}), {x}, [witness](const Tensor&) {});
  EXPECT_EQ(witness.use_count(), 2);
  y.backward();
  EXPECT_EQ(witness.use_count(), 1);
}

TEST(Tensor, RecordsNothingWhileNoGradientIsAlive) {
  const Tensor x({1}, true);
  const NoGradient guard;
  EXPECT_FALSE(doubled(x).wants_gradient());
}

}  // namespace
}  // namespace dcnn
