// SPDX-License-Identifier: Apache-2.0
// What tests of dcnn-run start from: a recording, the simulator that made it, models trained on it.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <string>
#include <utility>

#include "data/testing.h"
#include "dcnn/data/csv.h"
#include "runtime/support.h"
#include "support/process.h"

namespace dcnn::test {

struct RunBench {
  TemporaryFolder folder;
  std::string log = (folder / "free.csv").string(), simulator = (folder / "sim.json").string();

  RunBench() {
    write_csv(log, free_motion(6000).table);
    std::ofstream(simulator) << to_json(small_tool()).dump();
  }

  /// The file of a model of this kind, trained when it is first asked for.
  std::string trained(const std::string& kind) const {
    const auto model = folder / (kind + ".dcnn");
    if (!std::filesystem::exists(model)) {
      const auto result = run("train", {"--model", kind, "--preset", "quick", "--online", "--train",
                                        log, "--quiet", "--out", model});
      EXPECT_EQ(result.exit_code, 0) << result.err;
    }
    return model;
  }
};

inline const RunBench& bench() {
  static const RunBench shared;
  return shared;
}

/// Two ports that were free a moment ago.
inline std::pair<std::string, std::string> free_ports() {
  const int first = 20000 + static_cast<int>(::getpid()) % 20000;
  return {"127.0.0.1:" + std::to_string(first), "127.0.0.1:" + std::to_string(first + 20000)};
}

}  // namespace dcnn::test
