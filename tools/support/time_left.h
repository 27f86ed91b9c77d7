// SPDX-License-Identifier: Apache-2.0
// The time that work still needs, from the share that is done and the time it took.
#pragma once

#include <optional>

namespace dcnn {

/// The time left is (1 - done)/rate, with the mean rate since the first update. A new piece of work
/// begins where the share falls back, or with restart(); the share need not begin at 0 (a resumed
/// run starts in the middle).
class TimeLeft {
 public:
  void restart() { begun_ = false; }

  /// Seconds left at `done` in [0, 1] and `now` [s]; nothing where they would be a guess.
  std::optional<double> update(double done, double now) {
    // Before so much is done, or so much time has passed, the rate is not known.
    constexpr double kLeastShare = 0.02, kLeastSeconds = 10.0;
    if (!begun_ || done < last_) {
      begun_ = true;
      first_ = done;
      start_ = now;
    }
    last_ = done;
    const double gained = done - first_, run = now - start_;
    if (gained <= 0.0 || (gained <= kLeastShare && run <= kLeastSeconds)) return std::nullopt;
    return run * (1.0 - done) / gained;
  }

 private:
  bool begun_ = false;
  double first_ = 0.0, last_ = 0.0, start_ = 0.0;
};

}  // namespace dcnn
