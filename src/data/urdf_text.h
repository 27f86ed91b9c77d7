// SPDX-License-Identifier: Apache-2.0
// Descriptions of robots in XML (URDF), before a parser sees them.
#pragma once

#include <filesystem>
#include <string>

namespace dcnn {

/// The text of a URDF file of 16 MB at most; refuses what has no <robot>.
std::string read_urdf_text(const std::filesystem::path& path);

}  // namespace dcnn
