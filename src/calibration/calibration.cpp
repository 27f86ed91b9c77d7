// SPDX-License-Identifier: Apache-2.0
#include "dcnn/calibration/calibration.h"

#include <cmath>
#include <cstdio>

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::RowVector3d;
using Eigen::Vector3d;

constexpr double kDegenerate = 1e-3, kMirrored = 0.05;  // shares of the largest singular value
constexpr double kLeastExplained = 0.5;  // of the sensor's power, by a turn and any gain
constexpr double kGainTolerance = 0.02;
constexpr double kOtherMounting = 20.0 * M_PI / 180.0;  // no assembly tolerance
constexpr double kRounding = 1e-9;                      // of the force: sums of squares in double
constexpr double kClearF = 20.0;  // by chance in less than 2 of 1000 sets of four pairs

std::string text(const char* format, double a, double b = 0, double c = 0) {
  char line[160];
  std::snprintf(line, sizeof line, format, a, b, c);
  return line;
}

RowVector3d mean(const MatrixXd& x, const Eigen::VectorXd& weights) {
  return weights.transpose() * x / weights.sum();
}

void check_pairs(const ForcePairs& pairs, bool with_bias) {
  const Index needed = with_bias ? 3 : 2;
  require(pairs.sensor.rows() >= needed, Exit::kData, pairs.name, ": ", pairs.sensor.rows(),
          " pairs, at least ", needed, " are needed; measure in more orientations");
}

[[noreturn]] void fail_mirrored(const ForcePairs& pairs, const CalibrationOptions& options) {
  ForcePairs reaction = pairs;
  reaction.sensor *= -1.0;
  const Calibration other = calibrate(reaction, options);
  std::string reading;
  if (options.nominal) {
    reading = "; the nominal mounting fits with x y z read as " +
              best_convention(reaction, *options.nominal, options.with_bias).axes +
              " of the negated force";
  }
  fail(Exit::kData, pairs.name, ": left-handed axes or swapped sign; with --force-sign -1 ",
       text("(or one axis negated) the residual is %.3g N", other.residual_rms), reading);
}

/// The rotation nearest to H^T (Kabsch), whatever H is worth.
Matrix3d nearest_rotation(const Eigen::JacobiSVD<Matrix3d>& svd) {
  const double d = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1.0 : 1.0;
  return svd.matrixV() * Vector3d(1.0, 1.0, d).asDiagonal() * svd.matrixU().transpose();
}

double chi_squared(const MatrixXd& s, const MatrixXd& r, const Eigen::VectorXd& weights,
                   const Matrix3d& R) {
  return (r - s * R.transpose()).rowwise().squaredNorm().dot(weights);
}

/// Says so where an offset of the sensor that was not asked for explains the residual (F-test).
void suggest_bias(const ForcePairs& pairs, double chi2, Calibration& result) {
  const MatrixXd s = pairs.sensor.rowwise() - mean(pairs.sensor, pairs.weights);
  const MatrixXd r = pairs.reference.rowwise() - mean(pairs.reference, pairs.weights);
  const auto freedom = static_cast<double>(3 * s.rows() - 6);
  if (freedom < 6.0) return;
  const Matrix3d H = s.transpose() * pairs.weights.asDiagonal() * r;
  const Eigen::JacobiSVD<Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double with = chi_squared(s, r, pairs.weights, nearest_rotation(svd));
  const double rounding = kRounding * kRounding * r.rowwise().squaredNorm().dot(pairs.weights);
  if (!(chi2 - with > kClearF * 3.0 * with / freedom + rounding)) return;
  result.notes.push_back(
      text("the residual of %.3g N is %.3g N with a constant offset of the sensor: "
           "add --with-bias",
           result.residual_rms, std::sqrt(with / (3.0 * pairs.weights.sum()))));
}

