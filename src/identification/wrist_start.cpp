#include "identification/wrist_start.h"

#include "core/linear_algebra.h"

namespace dcnn::identification {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;

constexpr double kSpread = 1e-4;     // share of the field's power in a second direction
constexpr double kMirrored = 0.05;  // third singular value over the first: no noise makes it so

MatrixXd centred(const MatrixXd& x) { return x.rowwise() - x.colwise().mean(); }

}  // namespace

WristState starting_state(const std::vector<WristColumns>& columns,
                          const std::vector<WristLog>& logs, const Matrix3d& nominal_R_SE,
                          bool mounting_known) {
  Matrix3d H = Matrix3d::Zero(), power = Matrix3d::Zero();
  double field = 0.0;
  for (const WristColumns& c : columns) {
    const MatrixXd f = centred(c.field);
    H += centred(c.y.leftCols(3)).transpose() * f;
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
    require(sign > 0.0 || svd.values[2] < kMirrored * svd.values[0], Exit::kData,
            logs.front().recording.name,
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
                      .colwise().mean().transpose() / static_cast<double>(columns.size());
  }
  return state;
}

}  // namespace dcnn::identification
