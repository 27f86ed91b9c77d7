// SPDX-License-Identifier: Apache-2.0
#include "dcnn/nn/batch_plan.h"

#include <algorithm>

namespace dcnn {
namespace {

constexpr Index kShare =
    32;  // samples of a piece at least: threads for less cost more than they gain

}  // namespace

BatchPlan::BatchPlan(const Network& network, Precision precision)
    : network_(network.folded()),
      cells_(element_count(network.input())),
      outputs_(element_count(network.shapes().back())),
      precision_(precision) {
  give_back(take());  // what cannot be is refused now
}

void BatchPlan::run(const Real* x, Index n, Real* y) const {
  const Index pieces = std::clamp<Index>(n / kShare, 1, threads());
  if (pieces == 1) return run_plan(x, n, y);
  for_each_piece(pieces, [&](Index k) {
    const Index begin = piece_begin(n, pieces, k), end = piece_begin(n, pieces, k + 1);
    run_plan(x + begin * cells_, end - begin, y + begin * outputs_);
  });
}

void BatchPlan::run_plan(const Real* x, Index n, Real* y) const {
  auto plan = take();
  plan->run_many(x, n, y);
  give_back(std::move(plan));
}

std::unique_ptr<Plan> BatchPlan::take() const {
  {
    const std::scoped_lock lock(mutex_);
    if (!idle_.empty()) {
      auto plan = std::move(idle_.back());
      idle_.pop_back();
      return plan;
    }
  }
  return std::make_unique<Plan>(network_.plan(precision_));
}

void BatchPlan::give_back(std::unique_ptr<Plan> plan) const {
  const std::scoped_lock lock(mutex_);
  idle_.push_back(std::move(plan));
}

}  // namespace dcnn
