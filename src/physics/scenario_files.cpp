// SPDX-License-Identifier: Apache-2.0
#include "dcnn/core/file.h"
#include "dcnn/core/file_set.h"
#include "dcnn/physics/scenario.h"

namespace dcnn {

void write_scenario(const Scenario& scenario, const std::filesystem::path& folder) {
  FileSet files(folder);
  for (const auto& recording : scenario.recordings) {
    write_csv(folder / (recording.name + ".csv"), recording.noisy.table);
    write_csv(folder / (recording.name + "_clean.csv"), recording.clean.table);
  }
  write_file(folder / "sim.json", scenario.simulator.dump(2) + "\n");
  write_file(folder / "truth.json", scenario.truth.dump(2) + "\n");
  files.commit();
}

}  // namespace dcnn
