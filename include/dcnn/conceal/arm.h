// SPDX-License-Identifier: Apache-2.0
// Arms with concealed effects: a payload at the flange, and effects in their joints.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace dcnn::conceal {

/// What conceal_arms() is to make, ids "group:value/effect/number": `null` (nothing), `single:A`
/// (one effect in one joint, A times its noise), `payload` (a body at the flange), `loaded` (a
/// payload, and dry and viscous friction in every joint at twice the noise): 1, 5, 1 and 1 of
/// eight, for 6 and 7 joints, in an order that tells nothing.
std::vector<std::string> arm_plan(int scenarios, std::uint64_t seed);

/// Writes FOLDER/s0001/{system.json,fit_*.csv,holdout_*.csv}, … and the sealed answers, as
/// conceal_challenge() does. The simulator at hand is the arm without what is hidden: half of the
/// scenarios describe the links' bodies in system.json, half log the simulated torques.
/// Error(kUsage) for another id.
std::string conceal_arms(const std::vector<std::string>& ids, std::uint64_t seed,
                         const std::filesystem::path& folder, const std::filesystem::path& seal,
                         const std::function<void(int done, int total)>& progress);

}  // namespace dcnn::conceal
