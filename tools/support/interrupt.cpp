#include "support/interrupt.h"

#include <unistd.h>

#include <atomic>
#include <csignal>

namespace dcnn {
namespace {

std::atomic<int> caught{0};
static_assert(std::atomic<int>::is_always_lock_free);

extern "C" void on_signal(int signal) {
  if (caught.exchange(signal) != 0) ::_exit(128 + signal);
}

}  // namespace

void catch_interrupts() {
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
