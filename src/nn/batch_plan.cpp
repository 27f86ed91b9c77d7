#include "dcnn/nn/batch_plan.h"

#include <algorithm>

namespace dcnn {
namespace {

constexpr Index kShare =
    32;  // samples of a piece at least: threads for less cost more than they gain

bool has_lstm(const Network& network) {
  return std::any_of(network.layers().begin(), network.layers().end(),
                     [](const Json& layer) { return layer.at("kind") == Json("lstm"); });
}

}  // namespace

BatchPlan::BatchPlan(const Network& network)
    : network_(network.folded()),
      cells_(element_count(network.input())),
      outputs_(element_count(network.shapes().back())),
      by_layers_(has_lstm(network)) {}

void BatchPlan::run(const Real* x, Index n, Real* y) const {
  if (by_layers_ && n > 1) return run_layers(x, n, y);
  const Index pieces = std::clamp<Index>(n / kShare, 1, threads());
  if (pieces == 1) return run_plan(x, n, y);
  for_each_piece(pieces, [&](Index k) {
    const Index begin = piece_begin(n, pieces, k), end = piece_begin(n, pieces, k + 1);
    run_plan(x + begin * cells_, end - begin, y + begin * outputs_);
  });
}

void BatchPlan::run_layers(const Real* x, Index n, Real* y) const {
  constexpr Index kBlock = 520;  // 40 pieces of 13: activations stay in the cache
  const NoGradient guard;
  for (Index first = 0; first < n; first += kBlock) {
    const Index rows = std::min(kBlock, n - first);
    Shape shape = network_.input();
    shape.insert(shape.begin(), rows);
    const Tensor block = Tensor::from(
        std::move(shape), {x + first * cells_, static_cast<std::size_t>(rows * cells_)});
    Pass pass;
    y = std::ranges::copy(network_.forward(block, pass).values(), y).out;
  }
}

void BatchPlan::run_plan(const Real* x, Index n, Real* y) const {
  auto plan = take();
  if (n == 1 || !plan->run_many(x, n, y)) {
    for (Index i = 0; i < n; ++i) {
      std::copy_n(plan->run(x + i * cells_), outputs_, y + i * outputs_);
    }
  }
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
  return std::make_unique<Plan>(network_.plan());
}

void BatchPlan::give_back(std::unique_ptr<Plan> plan) const {
  const std::scoped_lock lock(mutex_);
  idle_.push_back(std::move(plan));
}

}  // namespace dcnn
