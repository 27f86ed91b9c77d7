// SPDX-License-Identifier: Apache-2.0
// What the pose's own noise puts into the prediction.
#include <algorithm>
#include <cmath>
#include <utility>

#include "data/bridge.h"
#include "data/median.h"
#include "data/spectral.h"
#include "dcnn/data/rotation.h"
#include "diagnosis/noise_floor.h"
#include "diagnosis/periodograms.h"

namespace dcnn {
namespace {

/// Of the pose's filter, over all coordinates and recordings; none where rates are logged or
/// another estimator differentiates.
std::vector<double> mean_gain(const Case& study) {
  constexpr Index kSteps = 400, kFewestInSegment = 8;  // rows of a segment that has a spectrum
  if (study.derivative.kind != DerivativeSpec::Kind::kSpectral) return {};
  const LowPass filter{study.derivative.cutoff_hz, study.derivative.subtraction,
                       study.derivative.most_noise, study.derivative.fastest_hz};
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(kSteps);
  double columns = 0.0;
  for (const Log& log : study.logs) {
    const Eigen::MatrixXd pose = log.recording.has_all(kPosition) ? log.recording.block(kPosition)
                                                                  : quaternions(log.recording);
    const Bridged even = bridged(pose, log.recording);
    for (const Segment& s : even.segments) {
      for (Index j = 0; j < pose.cols() && s.size() > kFewestInSegment; ++j, ++columns) {
        sum += gain_of(even.columns.col(j).segment(s.begin, s.size()), study.dt(), filter, kSteps);
      }
    }
  }
  sum /= std::max(1.0, columns);
  return {sum.begin(), sum.end()};
}

}  // namespace

void add_pose_noise(const Case& study, std::vector<Floor>& floors) {
  if (study.is_static() || study.axis) return;
  const auto quiet_density = [&](const std::vector<std::string>& names) {
    double most = 0.0;
    for (const auto& name : names) {
      Case even;  // of which only the clock matters
      Signals pose;
      for (const Log& log : study.logs) {
        if (!log.recording.has(name)) return 0.0;
        Eigen::VectorXd x = log.recording.column(name);
        if (names.size() == 3 && name != "x" && name != "y" && name != "z") unwrap(x);
        Bridged clocked = bridged(x, log.recording);
        pose.push_back(std::move(clocked.columns));
        even.logs.emplace_back();
        even.logs.back().motion.dt = study.dt();
        even.logs.back().motion.segments = std::move(clocked.segments);
      }
      const Periodograms p = periodograms(even, pose, 0);
      const Eigen::VectorXd density = density_of(p);
      std::vector<double> quiet;
      for (Index i = 0; i < p.hz.size(); ++i) {
        if (p.hz(i) >= quiet_band(study) && p.hz(i) <= 0.49 / study.dt()) {
          quiet.push_back(density(i));
        }
      }
      if (!quiet.empty()) most = std::max(most, median(quiet));
    }
    return most;
  };
  const ToolModel& tool = study.simulator.model;
  const double position = quiet_density({"x", "y", "z"});
  const bool angles = study.logs.front().recording.has("alpha");
  const double angle = angles ? quiet_density({"alpha", "beta", "gamma"})
                              : 4.0 * quiet_density({"qw", "qx", "qy", "qz"});
  const double lever = tool.mass * tool.com.norm(), weight = tool.mass * tool.gravity.norm();
  const bool moving = tool.inertial != ToolModel::Inertial::kNone;
  const std::vector<double> gain = mean_gain(study);
  for (std::size_t j = 0; j < floors.size(); ++j) {
    floors[j].pose_gain = gain;
    const bool force = study.channels[j] < 3;
    const double arm = force ? 1.0 : tool.com.norm();
    floors[j].static_part = weight * weight * angle * arm * arm;
    floors[j].moving_part =
        moving ? (tool.mass * tool.mass * position + lever * lever * angle) * arm * arm : 0.0;
  }
}

}  // namespace dcnn
