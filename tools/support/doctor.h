// SPDX-License-Identifier: Apache-2.0
// The check that tools which learn from recordings run first.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/check/check.h"
#include "support/tool.h"

namespace dcnn {

/// Logs and what the command line declares about them.
struct CheckRequest {
  std::vector<std::filesystem::path> logs;
  ReadOptions read;
  std::filesystem::path simulator, system;  ///< empty for none
  std::filesystem::path urdf = {};          ///< of the arm; else `arm` of the system's description
  std::string tip = {};
};

/// Reports in the order of the logs; streams (`-`) are left out, for they can be read once only.
std::vector<check::Report> check_logs(const CheckRequest& request);

/// A likely fault, as a line of a report.
struct Suspicion {
  std::string fault, line;
};

/// One line a kind of fault that is likely, or certain: its first recording and column, and names
/// of the others.
std::vector<Suspicion> suspicions(const std::vector<check::Report>& reports);

/// What the check found that does not stop a command.
struct Examined {
  std::vector<Suspicion> likely;
  std::vector<std::filesystem::path> zeroed;  ///< logs whose sensor was likely set to zero first
  /// Stretches in which a channel is likely frozen, in the log's own t.
  struct Frozen {
    std::filesystem::path log;
    double begin_s, end_s;
    std::string channel;
  };
  std::vector<Frozen> frozen;
};

/// --accept.
class Doctor {
 public:
  explicit Doctor(Tool& tool);
  /// Error(kData) with the remedy where a fault is certain and not accepted; a line on stderr for
  /// each that is likely. Faults in `own` are the command's own business and are passed over.
  Examined examine(const Tool& tool, const CheckRequest& request,
                   const std::vector<std::string>& own = {}) const;

  /// --accept for the command line of another tool.
  std::vector<std::string> words() const;

 private:
  std::vector<std::string> accepted_;
};

}  // namespace dcnn
