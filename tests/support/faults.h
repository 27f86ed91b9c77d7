// SPDX-License-Identifier: Apache-2.0
// System calls of a program that fail once: tests/support/fail_calls.cpp does it.
#pragma once

#include <cerrno>
#include <filesystem>
#include <map>

#include "support/process.h"

namespace dcnn::test {

constexpr int kOneByte = 0;  ///< instead of an error: one byte of what was asked
constexpr int kKill = -1;    ///< instead of an error: kill -9

/// Errors that a system call can have.
inline const std::map<std::string, std::vector<int>>& errors_of_calls() {
  static const std::map<std::string, std::vector<int>> kErrors{
      {"open", {EACCES, EMFILE, EIO, EINTR, ENOSPC}},
      {"read", {EIO, EINTR, kOneByte}},
      {"write", {ENOSPC, EIO, EINTR, kOneByte}},
      {"fsync", {EIO, EINTR, ENOSPC}},
      {"rename", {EACCES, EIO, ENOSPC}},
      {"renameat2", {EACCES, EIO, ENOSPC}},
      {"link", {EPERM, EIO, EMLINK}},
      {"unlink", {EIO, EACCES}},
      {"mkdir", {EACCES, ENOSPC, EIO}},
      {"openat", {EACCES, EMFILE, EIO}},
      {"fopen", {EACCES, EMFILE, EIO}},
      {"pread", {EIO, EINTR, kOneByte}},
      {"flock", {EINTR, ENOLCK}},
      {"mmap", {ENOMEM}},
      {"socket", {EMFILE, ENOBUFS, EACCES}},
      {"bind", {EADDRINUSE, EACCES}},
      {"connect", {ECONNREFUSED, ENETUNREACH, EINTR}},
      {"recv", {ECONNREFUSED, EINTR, ENOMEM}},
      {"send", {ECONNREFUSED, EINTR, ENOBUFS, EAGAIN}},
      {"ppoll", {EINTR, ENOMEM}}};
  return kErrors;
}

inline std::string words_of_fault(const std::string& call, int place, int error) {
  return call + " number " + std::to_string(place) + ": " +
         (error == kOneByte ? "one byte"
          : error == kKill  ? "killed"
                            : std::strerror(error));
}

/// What makes the `place`-th call fail in a program that is given it; `mark` is made when it has.
inline std::vector<std::string> fault_environment(const std::string& call, int place, int error,
                                                  const std::filesystem::path& mark) {
  return {"LD_PRELOAD=" DCNN_FAIL_CALLS,      "FAIL_CALL=" + call,
          "FAIL_AT=" + std::to_string(place), "FAIL_ERRNO=" + std::to_string(error),
          "FAIL_MARK=" + mark.string(),       "OMP_NUM_THREADS=1"};
}

}  // namespace dcnn::test
