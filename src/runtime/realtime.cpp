#include "dcnn/runtime/realtime.h"

#include <sched.h>
#include <sys/mman.h>

#include <cerrno>
#include <cstring>

#include "dcnn/core/error.h"

namespace dcnn {

void become_realtime(int priority) {
  require(::mlockall(MCL_CURRENT | MCL_FUTURE) == 0, Exit::kFailure,
          "cannot lock memory: ", std::strerror(errno),
          "; raise RLIMIT_MEMLOCK or leave --realtime out");
  const sched_param wanted{priority};
  require(::sched_setscheduler(0, SCHED_FIFO, &wanted) == 0, Exit::kFailure,
          "cannot take real-time priority: ", std::strerror(errno),
          "; raise RLIMIT_RTPRIO or leave --realtime out");
}

}  // namespace dcnn
