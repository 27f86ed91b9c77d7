// SPDX-License-Identifier: Apache-2.0
#include "dcnn/runtime/realtime.h"

#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>

#include "dcnn/core/error.h"

namespace dcnn {

namespace {

void check(bool ok, const char* what, const char* limit) {
  if (!ok) {
    fail(Exit::kFailure, "cannot ", what, ": ", std::strerror(errno), "; raise ", limit,
         " or leave --realtime out");
  }
}

}  // namespace

void become_realtime(int priority) {
  check(::mlockall(MCL_CURRENT | MCL_FUTURE) == 0, "lock memory", "RLIMIT_MEMLOCK");
  const sched_param wanted{priority};
  check(::sched_setscheduler(0, SCHED_FIFO, &wanted) == 0, "take real-time priority",
        "RLIMIT_RTPRIO");
}

}  // namespace dcnn
