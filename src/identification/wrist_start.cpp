// SPDX-License-Identifier: Apache-2.0
#include "identification/wrist_start.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "core/linear_algebra.h"

namespace dcnn::identification {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;

constexpr double kSpread = 1e-4;       // share of the field's power in a second direction
constexpr double kIndependent = 40.0;  // residuals at most: what no tool explains is alike for long
constexpr double kCertainOdds = 1e3;   // of left-handed axes over right-handed ones

MatrixXd centred(const MatrixXd& x) { return x.rowwise() - x.colwise().mean(); }

/// Log odds of the best mirrored mounting over the best that is none, from what each leaves of the
/// force. Where the force holds little weight (contacts, a payload that the controller subtracts),
/// neither explains it and nothing is said of axes.
double mirrored_evidence(const Eigen::Vector3d& singular, double force, double field, double rows) {
  const double mirrored = singular.sum(), proper = mirrored - 2.0 * singular[2];
  const auto left = [&](double sum) {
    return std::max(1.0 - sum * sum / (force * field), 1e-12);  // share of the force
  };
  return 0.5 * std::min(rows, kIndependent) * elementary::log(left(proper) / left(mirrored));
}

}  // namespace

WristState starting_state(const std::vector<WristColumns>& columns,
                          const std::vector<WristLog>& logs, const Matrix3d& nominal_R_SE,
                          bool mounting_known) {
  Matrix3d H = Matrix3d::Zero(), power = Matrix3d::Zero();
  double field = 0.0, force = 0.0, rows = 0.0;
  for (const WristColumns& c : columns) {
    const MatrixXd f = centred(c.field), F = centred(c.y.leftCols(3));
    H += F.transpose() * f;
    force += F.squaredNorm();
    rows += static_cast<double>(c.rows());
    power += f.transpose() * f;
    field += c.field.squaredNorm();
  }
  WristState state;
  state.R_SE = nominal_R_SE;
  const auto spread = spectrum_of(power).values;
  const bool turns = spread[1] > kSpread * field;
  if (!mounting_known && turns) {
    const auto svd = singular_values(H);
    const double sign = (svd.U * svd.V.transpose()).determinant() < 0.0 ? -1.0 : 1.0;
    require(sign > 0.0 || mirrored_evidence(svd.values, force, power.trace(), rows) <
                              elementary::log(kCertainOdds),
            Exit::kData, logs.front().recording.name,
            ": the force contradicts gravity in every mounting: left-handed axes, or the log holds "
            "the reaction; try --force-sign -1");
    state.R_SE = svd.U * Eigen::Vector3d(1.0, 1.0, sign).asDiagonal() * svd.V.transpose();
  }
  const double scatter = power.trace();
  state.mass = scatter > 0.0 ? (state.R_SE.transpose() * H).trace() / scatter : 0.0;
  if (!turns) state.mass = std::max(state.mass, 0.0);
  require(!mounting_known || !turns || state.mass > 0.0, Exit::kData, logs.front().recording.name,
          ": the fitted mass is ", state.mass,
          " kg: the log holds the reaction, or the mounting is another; try --force-sign -1");
  state.mass = std::max(state.mass, 1e-3);
  for (const WristColumns& c : columns) {
    state.bias += (c.y.leftCols(3) - state.mass * c.field * state.R_SE.transpose())
                      .colwise()
                      .mean()
                      .transpose() /
                  static_cast<double>(columns.size());
  }
  return state;
}

}  // namespace dcnn::identification
