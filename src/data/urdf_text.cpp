// SPDX-License-Identifier: Apache-2.0
#include "data/urdf_text.h"

#include "dcnn/core/error.h"
#include "dcnn/core/file.h"

namespace dcnn {

std::string read_urdf_text(const std::filesystem::path& path) {
  constexpr std::size_t kMostUrdfBytes = std::size_t{16} << 20;
  std::string text = read_file(path, kMostUrdfBytes, Exit::kData);
  require(text.find("<robot") != text.npos, Exit::kData, path.string(),
          ": is no URDF, for it has no <robot>; give the robot's description in XML");
  return text;
}

}  // namespace dcnn
