// SPDX-License-Identifier: Apache-2.0
// Single axes of machines with concealed effects: a joint, a motor, a linear axis or a small
// oscillator, with the log that its drive keeps.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace dcnn::conceal {

/// Effects of the catalogue that an axis can have, and laws that no catalogue has.
const std::vector<std::string>& axis_catalogue();
const std::vector<std::string>& axis_laws();

/// What conceal_axes() is to make, ids "group:from/effects/number": `null` (nothing), `single`
/// (one effect of axis_catalogue()), `weak` (the same below the noise), `double` and `triple`
/// (effects that occur together, joined by '+'), `scaled` (an effect, and a simulated column in
/// another unit: a gain), `unlisted` (one of axis_laws()) and `mixed` (such a law, and a listed
/// effect). The rms of each effect is drawn log-uniformly between `from` and 10^0.5 `from` times
/// the noise. In an order that tells nothing.
std::vector<std::string> axis_plan(int scenarios, std::uint64_t seed);

/// Writes FOLDER/s0001/{system.json,fit_*.csv,holdout_0.csv}, … and the sealed answers, as
/// conceal_challenge() does. Error(kUsage) for another id.
std::string conceal_axes(const std::vector<std::string>& ids, std::uint64_t seed,
                         const std::filesystem::path& folder, const std::filesystem::path& seal,
                         const std::function<void(int done, int total)>& progress);

}  // namespace dcnn::conceal
