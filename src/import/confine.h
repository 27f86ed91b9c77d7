// SPDX-License-Identifier: Apache-2.0
// A process that reads bytes of others by somebody else's library.
#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace dcnn {

/// Runs `work` in a child that may open files for reading, but neither write nor make any, nor
/// start programs or talk to others, until it calls the function that it is given: after that it
/// opens nothing at all (seccomp; other calls fail by EPERM). Memory, processor time and
/// descriptors are limited. What `work` writes by its second argument arrives at `receive`, in
/// order; an Error of the child is thrown here; a child that dies is an Error(kData) naming
/// `place`.
using ConfinedWork = std::function<void(const std::function<void()>& seal,
                                        const std::function<void(std::string_view)>& send)>;
void run_confined(const ConfinedWork& work, const std::function<void(std::string_view)>& receive,
                  const std::string& place);

}  // namespace dcnn
