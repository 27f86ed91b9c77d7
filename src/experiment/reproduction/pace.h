// SPDX-License-Identifier: Apache-2.0
// How far a run of several stages is, from the times that were planned and those measured.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace dcnn {

/// The planned times come from another machine: a stage's own measured time scales what is left of
/// it, all measured time what comes after it.
class Pace {
 public:
  /// `planned` [s]: of each stage, as far as it is not finished yet.
  explicit Pace(std::vector<double> planned) : planned_(std::move(planned)) {}

  /// Share of the time of this run that is behind it, `done` of stage `stage` being finished `now`
  /// seconds after its begin; 0 before anything is measured.
  double share(std::size_t stage, double done, double now);

 private:
  std::vector<double> planned_;
  std::size_t stage_ = 0;
  double began_ = 0.0, last_ = 0.0;          // [s]
  double planned_done_ = 0.0, spent_ = 0.0;  // [s] of finished stages: planned and measured
};

}  // namespace dcnn
