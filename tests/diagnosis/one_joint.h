// SPDX-License-Identifier: Apache-2.0
// A search in logs of one joint, whose simulator is a constant.
#pragma once

#include <string>
#include <vector>

#include "dcnn/core/file.h"
#include "diagnosis/axis_case.h"
#include "diagnosis/search.h"
#include "support/process.h"

namespace dcnn::test {

/// In tables of t [s], q [rad] and torque [N·m], one of each recording.
inline Search search_of_joint(const std::vector<Table>& tables) {
  const TemporaryFolder folder;
  write_file(folder / "system.json", R"({"kind": "axes", "axes": [
    {"name": "joint", "measured": "torque", "unit": "N*m", "position": "q", "base": []}]})");
  DiagnosisRequest request;
  request.system = folder / "system.json";
  for (const Table& table : tables) {
    request.fit.push_back(folder / (std::to_string(request.fit.size()) + ".csv"));
    write_csv(request.fit.back(), table);
  }
  return Search(load_axes(request).cases[0].fit, {}, nullptr);
}

/// Rows for such a table.
inline Table joint_table(Index rows) { return {{"t", "q", "torque"}, Eigen::MatrixXd(rows, 3)}; }

}  // namespace dcnn::test
