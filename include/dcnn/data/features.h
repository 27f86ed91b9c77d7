// SPDX-License-Identifier: Apache-2.0
// Feature vectors from recordings: `pose`, the paper's 15; `body`, 15 in the sensor
// frame without singularity; `axes`, those of a system description.
#pragma once

#include <Eigen/Dense>
#include <string>
#include <vector>

#include "dcnn/data/derivative.h"
#include "dcnn/data/recording.h"

namespace dcnn {

/// What the configuration asks for.
struct FeatureSpec {
  enum class Set { kPose, kBody, kAxes };
  Set set = Set::kPose;
  DerivativeSpec derivative;
  Eigen::Vector3d sensor_rotation_rpy =
      Eigen::Vector3d::Zero();  ///< mounting R_ES (body only), rad
};

/// Keys: set (pose|body; axes where the system has axes), derivative, sensor_rotation_rpy.
FeatureSpec parse_features(Options options, const System& system);

/// What training fixed: the model file holds it, and every later recording is read with it.
struct FeatureLayout {
  FeatureSpec spec;
  System system;
  std::vector<std::string> names, units;  ///< rows of the map, in order
  double dt = 0.0;                        ///< s, of the training recordings
  Eigen::Vector3d circular_mean =
      Eigen::Vector3d::Zero();  ///< pose: branch of each angle
  /// (6) standard deviation of x, y, z (m) and the Euler angles (rad) over the training recordings,
  /// the power that noise on the pose refers to; empty without a pose.
  Eigen::VectorXd pose_deviation;
  std::vector<std::string> notes;  ///< blocks left out because their signal is not logged
};
Json to_json(const FeatureLayout& layout);
FeatureLayout parse_layout(const Json& json, const std::string& where, Exit exit);

/// Decides the rows from the training recordings: a block whose signal is not logged in all of them
/// is left out with a note; rates that differ by more than 1 % are Error(kData).
FeatureLayout make_layout(const std::vector<Recording>& training, const FeatureSpec& spec,
                          const System& system);

struct Features {
  Eigen::MatrixXd x;        ///< (T, F), SI
  std::vector<char> valid;  ///< (T) 0 near the Euler singularity (|cos beta| < 0.05, pose only)
  Index invalid_count() const;
};

/// Features of one recording. dt off by more than 1 % of the layout's, or a missing signal, is
/// Error(kData) with the remedy.
Features make_features(const Recording& recording, const FeatureLayout& layout);

}  // namespace dcnn
