// SPDX-License-Identifier: Apache-2.0
#include "dcnn/nn/batch_plan.h"

#include <gtest/gtest.h>

#include <cmath>

#include "nn/dcnn_layers.h"

namespace dcnn {
namespace {

struct BatchCase {
  const char* name;
  Json layers;
  Shape input;
};

std::vector<BatchCase> batch_cases() {
  const Json ffnn = {{{"kind", "linear"}, {"outputs", 20}},
                     {{"kind", "tanh"}},
                     {{"kind", "linear"}, {"outputs", 3}}};
  const Json growing = {{{"kind", "linear"}, {"outputs", 3}},
                        {{"kind", "relu"}},
                        {{"kind", "linear"}, {"outputs", 37}},
                        {{"kind", "tanh"}},
                        {{"kind", "linear"}, {"outputs", 65}}};
  const Json lstm = {{{"kind", "lstm"}, {"units", 7}}, {{"kind", "linear"}, {"outputs", 3}}};
  return {{"valid", dcnn_layers("valid"), {15, 5, 1}},
          {"same", dcnn_layers("same"), {15, 5, 1}},
          {"ffnn", ffnn, {15}},
          {"growing", growing, {5}},
          {"lstm", lstm, {4, 3}}};
}

Tensor drawn(const Shape& sample, Index n) {
  Shape shape = sample;
  shape.insert(shape.begin(), n);
  Tensor x(shape);
  Rng rng(7);
  for (Real& value : x.values()) value = static_cast<Real>(rng.normal());
  return x;
}

TEST(BatchPlan, GivesWhatTheLayersGiveForEveryNumberOfSamples) {
  for (const BatchCase& what : batch_cases()) {
    Rng rng(5);
    const Network network(what.layers, what.input, rng);
    const BatchPlan batches(network);
    for (const Index n : {1, 2, 31, 33, 129}) {
      const Tensor x = drawn(what.input, n);
      const NoGradient guard;
      Pass pass;
      const Tensor wanted = network.forward(x, pass);
      Tensor found(wanted.shape());
      batches.run(x.data(), n, found.data());
      for (Index i = 0; i < wanted.size(); ++i) {
        ASSERT_NEAR(found.data()[i], wanted.data()[i], 2e-6 * (1 + std::abs(wanted.data()[i])))
            << what.name << " " << n << " " << i;
      }
    }
  }
}

TEST(BatchPlan, ASampleDoesNotDependOnTheOthersNorOnThreads) {
  for (const BatchCase& what : batch_cases()) {
    Rng rng(5);
    const BatchPlan batches(Network(what.layers, what.input, rng));
    const Index n = 200, outputs = 3;
    if (std::string(what.name) == "growing") continue;
    const Tensor x = drawn(what.input, n);
    Tensor one({n, outputs}), two({n, outputs});
    set_threads(1);
    batches.run(x.data(), n, one.data());
    set_threads(2);
    batches.run(x.data(), n, two.data());
    EXPECT_TRUE(std::ranges::equal(one.values(), two.values())) << what.name;
    batches.run(x.data() + x.size() / n * 40, n - 40, two.data());
    EXPECT_TRUE(std::equal(two.data(), two.data() + (n - 40) * outputs, one.data() + 40 * outputs))
        << what.name;
  }
}

TEST(BatchPlan, TanhOfExtremeInputsIsOne) {
  Rng rng(5);
  const Network network(Json{{{"kind", "linear"}, {"outputs", 2}}, {{"kind", "tanh"}}}, {1}, rng);
  const BatchPlan batches(network);
  const Tensor x = Tensor::from({3, 1}, std::vector<Real>{Real(1e30), Real(-1e30), Real(0)});
  Tensor y({3, 2});
  batches.run(x.data(), 3, y.data());
  EXPECT_EQ(std::abs(y.data()[0]), Real(1));
  EXPECT_EQ(y.data()[2], -y.data()[0]);
  EXPECT_EQ(y.data()[4], Real(0));
}

}  // namespace
}  // namespace dcnn
