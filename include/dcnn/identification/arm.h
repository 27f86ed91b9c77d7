// SPDX-License-Identifier: Apache-2.0
// A whole arm from joint positions and torques (or currents): rigid body, friction, payload.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/data/system.h"
#include "dcnn/identification/identify.h"
#include "dcnn/physics/chain.h"

namespace dcnn {

struct ArmRequest {
  std::filesystem::path system;  ///< columns of the joints (kind "axes"), and the DH table
  std::filesystem::path urdf;    ///< instead of the DH table; its inertias are the prior
  std::string tip;               ///< of the URDF; empty: its end
  std::vector<std::filesystem::path> logs;
  std::vector<std::filesystem::path> loaded;   ///< the same arm with a payload at the flange
  std::vector<std::filesystem::path> holdout;  ///< that decide nothing
  bool drive_gains =
      false;  ///< the measured torque has an unknown gain in each joint (needs a URDF)
};

/// One joint: its drive.
struct JointEstimate {
  std::string name, unit;
  std::vector<IdentifiedNumber>
      parameters;           ///< offset, dry, viscous, rotor_inertia and what else is shown
  double presliding = 0.0;  ///< rad (m): path over which dry friction turns to the other side
  double creep_s = 0.0;     ///< in which dry friction falls by 1/e at rest; 0: it stays
  double torque_rms = 0.0, residual_rms = 0.0;
  std::optional<double> holdout_rms;
};

struct LinkEstimate {
  std::string name;
  BodyVector body = BodyVector::Zero(), deviation = BodyVector::Zero();
  std::vector<bool> shown;  ///< (10) the motion halves what was known before, or better
};

struct ArmIdentification {
  std::vector<JointEstimate> joints;
  std::vector<LinkEstimate> links;  ///< one of many sets with the same torques: see base_parameters
  int base_parameters = 0;          ///< combinations that these motions tell
  std::vector<IdentifiedNumber>
      payload;  ///< mass_kg, com_*_m in the flange's frame; empty without `loaded`
  std::vector<std::string> recordings, holdout, notes;
  double lowpass_hz = 0.0;  ///< 0: poses at rest
  Json system;  ///< description with the links found: the simulator at hand of a diagnosis
};

/// The arm's joints as the request describes them, by a DH table or a URDF. Faults are
/// Error(kData).
JointChain chain_of(const ArmRequest& request);

/// One regression for all joints, weighted by their residuals and their correlation in time. Faults
/// are Error(kData).
ArmIdentification identify_arm(const ArmRequest& request);

Json to_json(const ArmIdentification& identification);
std::string to_text(const ArmIdentification& identification);

}  // namespace dcnn
