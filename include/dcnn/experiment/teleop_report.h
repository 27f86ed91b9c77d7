// SPDX-License-Identifier: Apache-2.0
// The page and pictures of the bilateral demonstration.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "dcnn/teleop/teleop.h"

namespace dcnn {

struct TeleopResult {
  std::string name;
  TeleopTrace trace;
  Json row;  ///< summarise()
};

/// What stands in the place of a variant's name in legends, tables and lines: "tool known".
std::string name_of_variant(const std::string& name);

/// "tool known: contact from 69.8 to 75.0 s, at most 5.01 N; the master drifts by 0.00876 mm".
std::string teleop_line(const Json& row);

/// Writes teleop.json, report.html, Fig. 6 of every variant as SVG with its signals as CSV, and
/// the comparison and the frames as SVG.
void write_teleop(const std::filesystem::path& folder, const TeleopConfig& config,
                  const std::vector<TeleopResult>& results, std::uint64_t seed);

/// The frames of Fig. 1 as SVG: their axes, projected, at the places of the configuration.
std::string frames_svg(const TeleopConfig& config);

}  // namespace dcnn
