// SPDX-License-Identifier: Apache-2.0
#include "dcnn/nn/plan.h"

#include <algorithm>
#include <utility>

namespace dcnn {

void Plan::add(std::unique_ptr<PlanStep> step, Index outputs) {
  outputs_ = outputs;
  if (step) {
    together_ = std::max(together_, step->together());
    steps_.push_back(std::move(step));
    outputs_of_.push_back(outputs);
  }
  if (steps_.empty()) return;
  outputs_of_.back() = outputs;  // of a layer that the step before has taken into itself
  const auto enlarge = [](Tensor& memory, Index size) {
    if (!memory.defined() || memory.size() < size) memory = Tensor({size});
  };
  const Index most = *std::ranges::max_element(outputs_of_);
  for (Tensor* memory : {&from_, &to_}) enlarge(*memory, most);
  if (together_ == 1) return;
  for (Tensor* memory : {&many_from_, &many_to_}) enlarge(*memory, together_ * most);
}

bool Plan::use_int16() {
  bool any = false;
  for (const auto& step : steps_) any = step->use_int16() || any;
  return any;
}

/// All steps by each(step, x, y, whether it is the first).
template <class Each>
const Real* Plan::run_each(const Real* x, const Each& each) noexcept {
  const Real* from = x;
  Real *to = to_.data(), *other = from_.data();
  for (const auto& step : steps_) {
    each(*step, from, to, from == x);
    from = to;
    std::swap(to, other);
  }
  return from;
}

const Real* Plan::run(const Real* x) noexcept {
  return run_each(x, [](PlanStep& step, const Real* in, Real* y, bool) { step.run(in, y); });
}

void Plan::run_many(const Real* x, Index n, Real* y) noexcept {
  if (together_ > 1) {
    for (Index first = 0; first < n; first += together_) {
      run_together(x + first * inputs_, std::min(together_, n - first), y + first * outputs_);
    }
    return;
  }
  if (steps_.size() == 1 && steps_.front()->run_many(x, n, y)) return;
  for (Index i = 0; i < n; ++i) {
    std::copy_n(run(x + i * inputs_), outputs_, y + i * outputs_);
  }
}

/// At most together_ samples, step by step.
void Plan::run_together(const Real* x, Index n, Real* y) noexcept {
  const Real* from = x;
  Real *to = many_to_.data(), *other = many_from_.data();
  Index inputs = inputs_;
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    if (k + 1 == steps_.size()) to = y;
    if (!steps_[k]->run_many(from, n, to)) {
      for (Index i = 0; i < n; ++i) steps_[k]->run(from + i * inputs, to + i * outputs_of_[k]);
    }
    from = to;
    inputs = outputs_of_[k];
    std::swap(to, other);
  }
}

const Real* Plan::slide(const Real* x, bool begins) noexcept {
  return run_each(x, [begins](PlanStep& step, const Real* in, Real* y, bool first) {
    first ? step.slide(in, begins, y) : step.run(in, y);
  });
}

const Real* Plan::carry(const Real* x, bool begins) noexcept {
  return run_each(
      x, [begins](PlanStep& step, const Real* in, Real* y, bool) { step.carry(in, begins, y); });
}

}  // namespace dcnn
