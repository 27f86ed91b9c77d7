// SPDX-License-Identifier: Apache-2.0
// Ctrl-C as a wish: the first one lets the work save its state, the second one ends it.
#pragma once

namespace dcnn {

/// From now on SIGINT, SIGTERM and SIGUSR1 set a flag; a second signal ends the process with 128 +
/// signal. Unless `quiet` the first one is answered by "stopping…", since saving takes a while.
void catch_interrupts(bool quiet = true);
bool interrupted();
/// Dies of the signal that was caught: for a work that has no state to save.
[[noreturn]] void die_of_interrupt();

}  // namespace dcnn
