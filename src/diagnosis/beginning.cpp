// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/beginning.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

/// exp(-way/width) of the angle's way since the first sample, as a force along the cable.
Wrench bent_cable(const Member& member, const Motion& motion, bool with_torque) {
  const double width = member.shapes(0);
  const AngleAxis at = angle_axis(member.axis);
  Wrench wrench{Eigen::MatrixXd::Zero(motion.samples(), 3),
                Eigen::MatrixXd::Zero(with_torque ? motion.samples() : 0, 3)};
  Eigen::VectorXd left = Eigen::VectorXd::Ones(motion.samples());
  for (Index i = 1; i < left.size(); ++i) {
    const double way = motion.euler(i, at.angle) - motion.euler(i - 1, at.angle);
    left(i) = left(i - 1) * elementary::exp(-std::abs(way) / width);
  }
  push_along(at.axis, motion, left, wrench);
  add_moment(lever_of(member), Eigen::MatrixXd::Zero(left.size(), 3), wrench);
  return wrench;
}

/// What a load that came just before has yet to settle: F(0) exp(-t/tau) of every channel.
/// `measured` is the log at its own rate.
Eigen::MatrixXd late_load(const Motion& motion, const Log& measured, double tau) {
  constexpr double kFirst = 0.05;  // s, over which noise is averaged
  const Index rows = std::min(measured.measured.rows(),
                              std::max<Index>(1, std::llround(kFirst / measured.motion.dt)));
  const Eigen::RowVectorXd load = measured.measured.topRows(rows).colwise().mean();
  Eigen::MatrixXd left(motion.samples(), load.size());
  for (Index i = 0; i < left.rows(); ++i) {
    left.row(i) = load * elementary::exp(-(motion.t(i) - motion.t(0)) / tau);
  }
  return left;
}

}  // namespace

bool begins_anywhere(const Case& study, const Member& member) {
  return member.kind->begins_anywhere && (!study.axis || member.kind->stage == Stage::kForce);
}

Eigen::MatrixXd beginnings(const Setting& setting, const Member& member, Detail detail) {
  const bool coarse = detail == Detail::kCoarse;
  const Case& study = coarse ? setting.coarse : setting.study;
  if (!begins_anywhere(study, member)) return {setting.whitener.rows(), 0};
  const auto logs = static_cast<Index>(study.logs.size());
  Eigen::MatrixXd columns(setting.whitener.rows(), logs);
  for (Index k = 0; k < logs; ++k) {
    Signals signals;
    for (const Log& log : study.logs) {
      const bool here = static_cast<Index>(signals.size()) == k;
      if (!here) {
        signals.push_back(Eigen::MatrixXd::Zero(log.motion.samples(), study.channel_count()));
      } else if (member.kind->stage == Stage::kForce) {
        signals.push_back(measured_part(study, bent_cable(member, log.motion, study.has_torque())));
      } else {
        const Log& logged = setting.study.logs[static_cast<std::size_t>(k)];
        signals.push_back(late_load(log.motion, logged, member.shapes(0)));
      }
    }
    columns.col(k) = coarse ? setting.coarse_whitener(signals).cwiseProduct(setting.mask)
                            : setting.whitened(signals);
  }
  return columns;
}

}  // namespace dcnn
