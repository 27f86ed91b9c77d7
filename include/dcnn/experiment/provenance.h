// SPDX-License-Identifier: Apache-2.0
// Where a page comes from: what a program tells about its own run, and every page shows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace dcnn {

struct Provenance {
  std::string command, version;
  std::vector<std::filesystem::path> inputs;
};

/// Of this process; pages made before have none.
void set_provenance(Provenance provenance);
const Provenance& provenance();

}  // namespace dcnn
