// SPDX-License-Identifier: Apache-2.0
#include "support/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <string_view>

namespace dcnn {
namespace {

std::atomic<int> caught{0};
std::atomic<bool> is_quiet{true}, on_terminal{false};
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void on_signal(int signal) {
  if (caught.exchange(signal) != 0) ::_exit(128 + signal);
  if (is_quiet) return;
  const int before = errno;
  const std::string_view words = "\nstopping…\n";  // on a terminal below the bar
  const std::size_t begin = on_terminal ? 0 : 1;
  if (::write(STDERR_FILENO, words.data() + begin, words.size() - begin) < 0) {
    // nobody reads it: the work saves its state all the same
  }
  errno = before;
}

}  // namespace

void catch_interrupts(bool quiet) {
  is_quiet = quiet;
  on_terminal = ::isatty(STDERR_FILENO) != 0;
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGUSR1, &action, nullptr);  // schedulers announce the end of a task's time by it
}

bool interrupted() { return caught.load() != 0; }

void die_of_interrupt() {
  std::signal(caught.load(), SIG_DFL);
  std::raise(caught.load());
  ::_exit(128 + caught.load());
}

}  // namespace dcnn
