// SPDX-License-Identifier: Apache-2.0
// What a process asks of the kernel before it serves in real time.
#pragma once

namespace dcnn {

/// Locks all memory and takes this SCHED_FIFO priority; Error(kFailure) where it may not.
void become_realtime(int priority);

}  // namespace dcnn
