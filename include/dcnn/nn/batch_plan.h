// SPDX-License-Identifier: Apache-2.0
// A network at inference for many samples at once.
#pragma once

#include <memory>
#include <mutex>
#include <vector>

#include "dcnn/nn/network.h"

namespace dcnn {

/// Samples are shared among the threads, each with a plan of its own (Plan::run_many()); what one
/// sample gives does not depend on the others.
class BatchPlan {
 public:
  explicit BatchPlan(const Network& network, Precision precision = Precision::kSingle);
  /// y (n, outputs) of x (n, input…). May be called by several threads.
  void run(const Real* x, Index n, Real* y) const;

 private:
  void run_plan(const Real* x, Index n, Real* y) const;
  std::unique_ptr<Plan> take() const;
  void give_back(std::unique_ptr<Plan> plan) const;

  Network network_;  // folded
  Index cells_, outputs_;
  Precision precision_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<Plan>> idle_;  // a plan is one thread's at a time
};

}  // namespace dcnn
