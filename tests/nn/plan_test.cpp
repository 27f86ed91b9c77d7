// SPDX-License-Identifier: Apache-2.0
// A plan computes what its network does, by every instruction set this machine has.
#include "dcnn/nn/plan.h"

#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <algorithm>
#include <cmath>

#include "dcnn/nn/network.h"
#include "nn/dcnn_layers.h"

namespace dcnn {
namespace {

struct PlanCase {
  std::string name;
  Json layers;
  Shape input;
};

std::vector<PlanCase> plan_cases() {
  return {
      {"same", dcnn_layers("same"), {15, 5, 1}},
      {"valid", dcnn_layers("valid"), {15, 5, 1}},
      {"many rows", dcnn_layers("same"), {61, 5, 1}},
      {"few rows, valid", dcnn_layers("valid"), {5, 5, 1}},
      {"one row", dcnn_layers("same"), {1, 5, 1}},
      {"other filters", dcnn_layers("same", {3, 20, 32}), {7, 4, 2}},
      {"no relu",
       {{{"kind", "conv2d"}, {"filters", 8}},
        {{"kind", "flatten"}},
        {{"kind", "linear"}, {"outputs", 70}}},
       {15, 5, 1}},
      {"norm first",
       {{{"kind", "batch_norm"}}, {{"kind", "tanh"}}, {{"kind", "relu"}}, {{"kind", "flatten"}}},
       {3, 2, 4}},
      {"lstm", {{{"kind", "lstm"}, {"units", 37}}, {{"kind", "linear"}, {"outputs", 3}}}, {6, 15}},
      {"lstm of one row", {{{"kind", "lstm"}, {"units", 150}}}, {1, 15}},
      {"lstm of the paper",
       {{{"kind", "lstm"}, {"units", 150}}, {{"kind", "linear"}, {"outputs", 3}}},
       {25, 15}},
      {"lstm of all steps",
       {{{"kind", "lstm"}, {"units", 9}, {"sequence", true}}, {{"kind", "flatten"}}},
       {5, 3}}};
}

/// Statistics that batch norm does not have at the start.
void spread_state(const Network& network, Rng& rng) {
  for (const auto& named : network.state()) {
    const bool positive = named.name.ends_with("running_var");
    for (Real& value : named.tensor.values()) {
      value += static_cast<Real>((positive ? 0.5 : 0.1) * std::abs(rng.normal()));
    }
  }
}

TEST(Plan, ComputesWhatTheNetworkDoesWhateverTheInstructions) {
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  for (const PlanCase& c : plan_cases()) {
    Rng rng(5);
    const Network network(c.layers, c.input, rng);
    spread_state(network, rng);
    Shape shape{1};
    shape.insert(shape.end(), c.input.begin(), c.input.end());
    for (const double size : {1.0, 0.0, 1e-30, 1e4}) {
      Tensor x(shape);
      for (Real& value : x.values()) value = static_cast<Real>(size * rng.normal());
      const NoGradient guard;
      Pass pass;
      hwy::SetSupportedTargetsForTest(0);
      const Tensor wanted = network.forward(x, pass);
      double largest = 1.0;
      for (const Real value : wanted.values()) {
        largest = std::max(largest, std::abs(static_cast<double>(value)));
      }
      for (const auto target : targets) {
        hwy::SetSupportedTargetsForTest(target);
        Plan plan = network.plan();
        ASSERT_EQ(plan.outputs(), wanted.size());
        for (int again = 0; again < 2; ++again) {
          const Real* y = plan.run(x.data());
          for (Index i = 0; i < wanted.size(); ++i) {
            ASSERT_NEAR(y[i], wanted.data()[i], 1e-5 * largest)
                << c.name << ", " << hwy::TargetName(target) << ", size " << size;
          }
        }
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

/// Rows of a stream of which one is not a number, before them one row repeated.
class SlidingWindow {
 public:
  static constexpr Index kWindowInputs = 15;
  SlidingWindow(Index steps, Index rows) : x_({steps + rows, kWindowInputs}) {
    Rng rng(8);
    for (Real& value : x_.values()) value = static_cast<Real>(3 * rng.normal());
    for (Index k = 0; k + 1 < steps; ++k) std::copy_n(row(steps - 1), kWindowInputs, row(k));
    row(steps + 2)[4] = std::nanf("");
  }
  const Real* at(Index k) const { return x_.data() + k * kWindowInputs; }

 private:
  Real* row(Index k) { return x_.data() + k * kWindowInputs; }
  Tensor x_;
};

TEST(Plan, AWindowThatSlidesGivesTheBitsOfTheWindowAlone) {
  for (const Index steps : {1, 2, 6, 25, 60}) {
    Rng rng(7);
    const Network network({{{"kind", "lstm"}, {"units", 37}}, {{"kind", "linear"}, {"outputs", 3}}},
                          {steps, SlidingWindow::kWindowInputs}, rng);
    const Index rows = 2 * steps + 5;
    const SlidingWindow window(steps, rows);
    for (const auto target : hwy::SupportedAndGeneratedTargets()) {
      hwy::SetSupportedTargetsForTest(target);
      Plan plan = network.plan(), alone = network.plan();
      for (int again = 0; again < 2; ++again) {
        for (Index k = 0; k < rows; ++k) {
          const Real *wanted = alone.run(window.at(k)), *y = plan.slide(window.at(k), k == 0);
          if (k >= 3 && k < steps + 3) continue;  // what is not a number is in the window
          for (Index i = 0; i < 3; ++i) {
            ASSERT_TRUE(std::isfinite(y[i])) << steps << " steps, row " << k;
            ASSERT_EQ(y[i], wanted[i]) << steps << " steps, row " << k;
          }
        }
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(Plan, AStateThatIsCarriedGivesTheBitsOfTheWindowSoFar) {
  constexpr Index kWindowInputs = 4, kRows = 30;
  Tensor x({kRows, kWindowInputs});
  Rng draw(9);
  for (Real& value : x.values()) value = static_cast<Real>(2 * draw.normal());
  const auto of_window = [](Index rows) {  // the same weights, whatever the length
    Rng rng(10);
    return Network({{{"kind", "lstm"}, {"units", 19}, {"sequence", true}},
                    {{"kind", "lstm"}, {"units", 37}},
                    {{"kind", "linear"}, {"outputs", 3}}},
                   {rows, kWindowInputs}, rng);
  };
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    hwy::SetSupportedTargetsForTest(target);
    for (const Index length : {Index{1}, kRows}) {  // of the plan's own windows: all the same
      Plan plan = of_window(length).plan();
      for (Index k = 0; k < 2 * kRows; ++k) {
        Plan window = of_window(k % kRows + 1).plan();
        const Real *wanted = window.run(x.data()),
                   *y = plan.carry(x.data() + k % kRows * kWindowInputs, k % kRows == 0);
        for (Index i = 0; i < 3; ++i) ASSERT_EQ(y[i], wanted[i]) << "row " << k;
      }
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

TEST(Plan, ForgetsWhatWasNotFinite) {
  const std::vector<std::int64_t> targets = hwy::SupportedAndGeneratedTargets();
  Rng rng(6);
  const Network network(dcnn_layers("same"), {15, 5, 1}, rng);
  for (const Real bad : {std::nanf(""), HUGE_VALF}) {
    Tensor x({1, 15, 5, 1});
    x.data()[37] = bad;
    for (const auto target : targets) {
      hwy::SetSupportedTargetsForTest(target);
      Plan plan = network.plan();
      plan.run(x.data());
      std::vector<Real> zeros(75, Real(0));
      const Real* clean = plan.run(zeros.data());
      for (Index i = 0; i < 3; ++i) EXPECT_TRUE(std::isfinite(clean[i])) << hwy::TargetName(target);
    }
  }
  hwy::SetSupportedTargetsForTest(0);
}

}  // namespace
}  // namespace dcnn
