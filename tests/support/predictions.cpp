// SPDX-License-Identifier: Apache-2.0
// Predictions of one network for tests/cli/instructions_test.cpp: predictions (valid | same |
// lstm). What predict() does is counted; the first one, which also chooses the instructions, is
// not.
#include <cstring>

#include "dcnn/nn/network.h"
#include "nn/dcnn_layers.h"

namespace {

dcnn::Network network(const std::string& name) {
  dcnn::Rng rng(1);
  if (name != "lstm") return {dcnn::dcnn_layers(name), {15, 5, 1}, rng};
  return {dcnn::Json{{{"kind", "lstm"}, {"units", 150}}, {{"kind", "linear"}, {"outputs", 3}}},
          {25, 15},
          rng};
}

}  // namespace

extern "C" __attribute__((noinline)) float predict(dcnn::Plan& plan, const float* x, bool begins) {
  return *plan.slide(x, begins);
}

int main(int count, char** arguments) {
  if (count != 2) return 2;
  dcnn::Plan plan = network(arguments[1]).plan();
  const dcnn::Tensor x({25 * 15});
  float sum = *plan.slide(x.data(), true);
  for (int k = 0; k < 10; ++k) sum += predict(plan, x.data(), false);
  return sum == sum ? 0 : 1;
}
