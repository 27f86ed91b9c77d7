// Progress on stderr: a bar with ETA on a terminal, plain lines elsewhere, nothing with --quiet.
#pragma once

#include <chrono>
#include <string>

namespace dcnn {

class Progress {
 public:
  explicit Progress(bool quiet);
  ~Progress();

  /// `done` in [0, 1]; `text` stands behind the bar. Redraws a few times a second at most.
  void update(double done, const std::string& text);
  /// A line that stays (an epoch's result): on a terminal above the bar.
  void line(const std::string& text);
  /// Removes the bar.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;

  bool quiet_, terminal_, drawn_ = false;
  Clock::time_point start_ = Clock::now(), drawn_at_{};
  double first_done_ = -1.0;  // a resumed run starts in the middle
};

/// "1:05" or "2:03:04".
std::string clock_text(double seconds);

}  // namespace dcnn
