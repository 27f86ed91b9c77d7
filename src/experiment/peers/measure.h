// SPDX-License-Identifier: Apache-2.0
// Turns of several libraries on one network at one number of samples per call.
#pragma once

#include <functional>
#include <vector>

#include "dcnn/core/tensor.h"
#include "dcnn/experiment/peers.h"
#include "dcnn/nn/batch_plan.h"
#include "experiment/peers/cases.h"
#include "experiment/peers/child.h"

namespace dcnn {

double median_of(std::vector<double> values);

/// One library at one network: stretches of calls and single ones.
class Contestant {
 public:
  virtual ~Contestant() = default;
  virtual double run(Index calls) = 0;                ///< seconds of all
  virtual std::vector<double> each(Index calls) = 0;  ///< seconds of each
  /// Seconds of all calls of a network that does nothing, where calls go through a host.
  virtual double overhead(Index /*calls*/) { return 0.0; }
};

/// This library, as a model predicts: one sample through the plan that runs online, several
/// through the plan for batches.
class Ours final : public Contestant {
 public:
  Ours(const PeerCase& what, const Tensor& samples, Index batch, int threads);
  double run(Index calls) override;
  std::vector<double> each(Index calls) override;
  /// Of the first `count` samples.
  std::vector<double> outputs(Index count);

 private:
  const Real* call(Index k);

  Tensor samples_, y_;
  Plan plan_;
  BatchPlan batch_plan_;
  Index batch_, cells_, calls_;
  int threads_;
  Succession succession_;
};

class Theirs final : public Contestant {
 public:
  Theirs(Child& child, bool hosted) : child_(child), hosted_(hosted) {}
  double run(Index calls) override;
  std::vector<double> each(Index calls) override;
  double overhead(Index calls) override;

 private:
  Child& child_;
  bool hosted_;
};

/// Of one contestant: seconds of a call in each round, the same without the overhead of its host,
/// and what single calls add.
struct Turns {
  std::vector<double> calls, net, overhead;
  CallTimes times;
};

/// Stretches of the contestants in turns, then their single calls.
struct Measured {
  std::vector<Turns> contestants;
  double peak = 0.0;
  double loop_tail = 0.0;  ///< PeersRow::loop_tail
};
Measured measure(const std::vector<Contestant*>& contestants, int rounds, int threads);

}  // namespace dcnn
