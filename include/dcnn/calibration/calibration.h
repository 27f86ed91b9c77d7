// SPDX-License-Identifier: Apache-2.0
// Sensor frame to robot frame from pairs of one force seen in both (Wahba 1965).
#pragma once

#include <Eigen/Dense>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dcnn/core/json.h"
#include "dcnn/data/recording.h"

namespace dcnn {

/// One force seen twice: by the sensor in S and by a reference in E; blocks are (n,3) [N].
struct ForcePairs {
  std::string name;  ///< names the source in errors
  Eigen::MatrixXd sensor, reference;
  Eigen::VectorXd weights;        ///< (n), positive
  std::optional<double> mass_kg;  ///< estimated from the sensor, where the reference is gravity of
                                  ///< an unknown mass
};

/// CSV with columns sx,sy,sz,rx,ry,rz and optionally w. Faults are Error(kData).
ForcePairs read_pairs(const std::filesystem::path& path);

/// A known mass hung at the tip in static poses: what it adds to the reading and its weight in E.
/// Both lists must hold the same poses in the same order (to 0.02 rad), else Error(kData).
ForcePairs weight_pairs(const Recording& loaded, const Recording& unloaded, double mass_kg);

/// The tool itself as the weight; without a mass it is taken from the readings' size after their
/// mean (the bias) is removed.
ForcePairs static_pairs(const Recording& poses, std::optional<double> mass_kg, bool with_bias);

struct CalibrationOptions {
  bool with_bias = false;                  ///< subtract the means: a constant offset is found too
  std::optional<Eigen::Matrix3d> nominal;  ///< R_ES as designed, to compare with
};

/// How the sensor's columns would have to be read to agree with a mounting.
struct AxisConvention {
  std::string axes;         ///< e.g. "+y -x +z": what to read as x, y, z
  int force_sign = 1;       ///< -1: the log holds the reaction (or its axes are left-handed)
  double residual_rms = 0;  ///< N, with the mounting held and the columns read so
};

/// r = R_ES·s + offset.
struct Calibration {
  Eigen::Matrix3d R_ES = Eigen::Matrix3d::Identity();
  double gain = 1.0;  ///< r = gain·R_ES·s fits best; reported, not applied
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();      ///< N, in E
  double residual_rms = 0.0;                             ///< N per axis
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< rad^2, of a small turn in S
  Index pairs = 0;
  std::optional<double> mass_kg;
  std::optional<double> nominal_angle;       ///< rad, from the nominal mounting
  std::optional<AxisConvention> convention;  ///< the one that fits the nominal mounting best
  std::vector<std::string> notes;            ///< what the user should look at, one line each
};

/// R_ES by singular value decomposition (Kabsch 1976; Markley 1988). Too few pairs, forces that
/// are nearly parallel (names the axis about which the turn is not determined) and mirrored input
/// (names the convention that fits) are Error(kData).
Calibration calibrate(const ForcePairs& pairs, const CalibrationOptions& options);

/// Of the 24 right-handed readings of the axes and both signs of force, the one with which the
/// sensor agrees best with a mounting that is held.
AxisConvention best_convention(const ForcePairs& pairs, const Eigen::Matrix3d& R_ES,
                               bool with_bias);

/// calibration.json (docs/use/calibrate.md).
Json to_json(const Calibration& calibration);
/// The rotation must be one, the offset finite; else Error(kData).
Calibration read_calibration(const std::filesystem::path& path);

/// Angle of the turn between two rotations, rad, in [0, pi].
double angle_between(const Eigen::Matrix3d& A, const Eigen::Matrix3d& B);

}  // namespace dcnn
