// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/base_errors.h"

#include <limits>

#include "core/linear_algebra.h"
#include "dcnn/data/filter.h"

namespace dcnn {

std::vector<Signals> base_errors(const Case& study) {
  std::vector<Signals> columns(static_cast<std::size_t>(study.logs.front().base_errors.cols()));
  for (std::size_t k = 0; k < columns.size(); ++k) {
    for (const Log& log : study.logs) {
      columns[k].push_back(low_pass(log.base_errors.col(static_cast<Index>(k)), log.motion.segments,
                                    log.motion.dt, study.lowpass_hz));
    }
  }
  return columns;
}

Eigen::VectorXd likeliest_errors(const Eigen::MatrixXd& nuisance, Index first, Index count,
                                 const Eigen::VectorXd& left) {
  constexpr Index kBlocks = 6;
  const Index columns = nuisance.cols();
  std::vector<Eigen::MatrixXd> grams;
  std::vector<Eigen::VectorXd> matches;
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(columns, columns);
  Eigen::VectorXd match = Eigen::VectorXd::Zero(columns);
  for (Index b = 0; b < kBlocks; ++b) {
    const Index begin = b * left.size() / kBlocks, end = (b + 1) * left.size() / kBlocks;
    const auto own = nuisance.middleRows(begin, end - begin);
    grams.emplace_back(own.transpose() * own);
    matches.emplace_back(own.transpose() * left.segment(begin, end - begin));
    gram += grams.back(), match += matches.back();
  }
  const auto errors = [&](Eigen::MatrixXd of, const Eigen::VectorXd& y, double d) {
    of.diagonal().segment(first, count).array() += d;
    return Eigen::VectorXd(solve_gram(of, y, kErrorRidge));
  };
  double best = 1.0, least = std::numeric_limits<double>::infinity();
  for (double d = 1.0; d <= 1e6; d *= 10.0) {
    double error = 0.0;  // but for the reading's own square
    for (std::size_t b = 0; b < grams.size(); ++b) {
      const Eigen::VectorXd x = errors(gram - grams[b], match - matches[b], d);
      error += x.dot(grams[b] * x) - 2.0 * x.dot(matches[b]);
    }
    if (error < least) least = error, best = d;
  }
  return errors(gram, match, best).segment(first, count);
}

}  // namespace dcnn