/// The rotation that turns s into r, H = sum w s r^T.
Matrix3d best_rotation(const Matrix3d& H, const ForcePairs& pairs,
                       const CalibrationOptions& options) {
  const Eigen::JacobiSVD<Matrix3d> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Vector3d s = svd.singularValues();
  require(std::isfinite(s[0]) && s[0] > 0.0, Exit::kData, pairs.name,
          ": the forces of sensor and reference have nothing in common; check the columns");
  const double d = (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1.0 : 1.0;
  if (d < 0 && s[2] > kMirrored * s[0]) fail_mirrored(pairs, options);
  const Vector3d axis = svd.matrixU().col(0);
  require((s[1] + d * s[2]) / s[0] >= kDegenerate, Exit::kData, pairs.name,
          ": nearly parallel forces leave the turn about sensor axis ",
          text("(%.2f, %.2f, %.2f)", axis[0], axis[1], axis[2]),
          " undetermined; add orientations that load another axis");
  return nearest_rotation(svd);
}

/// Of the power of s, a turn and a gain explain (sum w r R s)^2 / (sum w |s|^2 sum w |r|^2).
void require_explained(const ForcePairs& pairs, double product, double sensor, double reference) {
  const double share = product * product / (sensor * reference);
  require(share >= kLeastExplained, Exit::kData, pairs.name, ": ",
          text("the reference explains only %.0f %% of the measured force, however the sensor is "
               "turned",
               100.0 * share),
          "; was a payload subtracted, is the force in the base's frame, or was the tool touched? "
          "record raw forces of the sensor with the payload set to 0 kg");
}

void compare_with_nominal(const ForcePairs& pairs, const CalibrationOptions& options,
                          Calibration& result) {
  const Matrix3d& nominal = *options.nominal;
  result.nominal_angle = angle_between(result.R_ES, nominal);
  result.convention = best_convention(pairs, nominal, options.with_bias);
  if (*result.nominal_angle < kOtherMounting) return;
  const AxisConvention& c = *result.convention;
  std::string note =
      text("the mounting is %.1f deg from the nominal one", *result.nominal_angle * 180.0 / M_PI);
  if (c.axes != "+x +y +z" || c.force_sign < 0) {
    note += "; the nominal one fits" + text(" to %.3g N", c.residual_rms) +
            " with the sensor's x y z read as " + c.axes +
            (c.force_sign < 0 ? " and the force negated" : "");
  }
  result.notes.push_back(note);
}

void add_notes(const Vector3d& singular, Calibration& result) {
  if (!result.mass_kg && std::abs(result.gain - 1.0) > kGainTolerance) {
    result.notes.push_back(
        text("gain %.4f is off by more than 2 %%: check the mass, the unit of force"
             " (1 kgf = 9.81 N, 1 lbf = 4.45 N) and the sensor's matrix",
             result.gain));
  }
  if (singular[2] < kMirrored * singular[0]) {
    result.notes.push_back(
        "all forces lie nearly in one plane: a mirrored axis could not be seen; "
        "add orientations outside it");
  }
}

}  // namespace

double angle_between(const Matrix3d& A, const Matrix3d& B) {
  const Matrix3d R = A.transpose() * B;
  const Vector3d twice_sine(R(2, 1) - R(1, 2), R(0, 2) - R(2, 0), R(1, 0) - R(0, 1));
  return std::atan2(twice_sine.norm(), R.trace() - 1.0);
}

Calibration calibrate(const ForcePairs& pairs, const CalibrationOptions& options) {
  check_pairs(pairs, options.with_bias);
  RowVector3d s_mean = RowVector3d::Zero(), r_mean = RowVector3d::Zero();
  if (options.with_bias) {
    s_mean = mean(pairs.sensor, pairs.weights);
    r_mean = mean(pairs.reference, pairs.weights);
  }
  const MatrixXd s = pairs.sensor.rowwise() - s_mean, r = pairs.reference.rowwise() - r_mean;
  const MatrixXd weighted = pairs.weights.asDiagonal() * s;
  const Matrix3d H = weighted.transpose() * r;

  Calibration result;
  result.pairs = s.rows();
  result.mass_kg = pairs.mass_kg;
  result.R_ES = best_rotation(H, pairs, options);
  const double energy = weighted.cwiseProduct(s).sum();
  result.gain = (result.R_ES * H).trace() / energy;
  result.offset = r_mean.transpose() - result.R_ES * s_mean.transpose();

  require_explained(pairs, (result.R_ES * H).trace(), energy,
                    pairs.weights.dot(r.rowwise().squaredNorm()));

  const double chi2 = chi_squared(s, r, pairs.weights, result.R_ES);
  result.residual_rms = std::sqrt(chi2 / (3.0 * pairs.weights.sum()));
  const auto freedom = static_cast<double>(3 * s.rows() - (options.with_bias ? 6 : 3));
  const Matrix3d information = energy * Matrix3d::Identity() - weighted.transpose() * s;
  result.covariance = chi2 / std::max(freedom, 1.0) * information.inverse();

  add_notes(Eigen::JacobiSVD<Matrix3d>(H).singularValues(), result);
  if (!options.with_bias) suggest_bias(pairs, chi2, result);
  if (options.nominal) compare_with_nominal(pairs, options, result);
  return result;
}

}  // namespace dcnn
