// SPDX-License-Identifier: Apache-2.0
// Progress on stderr: a bar with ETA on a terminal, plain lines elsewhere, nothing with --quiet.
#pragma once

#include <chrono>
#include <string>

#include "support/time_left.h"

namespace dcnn {

class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();

  /// `done` in [0, 1]; `text` stands behind the bar. Redraws a few times a second at most. The time
  /// left is that of the work at hand: where `done` falls back, other work begins.
  void update(double done, const std::string& text);
  /// A line that stays (an epoch's result): on a terminal above the bar.
  void line(const std::string& text);
  /// Other work begins: the time left is measured anew.
  void restart() { left_.restart(); }
  /// Removes the bar.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_, terminal_, drawn_ = false, begun_ = false;
  Clock::time_point drawn_at_{};
  TimeLeft left_;
};

/// "1:05" or "2:03:04".
std::string clock_text(double seconds);

}  // namespace dcnn
