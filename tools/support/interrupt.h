// Ctrl-C as a wish: the first one lets the work save its state, the second one ends it.
#pragma once

namespace dcnn {

/// From now on SIGINT and SIGTERM set a flag; a second signal ends the process with 128 + signal.
void catch_interrupts();
bool interrupted();

}  // namespace dcnn
