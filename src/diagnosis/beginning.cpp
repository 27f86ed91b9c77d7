#include "diagnosis/beginning.h"

#include <cmath>

#include "core/elementary.h"
#include "physics/effect_law.h"

namespace dcnn {

Eigen::MatrixXd beginnings(const Setting& setting, const Member& member, Detail detail) {
  const bool coarse = detail == Detail::kCoarse;
  const Case& study = coarse ? setting.coarse : setting.study;
  if (member.name() != "hysteresis") return {setting.whitener.rows(), 0};
  const double width = member.shapes(0);
  const AngleAxis at = angle_axis(member.axis);
  const auto logs = static_cast<Index>(study.logs.size());
  Eigen::MatrixXd columns(setting.whitener.rows(), logs);
  for (Index k = 0; k < logs; ++k) {
    Signals signals;
    for (const Log& log : study.logs) {
      const Motion& motion = log.motion;
      Wrench wrench{Eigen::MatrixXd::Zero(motion.samples(), 3),
                    Eigen::MatrixXd::Zero(study.has_torque() ? motion.samples() : 0, 3)};
      if (static_cast<Index>(signals.size()) == k) {
        Eigen::VectorXd left = Eigen::VectorXd::Ones(motion.samples());
        for (Index i = 1; i < left.size(); ++i) {
          const double way = motion.euler(i, at.angle) - motion.euler(i - 1, at.angle);
          left(i) = left(i - 1) * elementary::exp(-std::abs(way) / width);
        }
        push_along(at.axis, motion, left, wrench);
        add_moment(lever_of(member), Eigen::MatrixXd::Zero(left.size(), 3), wrench);
      }
      signals.push_back(measured_part(study, wrench));
    }
    columns.col(k) = coarse ? setting.coarse_whitener(signals).cwiseProduct(setting.mask)
                            : setting.whitened(signals);
  }
  return columns;
}

}  // namespace dcnn
