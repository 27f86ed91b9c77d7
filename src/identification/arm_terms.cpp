// SPDX-License-Identifier: Apache-2.0
#include "identification/arm_terms.h"

#include <cmath>

#include "core/linear_algebra.h"

namespace dcnn::identification {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd raw_term(const ArmLog& log, Index joint, const Drive& drive, DriveTerm term) {
  const VectorXd v = log.v.col(joint);
  switch (term) {
    case DriveTerm::kOffset:
      return VectorXd::Ones(v.size());
    case DriveTerm::kViscous:
      return v;
    case DriveTerm::kRotor:
      return log.a.col(joint);
    case DriveTerm::kQuadratic:
      return v.cwiseProduct(v.cwiseAbs());
    default:
      break;
  }
  const double creep = drive.creep_s > 0.0 ? log.clock.recording.dt / drive.creep_s : 0.0;
  VectorXd z =
      dahl_state(log.smooth_q.col(joint), log.clock.motion.segments, drive.presliding, creep);
  if (term == DriveTerm::kStribeck) {
    for (Index k = 0; k < z.size(); ++k) z[k] *= std::exp(-std::abs(v[k]) / drive.slow);
  }
  return z;
}

}  // namespace

MatrixXd term_columns(const ArmLog& log, Index joint, const Drive& drive,
                      const std::vector<DriveTerm>& terms, const VectorXd& rigid) {
  MatrixXd raw(log.q.rows(), static_cast<Index>(terms.size()));
  for (std::size_t k = 0; k < terms.size(); ++k) {
    raw.col(static_cast<Index>(k)) = raw_term(log, joint, drive, terms[k]);
  }
  MatrixXd out = log.clock.thinned(raw);
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const auto column = static_cast<Index>(k);
    // The transmitted torque is known in the thinned rows alone; it is slow beside the filter.
    if (terms[k] == DriveTerm::kLoad) {
      out.col(column) = out.col(column).cwiseProduct(rigid.cwiseAbs()).eval();
    }
    if (terms[k] == DriveTerm::kGain) out.col(column) = rigid;
  }
  return out;
}

MatrixXd drive_columns(const ArmLog& log, Index joint, const Drive& drive, const VectorXd& rigid) {
  return term_columns(log, joint, drive, drive.terms, rigid);
}

MatrixXd payload_columns(const JointChain& chain, const ArmLog& log, std::size_t joint) {
  return log.rigid[joint].rightCols(10) * flange_to_link(chain);
}

MatrixXd predicted_torque(const JointChain& chain, const ArmFit& fit, const ArmLog& log) {
  MatrixXd out(log.torque.rows(), log.torque.cols());
  for (std::size_t j = 0; j < fit.drives.size(); ++j) {
    const Drive& drive = fit.drives[j];
    VectorXd rigid = log.rigid[j] * fit.x.head(10 * static_cast<Index>(fit.drives.size()));
    if (log.loaded && fit.payload >= 0) {
      rigid += payload_columns(chain, log, j) * fit.x.segment(fit.payload, 10);
    }
    rigid *= drive.gain;
    out.col(static_cast<Index>(j)) =
        rigid + drive_columns(log, static_cast<Index>(j), drive, rigid) *
                    fit.x.segment(fit.first[j], static_cast<Index>(drive.terms.size()));
  }
  return out;
}

int told_combinations(const std::vector<ArmLog>& logs) {
  constexpr double kTold = 1e-3;  // of a column's length that others must leave
  const auto joints = static_cast<Index>(logs.front().rigid.size());
  MatrixXd all(0, 10 * joints);
  for (const ArmLog& log : logs) {
    for (const MatrixXd& rows : log.rigid) {
      MatrixXd stacked(all.rows() + rows.rows(), all.cols());
      stacked << all, rows;
      all = stacked.rows() > all.cols() ? triangle_of(stacked) : stacked;
    }
  }
  return static_cast<int>(independent_columns(all, kTold).size());
}

}  // namespace dcnn::identification
