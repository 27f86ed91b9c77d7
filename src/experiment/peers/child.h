// SPDX-License-Identifier: Apache-2.0
// A helper program dcnn-peer-<library>: one line asked, one JSON line answered.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "dcnn/core/json.h"

namespace dcnn {

/// Calls go through the samples in turn, over so many calls' worth of them at most; a state that is
/// carried is zero whenever they begin again.
inline constexpr int kMostDistinctCalls = 1000;

/// The protocol, line by line, words separated by spaces. It runs in the folder of the files:
///   (at the start)                         {"name", "version", "host", "trains"} or {"missing"}
///   load BATCH THREADS SAMPLES NETWORK      {"outputs": per sample}
///   outputs COUNT                          {"values": [...]} of the first COUNT samples
///   run CALLS                              {"seconds": of all}
///   each CALLS                             {"seconds": [...]} of each
///   nothing SAMPLES NETWORK                {} the network that overhead runs is loaded
///   overhead CALLS                         {"seconds": of all}
///   task NETWORK THREADS                   {} a training (training.h) is set up
///   epoch                                  {"seconds"}
/// What fails answers {"error"}; the end of the input ends the program.
class Child {
 public:
  Child(const std::filesystem::path& program, const std::filesystem::path& folder);
  ~Child();
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// The next line it prints.
  Json hear();
  /// The answer; one with "error", and a helper that ended, are Error(kFailure).
  Json ask(const std::string& line);

 private:
  std::string name_, heard_;
  pid_t pid_ = -1;
  int socket_ = -1;
};

}  // namespace dcnn
