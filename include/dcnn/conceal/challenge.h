// SPDX-License-Identifier: Apache-2.0
// A challenge: many concealed scenarios, their answers sealed, and what a diagnosis made of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/data/recording.h"

namespace dcnn::conceal {

/// What draw() is to make for a challenge of so many scenarios, in an order that tells nothing:
/// every group has its share, and effects and amplitudes take turns within it.
std::vector<std::string> plan(int scenarios, std::uint64_t seed);

/// The same for a table of rates, in `rounds` rounds: of each 75 nulls, every effect alone at 1,
/// 0.3 and 0.1 or 0.05 times the noise, and 4 to 8 of every other group.
std::vector<std::string> rates_plan(int rounds, std::uint64_t seed);

/// So many of drawn_laws() in turn, 1, 3 and 10 times the noise.
std::vector<std::string> laws_plan(int count);

/// The same scenarios under the conditions of a family (scenario.h), or of each in turn (`all`).
/// Error(kUsage) for another name.
std::vector<std::string> in_family(std::vector<std::string> ids, const std::string& family);

/// Writes FOLDER/s0001/{sim.json,fit_*.csv,holdout_*.csv}, … and the sealed answers to the file
/// `seal`, which must lie outside the folder; returns the SHA-256 of its bytes, which stands in
/// FOLDER/seal.sha256 as well. The seal holds the SHA-256 of every file a scenario has.
/// Each scenario is recorded on each of `motions` too (record_on()). `progress` is told how many
/// are written.
std::string conceal_challenge(const std::vector<std::string>& ids, std::uint64_t seed,
                              const std::filesystem::path& folder,
                              const std::filesystem::path& seal,
                              const std::function<void(int done, int total)>& progress,
                              const std::vector<Recording>& motions = {});

/// Writes one scenario's sealed answers: the document's bytes go to `seal`, their SHA-256 to
/// FOLDER/seal.sha256; returns the latter.
std::string write_seal(const Json& answers, const std::filesystem::path& folder,
                       const std::filesystem::path& seal);
/// Writes scenarios FOLDER/s0001, … and their sealed answers; returns the SHA-256 of these.
/// `write` makes one in its folder and returns its answer.
using WriteScenario = std::function<Json(const std::string& id, const std::filesystem::path&)>;
std::string seal_each(const std::vector<std::string>& ids, std::uint64_t seed,
                      const std::filesystem::path& folder, const std::filesystem::path& seal,
                      const std::function<void(int done, int total)>& progress,
                      const WriteScenario& write);
/// Opens the seal of a folder; Error(kData) unless its SHA-256 is the one in FOLDER/seal.sha256.
Json open_seal(const std::filesystem::path& folder, const std::filesystem::path& seal);

/// Scores one report against one answer; `report` null: it has failed.
Json score(const Json& answer, const Json& report);

/// Scores FOLDER/reports/<scenario>/report.json of every scenario of the seal. `scenarios` has one
/// entry each, `tables` the rates with 95 % intervals by group, effect, amplitude, motion and
/// noise. Where FOLDER/rivals/<scenario>/<method>/report.json are there, `rivals` has the rates of
/// each method over all scenarios (of one that is `fit_only` its errors and its time);
/// where FOLDER/ablations/<part>/<scenario>/report.json are, `ablations` has those without the
/// part.
Json score_challenge(const std::filesystem::path& folder, const std::filesystem::path& seal);

}  // namespace dcnn::conceal
