// SPDX-License-Identifier: Apache-2.0
// The only exception this project throws: what went wrong, where, and what to do about it.
#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

namespace dcnn {

/// Exit codes of every tool; the only list.
enum class Exit {
  kDone = 0,
  kFailure = 1,       ///< internal failure, full disk, unwritable output
  kUsage = 2,         ///< wrong command line, configuration file or key
  kData = 3,          ///< missing or bad recording, sim, system or pairs file
  kModel = 4,         ///< missing, foreign or broken model
  kInterrupted = 75,  ///< stopped by the user, state saved
};

/// A user's mistake or a failing machine. The message is one line: place, fault, remedy.
class Error : public std::runtime_error {
 public:
  Error(Exit exit, const std::string& message) : std::runtime_error(message), exit_(exit) {}
  Exit exit() const { return exit_; }

 private:
  Exit exit_;
};

/// Throws an Error whose message is the parts written one after the other.
template <class... Parts>
[[noreturn]] void fail(Exit exit, const Parts&... parts) {
  std::ostringstream message;
  (message << ... << parts);
  throw Error(exit, message.str());
}

/// Fails with the given parts unless `ok`.
template <class... Parts>
void require(bool ok, Exit exit, const Parts&... parts) {
  if (!ok) fail(exit, parts...);
}

}  // namespace dcnn
