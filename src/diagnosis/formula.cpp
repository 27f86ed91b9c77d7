// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/formula.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"

namespace dcnn {
namespace {

/// A quantity of the log: one with a zero of its own (a rate, a force) as it is, others as
/// deviations from the middle of their range.
struct Quantity {
  bool has_zero = false;
  std::vector<Eigen::ArrayXd> values;  // of each log
};

std::vector<Quantity> quantities(const Case& study, const Signals& prediction) {
  std::vector<Quantity> list;
  const auto add = [&](bool has_zero, const auto& of_log) {
    Quantity q{has_zero, {}};
    double low = 1e300, high = -1e300;
    for (std::size_t k = 0; k < study.logs.size(); ++k) {
      q.values.emplace_back(of_log(k));
      low = std::min(low, q.values.back().minCoeff());
      high = std::max(high, q.values.back().maxCoeff());
    }
    if (!(high > low)) return;
    if (!has_zero) {
      for (auto& v : q.values) v -= 0.5 * (low + high);
    }
    list.push_back(std::move(q));
  };
  const auto motion = [&](std::size_t k) -> const Motion& { return study.logs[k].motion; };
  const Motion& first = motion(0);
  const char* const xyz[] = {"x", "y", "z"};
  for (Index c = 0; c < 3; ++c) {
    const std::string name = xyz[c];
    if (first.v_B.rows() == first.samples()) {
      add(true, [&](auto k) { return motion(k).v_B.col(c).array(); });
    }
    add(true, [&](auto k) { return motion(k).w_S.col(c).array(); });
    add(false, [&](auto k) { return motion(k).euler.col(c).array(); });
    if (study.logs[0].recording.has(name)) {
      add(false,
          [&](auto k) -> Eigen::ArrayXd { return study.logs[k].recording.column(name).array(); });
    }
  }
  for (Index j = 0; j < study.channel_count(); ++j) {
    add(true, [&](auto k) { return prediction[k].col(j).array(); });
  }
  add(false, [&](auto k) { return motion(k).t.array(); });
  return list;
}

/// A product of quantities, by log.
using Term = std::vector<Eigen::ArrayXd>;

std::vector<Term> terms_of(const std::vector<Quantity>& list) {
  std::vector<Term> terms;
  const auto add = [&](const auto& of_log) {
    Term term;
    for (std::size_t k = 0; k < list[0].values.size(); ++k) term.emplace_back(of_log(k));
    terms.push_back(std::move(term));
  };
  for (std::size_t a = 0; a < list.size(); ++a) {
    const Quantity& p = list[a];
    double square = 0.0, count = 0.0;
    for (const auto& v : p.values) square += v.square().sum(), count += double(v.size());
    const double small = 0.1 * std::sqrt(square / count);
    const auto sign = [&, small](std::size_t k) { return elementary::tanh(p.values[k] / small); };
    add([&](std::size_t k) { return p.values[k]; });
    add([&](std::size_t k) { return p.values[k].square(); });
    add([&](std::size_t k) { return p.values[k].cube(); });
    if (p.has_zero) {
      add(sign);
      add([&](std::size_t k) { return p.values[k].abs() * p.values[k]; });
    }
    for (std::size_t b = 0; b < list.size(); ++b) {
      const Quantity& q = list[b];
      if (b > a) {
        add([&](std::size_t k) { return p.values[k] * q.values[k]; });
      }
      if (b != a && p.has_zero) {
        add([&](std::size_t k) { return sign(k) * q.values[k]; });
        if (!q.has_zero) add([&](std::size_t k) { return sign(k) * q.values[k].square(); });
      }
    }
  }
  return terms;
}

/// A direction in which a force of unit size pushes: (T, channels) of each log.
using Direction = Signals;

std::vector<Direction> directions(const Case& study) {
  std::vector<Direction> list;
  for (int axis = 0; axis < 3; ++axis) {
    Direction sensor, base;
    bool measured = false;
    for (const Log& log : study.logs) {
      const Index rows = log.motion.samples();
      Eigen::MatrixXd s = Eigen::MatrixXd::Zero(rows, study.channel_count()), b = s;
      for (Index j = 0; j < study.channel_count(); ++j) {
        const int channel = study.channels[static_cast<std::size_t>(j)];
        if (channel > 2) continue;
        if (channel == axis) s.col(j).setOnes(), measured = true;
        for (Index i = 0; i < rows; ++i) {
          b(i, j) = log.motion.R_BS[static_cast<std::size_t>(i)](axis, channel);
        }
      }
      sensor.push_back(s);
      base.push_back(b);
    }
    if (measured) list.push_back(std::move(sensor));
    list.push_back(std::move(base));
  }
  return list;
}

/// Terms as whitened columns along one direction, beside what the fit knows.
std::vector<Eigen::VectorXd> columns_along(const Setting& setting, const Eigen::MatrixXd& known,
                                           const std::vector<Term>& terms,
                                           const Direction& direction) {
  std::vector<Eigen::VectorXd> columns(terms.size());
  for_each_piece(static_cast<Index>(terms.size()), [&](Index t) {
    const auto at = static_cast<std::size_t>(t);
    Signals signals;
    for (std::size_t k = 0; k < direction.size(); ++k) {
      signals.push_back(terms[at][k].matrix().asDiagonal() * direction[k]);
    }
    const Eigen::VectorXd c = setting.coarse_whitener(signals).cwiseProduct(setting.mask);
    columns[at] = c - known * (known.transpose() * c);
  });
  return columns;
}

/// The column that takes most off `left` beside a basis of others, and how much.
std::pair<std::size_t, double> best_of(const std::vector<Eigen::VectorXd>& columns,
                                       const Eigen::MatrixXd& basis, const Eigen::VectorXd& left) {
  std::pair<std::size_t, double> best{0, 0.0};
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const Eigen::VectorXd c = columns[k] - basis * (basis.transpose() * columns[k]);
    const double energy = c.squaredNorm();
    if (!(energy > 1e-4 * columns[k].squaredNorm())) continue;
    const double gain = elementary::pow(c.dot(left), 2) / energy;
    if (gain > best.second) best = {k, gain};
  }
  return best;
}

}  // namespace

double most_of_a_term(const Setting& setting, const JointFit& fit) {
  const Case& study = setting.coarse;
  const auto terms = terms_of(quantities(study, predict(study, fit.members)));
  const Eigen::MatrixXd known = orthonormal(fit.tangent), none(fit.residual.size(), 0);
  double most = 0.0;
  for (const Direction& direction : directions(study)) {
    const auto columns = columns_along(setting, known, terms, direction);
    most = std::max(most, best_of(columns, none, fit.residual).second);
  }
  return most;
}

}  // namespace dcnn
