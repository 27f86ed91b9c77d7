// SPDX-License-Identifier: Apache-2.0
// A tool's numbers from recordings alone: mass, centre of mass, inertia, offset and mounting.
#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/data/recording.h"
#include "dcnn/physics/tool_model.h"

namespace dcnn {

struct IdentifyRequest {
  std::vector<std::filesystem::path> logs;
  ReadOptions read;
  std::optional<Eigen::Vector3d> mounting_rpy;  ///< (rx, ry, rz) as designed; none: estimated
  bool laws =
      true;  ///< friction, a lag, cables and sensor faults are fitted beside where data show them
};

/// One number, SI, in S.
struct IdentifiedNumber {
  std::string name, unit;   ///< "com_z_m", "m"
  double value, low, high;  ///< 95 % interval of the physically possible
  bool shown = true;        ///< the motion tells it
  std::string motion = {};  ///< what would, where it does not
};

/// A law that the data show beside the rigid tool.
struct BesideTool {
  std::string effect, axis, words;
  std::vector<IdentifiedNumber> parameters;
};

struct ToolIdentification {
  ToolModel model;  ///< what sim.json holds; numbers that no motion shows are their least
  std::vector<IdentifiedNumber> parameters;
  std::vector<BesideTool> beside;
  std::vector<std::string> recordings, targets, units, notes;
  Eigen::VectorXd residual_rms;  ///< (targets) in the motion's band
  Eigen::VectorXd measured_rms;  ///< (targets) about the mean of each recording, in the same band
  Eigen::VectorXd cutoff_hz;     ///< (recordings) of that band; 0: poses at rest
  bool constrained = false;      ///< least squares alone gave a body that cannot exist
  double possible_share = 1.0;   ///< of the free distribution that bodies can have
};

/// Weighted least squares under coloured noise, intervals by draws from the distribution of the
/// estimate restricted to bodies that can exist (docs/use/identify.md). Faults are Error(kData).
ToolIdentification identify_tool(const IdentifyRequest& request);

/// Keys of sim.json's tool whose values the recordings do not show: of mass_kg, com_m,
/// inertia_kgm2.
std::vector<std::string> assumed(const ToolIdentification& identification);

Json to_json(const ToolIdentification& identification);
/// What a person reads: numbers with intervals, what is not shown, what acts beside the tool.
std::string to_text(const ToolIdentification& identification);

}  // namespace dcnn
