// SPDX-License-Identifier: Apache-2.0
#include "support/fail_line.h"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <iostream>

#include "dcnn/core/excerpt.h"

namespace dcnn {
namespace {

std::string program_of_terminate;

[[noreturn]] void on_terminate() {
  if (!std::current_exception()) std::abort();
  std::_Exit(tell_exception(program_of_terminate));
}

}  // namespace

int fail_line(const std::string& program, const std::string& message, Exit exit) {
  constexpr std::size_t kMostBytes = 2000;  // a message may quote a whole document
  std::string line = message;
  std::replace_if(
      line.begin(), line.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  std::cerr << program << ": " << excerpt(line, kMostBytes) << std::endl;
  return static_cast<int>(exit);
}

int tell_exception(const std::string& program) {
  try {
    throw;
  } catch (const Error& error) {
    return fail_line(program, error.what(), error.exit());
  } catch (const std::filesystem::filesystem_error& error) {
    return fail_line(program, error.path1().string() + ": " + error.code().message(),
                     Exit::kFailure);
  } catch (const std::bad_alloc&) {
    return fail_line(program, "out of memory", Exit::kFailure);
  } catch (const std::exception& error) {
    return fail_line(program, std::string("internal error: ") + error.what(), Exit::kFailure);
  }
}

void fail_in_one_line(const std::string& program) {
  program_of_terminate = program;
  std::set_terminate(on_terminate);
}

}  // namespace dcnn
