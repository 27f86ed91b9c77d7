// Arms from their URDF.
#pragma once

#include <filesystem>
#include <string>

#include "dcnn/physics/chain.h"

namespace dcnn {

/// The chain from the root of a URDF to `tip` (none: the only leaf behind movable joints). Where
/// the library was built without urdfdom, and for every fault, Error(kData).
JointChain read_urdf_chain(const std::filesystem::path& path, const std::string& tip);

}  // namespace dcnn
