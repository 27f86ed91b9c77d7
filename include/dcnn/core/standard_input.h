// SPDX-License-Identifier: Apache-2.0
// Standard input that can be read again.
#pragma once

#include <cstddef>

#include "dcnn/core/error.h"

namespace dcnn {

/// Up to `size` bytes of standard input from its byte `offset` on, 0 at its end; `offset` is at
/// most what was read before. What was read is kept, since a description or a recording is read by
/// several parts of one command. Throws Error with code `exit`.
std::size_t read_standard_input(std::size_t offset, char* to, std::size_t size, Exit exit);

}  // namespace dcnn
