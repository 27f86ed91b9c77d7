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

void check_rates(const Motion& motion, const Axis& axis, Index samples) {
  require(!axis.position.empty() && motion.a_B.rows() == samples, Exit::kData, "axis '", axis.name,
          "': an arm needs the position of every axis; name its column");
}

ArmLog read_arm_log(const std::filesystem::path& path, bool loaded, const System& system,
                    const JointChain& chain) {
  ArmLog log;
  log.loaded = loaded;
  log.clock.recording = read_recording(path, {}, system);
  const Recording& recording = log.clock.recording;
  const auto joints = static_cast<Index>(system.axes.size());
  const Index samples = recording.samples();
  const double nyquist = 0.5 / recording.dt;
  log.clock.cutoff_hz =
      std::min(system.lowpass_hz > 0.0 ? system.lowpass_hz : kArmCutoff, kOfNyquist * nyquist);
  DerivativeSpec derivative;
  derivative.kind = DerivativeSpec::Kind::kSpectral;
  derivative.cutoff_hz = std::min(kDerivativeBand * log.clock.cutoff_hz, kOfNyquist * nyquist);
  log.q.resize(samples, joints);
  log.v = log.a = log.q;
  MatrixXd torque(samples, joints);
  for (Index k = 0; k < joints; ++k) {
    const Axis& axis = system.axes[static_cast<std::size_t>(k)];
    const Motion motion = axis_motion(recording, axis, derivative);
    check_rates(motion, axis, samples);
    log.q.col(k) = recording.column(axis.position);
    log.v.col(k) = motion.v_B.col(0);
    log.a.col(k) = motion.a_B.col(0);
    torque.col(k) = axis.scale * recording.column(axis.measured);
  }
  log.clock.motion.segments = recording.segments;
  thin(log.clock);
  log.smooth_q = low_pass(log.q, recording.segments, recording.dt, log.clock.cutoff_hz);
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
