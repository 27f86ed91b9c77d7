// SPDX-License-Identifier: Apache-2.0
// What is wrong with a command line, in words of the table of options.
#pragma once

#include <deque>
#include <string>

#include "support/option_table.h"

namespace CLI {
class ParseError;
}  // namespace CLI

namespace dcnn {

/// One line that says which option is wrong, and what it takes.
std::string usage_fault(const CLI::ParseError& error, const std::deque<OptionRow>& rows);

}  // namespace dcnn
