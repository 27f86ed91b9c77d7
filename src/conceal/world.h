// Motion and forces at a high rate: own rotations, differences and integrators.
#pragma once

#include "dcnn/conceal/scenario.h"
#include "dcnn/core/random.h"

namespace dcnn::conceal {

constexpr int kDecimation = 8;
constexpr double kStep = 1.0 / 4000.0;  // s

/// A recording's motion, 4000 samples a second.
struct Path {
  double start = 0.0;                      // s, clock of the first sample
  Eigen::MatrixXd pose;                    // (T, 6)
  std::vector<Eigen::Matrix3d> rotation;   // sensor to base
  Eigen::MatrixXd velocity, acceleration;  // (T, 3), base
  Eigen::MatrixXd rate, rate_derivative;   // (T, 3), sensor
  Eigen::Index samples() const { return pose.rows(); }
  double time(Eigen::Index i) const { return start + kStep * static_cast<double>(i); }
};

/// Families: human, multisine, points, scan, repeats; poor: harmonic, planar.
Path make_path(const std::string& family, double start, double seconds, std::uint64_t seed);

/// The reading without noise at 500 Hz, (T, 3).
Eigen::MatrixXd reading(const Path& path, const Tool& tool, const std::vector<Hidden>& hidden,
                        const Eigen::MatrixXd& noise);

}  // namespace dcnn::conceal
