// SPDX-License-Identifier: Apache-2.0
// Arms from their URDF.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/physics/chain.h"

namespace dcnn {

/// The chain from the root of a URDF to `tip` (none: the only leaf behind movable joints, or what
/// the last of `axes` moves). Where `axes`, names in their order, are joints of the chain, all
/// others are held at zero: a torso, a gripper's fingers. Where the library was built without
/// urdfdom, and for every fault, Error(kData).
JointChain read_urdf_chain(const std::filesystem::path& path, const std::string& tip,
                           const std::vector<std::string>& axes = {});

}  // namespace dcnn
