#include "dcnn/nn/plan.h"

#include <algorithm>
#include <utility>

namespace dcnn {

void Plan::add(std::unique_ptr<PlanStep> step, Index outputs) {
  outputs_ = outputs;
  if (step) steps_.push_back(std::move(step));
  if (steps_.empty() || (from_.defined() && from_.size() >= outputs)) return;
  from_ = Tensor({outputs});
  to_ = Tensor({outputs});
}

/// All steps, the first one by first(step, x, y).
template <class First>
const Real* Plan::run_after(const Real* x, const First& first) noexcept {
  const Real* from = x;
  Real *to = to_.data(), *other = from_.data();
  for (const auto& step : steps_) {
    if (from == x) {
      first(*step, x, to);
    } else {
      step->run(from, to);
    }
    from = to;
    std::swap(to, other);
  }
  return from;
}

const Real* Plan::run(const Real* x) noexcept {
  return run_after(x, [](PlanStep& step, const Real* in, Real* y) { step.run(in, y); });
}

const Real* Plan::slide(const Real* x, bool begins) noexcept {
  return run_after(
      x, [begins](PlanStep& step, const Real* in, Real* y) { step.slide(in, begins, y); });
}

}  // namespace dcnn
