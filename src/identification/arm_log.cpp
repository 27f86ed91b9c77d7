// SPDX-License-Identifier: Apache-2.0
#include "identification/arm_log.h"

#include <algorithm>
#include <cmath>

#include "dcnn/data/filter.h"
#include "dcnn/physics/axis_machine.h"

namespace dcnn::identification {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kArmCutoff = 10.0;      // Hz, where the description has none
constexpr double kDerivativeBand = 3.0;  // times the cutoff
constexpr double kOfNyquist = 0.8;

/// Positions and rates of every joint, and the torques (T, joints); rates are zero at rest.
MatrixXd read_joints(const System& system, const DerivativeSpec& derivative, ArmLog& log) {
  const Recording& recording = log.clock.recording;
  const auto joints = static_cast<Index>(system.axes.size());
  log.q = log.v = log.a = MatrixXd::Zero(recording.samples(), joints);
  MatrixXd torque(recording.samples(), joints);
  for (Index k = 0; k < joints; ++k) {
    const Axis& axis = system.axes[static_cast<std::size_t>(k)];
    require(!axis.position.empty(), Exit::kData, "axis '", axis.name,
            "': an arm needs the position of every axis; name its column");
    log.q.col(k) = recording.column(axis.position);
    torque.col(k) = axis.scale * recording.column(axis.measured);
    if (log.clock.at_rest) continue;
    const Motion motion = axis_motion(recording, axis, derivative);
    require(motion.a_B.rows() == recording.samples(), Exit::kData, "axis '", axis.name,
            "': its acceleration is not known; name the columns of its rates");
    log.v.col(k) = motion.v_B.col(0);
    log.a.col(k) = motion.a_B.col(0);
  }
  return torque;
}

ArmLog read_arm_log(const std::filesystem::path& path, bool loaded, const System& system,
                    const JointChain& chain) {
  ArmLog log;
  log.loaded = loaded;
  SourceTable source = read_table(path);
  ReadOptions options;
  log.clock.at_rest = options.static_list = is_at_rest(source.table);
  if (log.clock.at_rest) log.clock.t = take_times(source.table);
  log.clock.recording = make_recording(std::move(source), path, options, system);
  const Recording& recording = log.clock.recording;
  log.clock.motion.segments = recording.segments;
  DerivativeSpec derivative;
  if (log.clock.at_rest) {
    keep_all(log.clock);
  } else {
    const double nyquist = 0.5 / recording.dt;
    log.clock.cutoff_hz =
        std::min(system.lowpass_hz > 0.0 ? system.lowpass_hz : kArmCutoff, kOfNyquist * nyquist);
    derivative.kind = DerivativeSpec::Kind::kSpectral;
    derivative.cutoff_hz = std::min(kDerivativeBand * log.clock.cutoff_hz, kOfNyquist * nyquist);
    thin(log.clock);
  }
  const MatrixXd torque = read_joints(system, derivative, log);
  log.smooth_q = log.clock.at_rest
                     ? log.q
                     : low_pass(log.q, recording.segments, recording.dt, log.clock.cutoff_hz);
  log.torque = log.clock.thinned(torque);
  for (std::size_t j = 0; j < system.axes.size(); ++j) {
    log.rigid.push_back(log.clock.thinned(chain_regressor(chain, log.q, log.v, log.a, j)));
  }
  return log;
}

}  // namespace

std::vector<ArmLog> read_arm_logs(const std::vector<std::filesystem::path>& paths, bool loaded,
                                  const System& system, const JointChain& chain) {
  std::vector<ArmLog> logs;
  for (const auto& path : paths) logs.push_back(read_arm_log(path, loaded, system, chain));
  return logs;
}

double correlated_rows(const ArmLog& log, const VectorXd& residual) {
  const Index n = residual.size();
  const double power = residual.squaredNorm();
  double sum = 1.0;
  for (Index lag = 1; !log.clock.at_rest && lag < n / 4 && power > 0.0; ++lag) {
    const double rho = residual.head(n - lag).dot(residual.tail(n - lag)) / power;
    if (rho <= 0.0) break;
    sum += 2.0 * rho;
  }
  return sum;
}

VectorXd dahl_state(const VectorXd& q, const std::vector<Segment>& segments, double length,
                    double creep) {
  const double kept = std::exp(-creep);
  VectorXd z = VectorXd::Zero(q.size());
  for (const Segment& s : segments) {
    double state = 0.0;
    for (Index k = s.begin + 1; k < s.end; ++k) {
      const double step = q[k] - q[k - 1];
      const double side = step > 0.0 ? 1.0 : -1.0;
      if (step != 0.0) state = side + (state - side) * std::exp(-std::abs(step) / length);
      z[k] = state *= kept;
    }
  }
  return z;
}

}  // namespace dcnn::identification
