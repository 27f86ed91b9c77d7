// SPDX-License-Identifier: Apache-2.0
// One cell at work: its folder, its commands, what they cost and left.
#pragma once

#include <sys/types.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/cells/pack.h"
#include "dcnn/cells/plan.h"

namespace dcnn {

/// What the commands of cells see of the outside.
struct CellSurroundings {
  std::filesystem::path root;            ///< what `in` is
  std::vector<std::string> path;         ///< folders in which programs are looked for
  std::vector<std::string> environment;  ///< "NAME=value"

  CellSurroundings(const std::filesystem::path& root, const std::filesystem::path& programs,
                   int threads);
};

/// Begins with the first command; ends what still runs when it is destroyed. Each command is a
/// process group of its own, which the kernel ends when this process dies.
class CellProcess {
 public:
  CellProcess(const Cell& cell, const CellSurroundings& surroundings, std::filesystem::path folder);
  ~CellProcess();
  CellProcess(const CellProcess&) = delete;
  CellProcess& operator=(const CellProcess&) = delete;

  /// Looks without waiting whether a command has ended, begins the next one, ends what takes too
  /// long.
  bool finished();
  const Cell& cell() const { return cell_; }
  int exit() const { return result_.exit; }
  /// Ended by somebody else, not by a fault of its own.
  bool ended_from_outside() const;
  /// Result with the files that are kept; Error(kFailure) where they cannot be read.
  CellResult result() const;
  /// Asks the command at work to end (SIGTERM); none begins after it.
  void ask_to_end();

 private:
  using Clock = std::chrono::steady_clock;

  void start_command();
  void command_ended(int status);
  void watch_time();
  std::string standard_error() const;

  const Cell& cell_;
  const CellSurroundings& surroundings_;
  std::filesystem::path folder_;
  std::size_t command_ = 0;
  pid_t process_ = -1;
  bool out_of_time_ = false, asked_to_end_ = false;
  Clock::time_point start_ = Clock::now(), asked_{};
  CellResult result_;
};

}  // namespace dcnn
