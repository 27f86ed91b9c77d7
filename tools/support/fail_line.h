// SPDX-License-Identifier: Apache-2.0
// One line and an exit code for whatever ends a command.
#pragma once

#include <string>

#include "dcnn/core/error.h"

namespace dcnn {

/// "program: message" in one line; the exit code.
int fail_line(const std::string& program, const std::string& message, Exit exit);
/// The same for the exception that is being handled.
int tell_exception(const std::string& program);
/// From here on it is so too for what is thrown outside Tool::run(), such as where the table of
/// options is made.
void fail_in_one_line(const std::string& program);

}  // namespace dcnn
