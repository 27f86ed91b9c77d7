// SPDX-License-Identifier: Apache-2.0
#include "support/next_command.h"

#include <algorithm>

#include "dcnn/import/summary.h"

namespace dcnn {

std::string next_of_tool(const Table& table, const std::filesystem::path& recording) {
  const std::string name = quoted_argument(recording.string());
  const auto measures = [&](const char* force) {
    return std::find(table.columns.begin(), table.columns.end(), force) != table.columns.end();
  };
  if (!measures("fx") && !measures("fy") && !measures("fz")) {
    return "name the force, --map fx=CHANNEL and so on; without one there is a motion alone: "
           "dcnn-sim --sim sim.json --motion " +
           name + " --out predicted.csv";
  }
  return "dcnn-check " + name + ", then dcnn-identify " + name +
         " --out sim.json (or, with a simulator, dcnn-diagnose --sim sim.json --fit " + name +
         " --out report)";
}

std::string next_of_axes(const std::filesystem::path& system,
                         const std::vector<std::filesystem::path>& recordings) {
  std::string words = "dcnn-diagnose --system " + quoted_argument(system.string()) + " --fit";
  const std::size_t fitted = std::max<std::size_t>(1, recordings.size() - 1);
  for (std::size_t k = 0; k < recordings.size(); ++k) {
    words += (k == fitted ? " --holdout " : " ") + quoted_argument(recordings[k].string());
  }
  return words + " --out report";
}

}  // namespace dcnn
