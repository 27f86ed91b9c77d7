// SPDX-License-Identifier: Apache-2.0
// A network as a fixed list of operations on one sample.
#pragma once

#include <memory>
#include <vector>

#include "dcnn/core/tensor.h"

namespace dcnn {

/// What a plan multiplies in. kInt16: DCNN's convolutions in 16-bit integers, everything else in
/// single precision; docs/results/performance.md has its speed and its error.
enum class Precision { kSingle, kInt16 };

/// One operation with its shapes fixed, its weights packed and its working memory its own.
class PlanStep {
 public:
  virtual ~PlanStep() = default;
  /// y (outputs) of x (inputs), which do not overlap. Allocates, locks and throws nothing.
  virtual void run(const Real* x, Real* y) noexcept = 0;
  /// run() where x is a window (rows, …) that slides over a stream: all rows the same where
  /// `begins`, else the window of the call before without its oldest row and with a new one. A step
  /// that keeps what it computed of the others gives the same bits.
  virtual void slide(const Real* x, bool /*begins*/, Real* y) noexcept { run(x, y); }
  /// run() where x is the next row alone of a stream that the state goes along with: what a window
  /// of all rows since `begins` gives. run() in between disturbs it. A step without state has none
  /// to carry, and must not see windows.
  virtual void carry(const Real* x, bool /*begins*/, Real* y) noexcept { run(x, y); }
  /// y (n, outputs) of x (n, inputs), n up to together() where that is more than one; false where
  /// samples are best taken one by one. What a sample gives does not depend on the others.
  virtual bool run_many(const Real* /*x*/, Index /*n*/, Real* /*y*/) noexcept { return false; }
  /// How many samples it gains by; a network whose steps all say 1 keeps one sample in the cache.
  virtual Index together() const { return 1; }
  /// Takes a ReLU or tanh of its outputs into itself; false where it cannot.
  virtual bool absorb_relu() { return false; }
  virtual bool absorb_tanh() { return false; }
  /// The same of a fully connected layer, weight (outputs, inputs) and bias (outputs).
  virtual bool absorb_linear(const Tensor& /*weight*/, const Tensor& /*bias*/) { return false; }
  /// From now on multiplies in 16-bit integers; false where it cannot.
  virtual bool use_int16() { return false; }
};

/// Made by Network::plan(). Holds copies of the weights.
class Plan {
 public:
  explicit Plan(Index inputs) : inputs_(inputs), outputs_(inputs) {}
  /// The next operation, which makes so many values; null where the layer does nothing.
  void add(std::unique_ptr<PlanStep> step, Index outputs);
  Index outputs() const { return outputs_; }
  /// PlanStep::use_int16() of every step; false where none can.
  bool use_int16();
  /// The network's output for one sample, valid until the next call.
  const Real* run(const Real* x) noexcept;
  /// y (n, outputs) of x (n, inputs): what run() gives for each.
  void run_many(const Real* x, Index n, Real* y) noexcept;
  /// run() for a window that slides (PlanStep::slide()); run() in between does not disturb it.
  const Real* slide(const Real* x, bool begins) noexcept;
  /// The next row of a stream, of which nothing is forgotten (PlanStep::carry()).
  const Real* carry(const Real* x, bool begins) noexcept;

 private:
  void run_together(const Real* x, Index n, Real* y) noexcept;
  template <class Each>
  const Real* run_each(const Real* x, const Each& each) noexcept;

  std::vector<std::unique_ptr<PlanStep>> steps_;
  std::vector<Index> outputs_of_;  // of each step
  Index inputs_, outputs_, together_ = 1;
  Tensor from_, to_;            // each as large as the largest output
  Tensor many_from_, many_to_;  // of together_ samples
};

}  // namespace dcnn
