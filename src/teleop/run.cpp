// SPDX-License-Identifier: Apache-2.0
#include "dcnn/teleop/teleop.h"
#include "teleop/sides.h"

namespace dcnn {
namespace {

using Eigen::Vector3d;

/// The external force in B as a variant knows it.
Vector3d estimate(Variant& variant, SlaveSide& slave, const Eigen::Matrix3d& R_ES) {
  if (variant.kind == Variant::Kind::kIdeal) return slave.contact();
  if (variant.kind == Variant::Kind::kNone) return Vector3d::Zero();
  Vector3d force = slave.measured();
  if (variant.compensator) {
    force -= variant.compensator->push(slave.body().x, slave.orientation());
  }
  return rotation_from_euler(slave.orientation()) * R_ES * force;
}

}  // namespace

TeleopTrace run_teleop(const TeleopConfig& config, Variant& variant, const Eigen::Matrix3d& R_ES,
                       std::uint64_t seed) {
  const auto ticks = static_cast<Index>(std::lround(config.duration_s / kTeleopTick));
  TeleopTrace trace = make_trace(ticks);
  SlaveSide slave(config, seed);
  MasterSide master(config, seed);
  for (Index k = 0; k < ticks; ++k) {
    const double t = static_cast<double>(k) * kTeleopTick;
    slave.begin(t);
    const Vector3d estimated = estimate(variant, slave, R_ES);
    const Command command = master.control(estimated);
    store(k, config, {slave.body().x, slave.contact(), estimated, slave.orientation()}, master,
          trace);
    slave.integrate(command);
    master.integrate(t);
  }
  return trace;
}

}  // namespace dcnn
