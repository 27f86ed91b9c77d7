// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "dcnn/calibration/calibration.h"
#include "dcnn/data/rotation.h"

namespace dcnn {
namespace {

constexpr double kGravity = 9.81;   // m/s^2
constexpr double kSamePose = 0.02;  // rad: a pose that was driven to twice
const std::vector<std::string> kForce{"fx", "fy", "fz"};

/// Weight of one kilogram in E, (n,3) [N].
Eigen::MatrixXd gravity_in_E(const Recording& poses) {
  const auto R_BE = rotations(poses);
  Eigen::MatrixXd gravity(poses.samples(), 3);
  for (Index i = 0; i < poses.samples(); ++i) {
    gravity.row(i) = -kGravity * R_BE[static_cast<std::size_t>(i)].row(2);
  }
  return gravity;
}

Eigen::MatrixXd centred(const Eigen::MatrixXd& x) { return x.rowwise() - x.colwise().mean(); }

/// The mass whose weight has the size of the readings: least squares over all rotations, the trace
/// of the best one being the sum of singular values (the last one negative for a reflection).
double mass_of(const Eigen::MatrixXd& sensor, const Eigen::MatrixXd& gravity) {
  const Eigen::Matrix3d H = sensor.transpose() * gravity;
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(H);
  const double sign = H.determinant() < 0 ? -1.0 : 1.0;
  const Eigen::Vector3d s = svd.singularValues();
  return (s[0] + s[1] + sign * s[2]) / gravity.squaredNorm();
}

void require_mass(std::optional<double> mass_kg) {
  require(!mass_kg || (std::isfinite(*mass_kg) && *mass_kg > 0.0), Exit::kUsage,
          "--mass-kg must be above zero");
}

}  // namespace

ForcePairs read_pairs(const std::filesystem::path& path) {
  const Table table = read_csv(path);
  const auto block = [&](const std::vector<std::string>& names) {
    Eigen::MatrixXd values(table.values.rows(), static_cast<Index>(names.size()));
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto found = std::find(table.columns.begin(), table.columns.end(), names[k]);
      require(found != table.columns.end(), Exit::kData, path.string(), ": column '", names[k],
              "' is missing; pairs have sx,sy,sz (sensor) and rx,ry,rz (reference) in N");
      values.col(static_cast<Index>(k)) = table.values.col(found - table.columns.begin());
    }
    return values;
  };
  ForcePairs pairs{path.string(),
                   block({"sx", "sy", "sz"}),
                   block({"rx", "ry", "rz"}),
                   Eigen::VectorXd::Ones(table.values.rows()),
                   {}};
  if (std::count(table.columns.begin(), table.columns.end(), "w")) {
    pairs.weights = block({"w"});
    require((pairs.weights.array() > 0.0).all(), Exit::kData, path.string(),
            ": column 'w' must be above zero; leave out the pairs that do not count");
  }
  return pairs;
}

ForcePairs weight_pairs(const Recording& loaded, const Recording& unloaded, double mass_kg) {
  require_mass(mass_kg);
  require(loaded.samples() == unloaded.samples(), Exit::kData, loaded.name, ": ", loaded.samples(),
          " poses, but ", unloaded.name, " has ", unloaded.samples(),
          "; give the same poses in the same order");
  const auto with = rotations(loaded), without = rotations(unloaded);
  for (std::size_t i = 0; i < with.size(); ++i) {
    require(angle_between(with[i], without[i]) < kSamePose, Exit::kData, loaded.name, ":", i + 2,
            ": the orientation is not that of ", unloaded.name,
            "; give the same poses in the same order");
  }
  return {loaded.name,
          loaded.block(kForce) - unloaded.block(kForce),
          mass_kg * gravity_in_E(loaded),
          Eigen::VectorXd::Ones(loaded.samples()),
          {}};
}

ForcePairs static_pairs(const Recording& poses, std::optional<double> mass_kg, bool with_bias) {
  require_mass(mass_kg);
  ForcePairs pairs{poses.name,
                   poses.block(kForce),
                   gravity_in_E(poses),
                   Eigen::VectorXd::Ones(poses.samples()),
                   {}};
  if (!mass_kg) {
    const Eigen::MatrixXd s = with_bias ? centred(pairs.sensor) : pairs.sensor;
    mass_kg = mass_of(s, with_bias ? centred(pairs.reference) : pairs.reference);
    pairs.mass_kg = mass_kg;
  }
  pairs.reference *= *mass_kg;
  return pairs;
}

}  // namespace dcnn
