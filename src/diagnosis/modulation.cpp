// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/modulation.h"

#include <algorithm>
#include <cmath>

#include "diagnosis/judgement.h"
#include "diagnosis/sample_at.h"
#include "diagnosis/scan.h"

namespace dcnn {
namespace {

/// Slowly varying quantities at each whitened row, from -1 to 1, and their squares.
std::vector<Eigen::VectorXd> modulators(const Setting& setting, const Signals& prediction) {
  const Case& study = setting.study;
  const auto& info = setting.whitener.row_info();
  std::vector<Eigen::VectorXd> list;
  const auto add = [&](const auto& of_log) {
    std::vector<Eigen::VectorXd> values;
    for (std::size_t k = 0; k < study.logs.size(); ++k) values.push_back(of_log(k));
    Eigen::VectorXd rows(setting.whitener.rows());
    for (Index row = 0; row < rows.size(); ++row) {
      const auto& at = info[static_cast<std::size_t>(row)];
      const Motion& motion = study.logs[at.log].motion;
      rows(row) = values[at.log](sample_at(motion, at.t));
    }
    const double low = rows.minCoeff(), high = rows.maxCoeff();
    if (!(high > low)) return;
    list.emplace_back((2.0 * rows.array() - (high + low)) / (high - low));
    list.emplace_back(list.back().cwiseAbs2());
  };
  const auto motion = [&](std::size_t k) -> const Motion& { return study.logs[k].motion; };
  add([&](std::size_t k) -> Eigen::VectorXd { return motion(k).t; });
  for (Index c = 0; c < 3; ++c) {
    add([&](std::size_t k) -> Eigen::VectorXd { return motion(k).euler.col(c); });
  }
  for (const char* name : {"x", "y", "z"}) {
    if (!study.logs[0].recording.has(name)) continue;
    add([&](std::size_t k) -> Eigen::VectorXd { return study.logs[k].recording.column(name); });
  }
  add([&](std::size_t k) -> Eigen::VectorXd { return motion(k).w_S.rowwise().norm(); });
  if (motion(0).v_B.rows() == motion(0).samples()) {
    add([&](std::size_t k) -> Eigen::VectorXd { return motion(k).v_B.rowwise().norm(); });
  }
  for (Index j = 0; j < study.channel_count(); ++j) {
    add([&](std::size_t k) -> Eigen::VectorXd { return prediction[k].col(j); });
  }
  return list;
}

}  // namespace

std::vector<Modulation> modulations(const Setting& setting, const JointFit& fit) {
  std::vector<Modulation> most(fit.members.size());
  const Eigen::MatrixXd basis = orthonormal(fit.tangent);
  const Eigen::MatrixXd shifted = shifted_in_time(setting, fit.residual);
  for (const Eigen::VectorXd& u : modulators(setting, predict(setting.study, fit.members))) {
    for (std::size_t m = 0; m < fit.members.size(); ++m) {
      const auto [first, count] = tangent_columns(fit, m);
      if (count == 0 || fit.members[m].kind->stage == Stage::kResonance) continue;
      const Index amplitudes = fit.members[m].amplitudes.size();
      Eigen::MatrixXd c =
          u.asDiagonal() * fit.tangent.middleCols(first, amplitudes > 0 ? amplitudes : count);
      c -= basis * (basis.transpose() * c);
      const Eigen::MatrixXd own = orthonormal(c);
      const auto numbers = static_cast<double>(c.cols());
      const double gain = (own.transpose() * fit.residual).squaredNorm();
      const Eigen::RowVectorXd scores = (own.transpose() * shifted).colwise().squaredNorm();
      const double loud = overdispersion({scores.data(), scores.data() + scores.size()}, numbers);
      const Modulation found{gain - (numbers - 1.0), gain / loud - (numbers - 1.0)};
      if (found.beyond > most[m].beyond) most[m] = found;
    }
  }
  return most;
}

double second_mode(const Setting& setting, const JointFit& fit, const Member& mode) {
  return Scan(setting, fit).best_mode(mode).gain;
}

}  // namespace dcnn
