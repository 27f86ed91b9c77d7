#include "dcnn/nn/plan.h"

#include <algorithm>
#include <utility>

namespace dcnn {

void Plan::add(std::unique_ptr<PlanStep> step, Index outputs) {
  outputs_ = outputs;
  if (!step) return;
  steps_.push_back(std::move(step));
  if (from_.defined() && from_.size() >= outputs) return;
  from_ = Tensor({outputs});
  to_ = Tensor({outputs});
}

const Real* Plan::run(const Real* x) noexcept {
  const Real* from = x;
  Real *to = to_.data(), *other = from_.data();
  for (const auto& step : steps_) {
    step->run(from, to);
    from = to;
    std::swap(to, other);
  }
  return from;
}

}  // namespace dcnn
