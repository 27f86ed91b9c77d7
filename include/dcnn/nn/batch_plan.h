// A network at inference for many samples at once.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "dcnn/nn/network.h"

namespace dcnn {

/// Samples are shared among the threads; what one gives does not depend on the others. Networks
/// without an LSTM are cut into samples, each through a plan that keeps it in the nearest cache; an
/// LSTM goes layer by layer, so that its weights are read once for many samples.
class BatchPlan {
 public:
  explicit BatchPlan(const Network& network);
  /// y (n, outputs) of x (n, input…). May be called by several threads.
  void run(const Real* x, Index n, Real* y) const;

 private:
  void run_layers(const Real* x, Index n, Real* y) const;
  void run_plan(const Real* x, Index n, Real* y) const;
  std::unique_ptr<Plan> take() const;
  void give_back(std::unique_ptr<Plan> plan) const;

  Network network_;  // folded
  Index cells_, outputs_;
  bool by_layers_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Plan>> idle_;  // a plan is one thread's at a time
};

}  // namespace dcnn
