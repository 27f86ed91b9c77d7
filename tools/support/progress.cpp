// SPDX-License-Identifier: Apache-2.0
#include "support/progress.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iostream>

namespace dcnn {
namespace {

constexpr double kRedrawSeconds = 0.1;
constexpr double kPlainSeconds = 10.0;  // a log file is no place for a bar
constexpr int kBarWidth = 24;

bool plain_terminal() {
  const char* term = std::getenv("TERM");
  return term == nullptr || std::string(term) == "dumb";
}

}  // namespace

std::string clock_text(double seconds) {
  const auto s = static_cast<long>(std::lround(std::max(0.0, seconds)));
  char text[48];
  if (s >= 3600) {
    std::snprintf(text, sizeof text, "%ld:%02ld:%02ld", s / 3600, s / 60 % 60, s % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld:%02ld", s / 60, s % 60);
  }
  return text;
}

Progress::Progress(bool quiet)
    : quiet_(quiet), terminal_(!quiet && ::isatty(STDERR_FILENO) && !plain_terminal()) {}

Progress::~Progress() { clear(); }

void Progress::update(double done, const std::string& text) {
  if (quiet_) return;
  const auto now = Clock::now();
  const auto left =
      left_.update(done, std::chrono::duration<double>(now.time_since_epoch()).count());
  if (!begun_ && !terminal_) drawn_at_ = now;  // short work says nothing in a log
  begun_ = true;
  const std::chrono::duration<double> since = now - drawn_at_;
  if (since.count() < (terminal_ ? kRedrawSeconds : kPlainSeconds)) return;
  const std::string eta = left ? clock_text(*left) : "-:--";
  char percent[8];
  std::snprintf(percent, sizeof percent, "%3.0f %%", 100.0 * done);
  if (terminal_) {
    const int filled = static_cast<int>(done * kBarWidth);
    std::cerr << "\r\x1b[K[" << std::string(static_cast<std::size_t>(filled), '#')
              << std::string(static_cast<std::size_t>(kBarWidth - filled), '.') << "] " << percent
              << "  ETA " << eta << "  " << text << std::flush;
  } else {
    std::cerr << percent << "  ETA " << eta << "  " << text << std::endl;
  }
  drawn_ = true;
  drawn_at_ = now;
}

void Progress::line(const std::string& text) {
  if (quiet_) return;
  clear();
  std::cerr << text << std::endl;
}

void Progress::clear() {
  if (terminal_ && drawn_) std::cerr << "\r\x1b[K" << std::flush;
  if (terminal_) drawn_ = false;
}

}  // namespace dcnn
