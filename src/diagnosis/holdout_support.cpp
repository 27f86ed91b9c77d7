// SPDX-License-Identifier: Apache-2.0
// What held-out data say of two predictions, over all channels and in each.
#include <cmath>
#include <map>
#include <numeric>

#include "core/linear_algebra.h"
#include "diagnosis/base_errors.h"
#include "diagnosis/holdout.h"

namespace dcnn {
namespace {

constexpr double kErrorBlock = 1.0;  // s, over which errors count as one

}  // namespace

std::pair<Signals, Signals> HoldOut::of_base_errors(const Signals& a, const Signals& b) const {
  const std::vector<Signals> errors = base_errors(study_);
  if (errors.empty()) return {};
  const auto count = static_cast<Index>(errors.size());
  Eigen::MatrixXd gram = Eigen::MatrixXd::Zero(count, count),
                  match = Eigen::MatrixXd::Zero(count, 2);
  std::vector<Eigen::MatrixXd> columns;
  for (std::size_t k = 0; k < a.size(); ++k) {
    columns.emplace_back(a[k].rows(), count);
    for (Index c = 0; c < count; ++c) columns[k].col(c) = errors[static_cast<std::size_t>(c)][k];
    for (Index i = 0; i < a[k].rows(); ++i) {
      if (!held_[k][static_cast<std::size_t>(i)]) continue;
      const auto row = columns[k].row(i);
      const double measured = study_.logs[k].measured(i, 0);
      gram += row.transpose() * row;
      match.col(0) += row.transpose() * (measured - a[k](i, 0));
      match.col(1) += row.transpose() * (measured - b[k](i, 0));
    }
  }
  const Eigen::MatrixXd sizes = solve_gram(gram, match, kErrorRidge);
  std::pair<Signals, Signals> signals;
  for (const Eigen::MatrixXd& each : columns) {
    signals.first.emplace_back(each * sizes.col(0));
    signals.second.emplace_back(each * sizes.col(1));
  }
  return signals;
}

std::vector<double> HoldOut::support_by_channel(const Signals& a, const Signals& b,
                                                const std::vector<Floor>& floors,
                                                const std::vector<double>& gained) const {
  std::vector<double> list;
  for (Index j = 0; j < study_.channel_count(); ++j) {
    list.push_back(
        evidence::log_support(changes({j}, a, b, floors, {}), gained[static_cast<std::size_t>(j)]));
  }
  return list;
}

double HoldOut::log_support(const Signals& a, const Signals& b, const std::vector<Floor>& floors,
                            const std::vector<double>& noisier) const {
  std::vector<Index> all(static_cast<std::size_t>(study_.channel_count()));
  std::iota(all.begin(), all.end(), 0);
  return evidence::log_support(changes(all, a, b, floors, noisier));
}

std::vector<evidence::BlockChange> HoldOut::changes(const std::vector<Index>& channels,
                                                    const Signals& a, const Signals& b,
                                                    const std::vector<Floor>& floors,
                                                    const std::vector<double>& noisier) const {
  std::vector<double> deviation;
  for (const Floor& floor : floors) deviation.push_back(floor.whole_deviation());
  // An error of the base is no reason for either.
  const auto [with_base, without_base] = of_base_errors(a, b);
  std::map<std::pair<std::size_t, std::int64_t>, evidence::BlockChange> blocks;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const Log& log = study_.logs[k];
    for (Index i = 0; i < a[k].rows(); ++i) {
      if (!held_[k][static_cast<std::size_t>(i)]) continue;
      const auto number =
          log.motion.is_static()
              ? i
              : static_cast<std::int64_t>(std::floor(log.motion.t(i) / kErrorBlock));
      evidence::BlockChange& block = blocks[{k, number}];
      for (const Index j : channels) {
        const double s = deviation[static_cast<std::size_t>(j)];
        double with_it = log.measured(i, j) - a[k](i, j),
               without_it = log.measured(i, j) - b[k](i, j);
        if (!with_base.empty()) with_it -= with_base[k](i, j), without_it -= without_base[k](i, j);
        with_it /= s, without_it /= s;
        const double more = noisier.empty() ? 0.0 : noisier[static_cast<std::size_t>(j)] / (s * s);
        block.fall += without_it * without_it - with_it * with_it + more;
        block.apart += (without_it - with_it) * (without_it - with_it);
      }
    }
  }
  std::vector<evidence::BlockChange> list;
  for (const auto& [key, block] : blocks) list.push_back(block);
  return list;
}

double HoldOut::share_explained(const Signals& with, const Signals& without,
                                const Eigen::VectorXd& noise, Index block) const {
  const Index channels = study_.channel_count();
  std::vector<evidence::MeanSquares> squares(static_cast<std::size_t>(channels));
  double blocks = 0.0;
  for (std::size_t k = 0; k < with.size(); ++k) {
    const Index size = study_.logs[k].motion.is_static() ? 1 : block;
    Eigen::RowVectorXd a = Eigen::RowVectorXd::Zero(channels), b = a;  // sums of errors
    Index rows = 0;
    for (Index i = 0; i < with[k].rows(); ++i) {
      if (!held_[k][static_cast<std::size_t>(i)]) {
        rows = 0, a.setZero(), b.setZero();
        continue;
      }
      a += study_.logs[k].measured.row(i) - with[k].row(i);
      b += study_.logs[k].measured.row(i) - without[k].row(i);
      if (++rows < size) continue;
      for (Index j = 0; j < channels; ++j) {
        squares[static_cast<std::size_t>(j)].add(a(j), b(j), double(size) * std::sqrt(noise(j)));
      }
      blocks += 1.0;
      rows = 0, a.setZero(), b.setZero();
    }
  }
  return evidence::share_explained(squares, blocks);
}

}  // namespace dcnn
