#include "diagnosis/formula.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "diagnosis/judgement.h"
#include "diagnosis/words.h"

namespace dcnn {
namespace {

constexpr std::size_t kMostTerms = 3;
constexpr double kLeastShare = 0.5;  // of the excess, else it is no formula for it
constexpr double kBlockSeconds = 4.0;
constexpr double kWorthATerm = 0.08;  // of the excess, for a further term

/// A quantity of the log, and how it is written: one with a zero of its own (a rate, a force) as it
/// is, others as deviations from the middle of their range.
struct Quantity {
  std::string symbol, unit;
  bool has_zero = false;
  std::vector<Eigen::ArrayXd> values;  // of each log
  double middle = 0.0;

  std::string text() const {
    if (middle == 0.0) return symbol;
    return "(" + symbol + (middle < 0.0 ? " + " : " - ") + brief(std::abs(middle)) + ")";
  }
};

std::vector<Quantity> quantities(const Case& study, const Signals& prediction) {
  std::vector<Quantity> list;
  const auto add = [&](const std::string& symbol, const std::string& unit, bool has_zero,
                       const auto& of_log) {
    Quantity q{symbol, unit, has_zero, {}, 0.0};
    double low = 1e300, high = -1e300;
    for (std::size_t k = 0; k < study.logs.size(); ++k) {
      q.values.emplace_back(of_log(k));
      low = std::min(low, q.values.back().minCoeff());
      high = std::max(high, q.values.back().maxCoeff());
    }
    if (!(high > low)) return;
    if (!has_zero) {
      q.middle = 0.5 * (low + high);
      for (auto& v : q.values) v -= q.middle;
    }
    list.push_back(std::move(q));
  };
  const auto motion = [&](std::size_t k) -> const Motion& { return study.logs[k].motion; };
  const Motion& first = motion(0);
  const char* const xyz[] = {"x", "y", "z"};
  const char* const angles[] = {"alpha", "beta", "gamma"};
  for (Index c = 0; c < 3; ++c) {
    const std::string name = xyz[c];
    if (first.v_B.rows() == first.samples()) {
      add("v_" + name, "m/s", true, [&](auto k) { return motion(k).v_B.col(c).array(); });
    }
    add("w_" + name, "rad/s", true, [&](auto k) { return motion(k).w_S.col(c).array(); });
    add(angles[c], "rad", false, [&](auto k) { return motion(k).euler.col(c).array(); });
    if (study.logs[0].recording.has(name)) {
      add(name, "m", false,
          [&](auto k) -> Eigen::ArrayXd { return study.logs[k].recording.column(name).array(); });
    }
  }
  for (Index j = 0; j < study.channel_count(); ++j) {
    const auto at = static_cast<std::size_t>(j);
    add(study.targets[at] + "_sim", study.units[at], true,
        [&](auto k) { return prediction[k].col(j).array(); });
  }
  add("t", "s", false, [&](auto k) { return motion(k).t.array(); });
  return list;
}

/// A product of quantities, and its unit.
struct Term {
  std::string text, unit;
  std::vector<Eigen::ArrayXd> values;
};

std::vector<Term> terms_of(const std::vector<Quantity>& list) {
  std::vector<Term> terms;
  const auto add = [&](const std::string& text, const std::string& unit, const auto& of_log) {
    Term term{text, unit, {}};
    for (std::size_t k = 0; k < list[0].values.size(); ++k) term.values.emplace_back(of_log(k));
    terms.push_back(std::move(term));
  };
  for (std::size_t a = 0; a < list.size(); ++a) {
    const Quantity& p = list[a];
    double square = 0.0, count = 0.0;
    for (const auto& v : p.values) square += v.square().sum(), count += double(v.size());
    const double small = 0.1 * std::sqrt(square / count);
    const auto sign = [&, small](std::size_t k) { return elementary::tanh(p.values[k] / small); };
    add(p.text(), p.unit, [&](std::size_t k) { return p.values[k]; });
    add(p.text() + "^2", p.unit + "^2", [&](std::size_t k) { return p.values[k].square(); });
    add(p.text() + "^3", p.unit + "^3", [&](std::size_t k) { return p.values[k].cube(); });
    if (p.has_zero) {
      add("sgn(" + p.symbol + ")", "", sign);
      add("|" + p.symbol + "| " + p.symbol, p.unit + "^2",
          [&](std::size_t k) { return p.values[k].abs() * p.values[k]; });
    }
    for (std::size_t b = 0; b < list.size(); ++b) {
      const Quantity& q = list[b];
      if (b > a) {
        add(p.text() + " " + q.text(), p.unit + "*" + q.unit,
            [&](std::size_t k) { return p.values[k] * q.values[k]; });
      }
      if (b != a && p.has_zero) {
        add("sgn(" + p.symbol + ") " + q.text(), q.unit,
            [&](std::size_t k) { return sign(k) * q.values[k]; });
      }
    }
  }
  return terms;
}

/// A direction in which a force of unit size pushes, as channels of a log.
struct Direction {
  std::string words;
  Signals n;  // (T, channels) of each log
};

std::vector<Direction> directions(const Case& study) {
  std::vector<Direction> list;
  const char* const xyz[] = {"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    Direction sensor{std::string("the sensor's ") + xyz[axis] + " axis", {}};
    Direction base{std::string("the base's ") + xyz[axis] + " axis", {}};
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
      sensor.n.push_back(s);
      base.n.push_back(b);
    }
    if (measured) list.push_back(std::move(sensor));
    list.push_back(std::move(base));
  }
  return list;
}

std::string written(const std::vector<const Term*>& terms, const Eigen::VectorXd& size,
                    const std::string& direction) {
  std::string text;
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const double c = size(static_cast<Index>(k));
    text += k == 0 ? (c < 0.0 ? "-" : "") : (c < 0.0 ? " - " : " + ");
    text += brief(std::abs(c)) + " N";
    if (!terms[k]->unit.empty()) text += "/(" + terms[k]->unit + ")";
    text += " " + terms[k]->text;
  }
  return text + " along " + direction;
}

/// What the columns take off the residual's sum of squares in blocks of time when fitted to the
/// others.
double taken_off(const Setting& setting, const Eigen::MatrixXd& columns,
                 const Eigen::VectorXd& residual) {
  const auto blocks = time_blocks(setting, kBlockSeconds);
  double taken = 0.0;
  for (std::size_t fold = 0; fold < 2; ++fold) {
    std::vector<Index> rows[2];
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      auto& part = rows[b % 2 == fold];
      part.insert(part.end(), blocks[b].begin(), blocks[b].end());
    }
    const Eigen::VectorXd size = least_squares(columns(rows[0], Eigen::all), residual(rows[0]));
    const Eigen::VectorXd there = residual(rows[1]);
    taken += there.squaredNorm() - (there - columns(rows[1], Eigen::all) * size).squaredNorm();
  }
  return taken;
}

/// Terms as whitened columns along one direction, beside what the fit knows.
std::vector<Eigen::VectorXd> columns_along(const Setting& setting, const Eigen::MatrixXd& known,
                                           const std::vector<Term>& terms,
                                           const Direction& direction) {
  std::vector<Eigen::VectorXd> columns(terms.size());
  for_each_piece(static_cast<Index>(terms.size()), [&](Index t) {
    const auto at = static_cast<std::size_t>(t);
    Signals signals;
    for (std::size_t k = 0; k < direction.n.size(); ++k) {
      signals.push_back(terms[at].values[k].matrix().asDiagonal() * direction.n[k]);
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

std::optional<Formula> formula_of(const Setting& setting, const JointFit& fit) {
  const Case& study = setting.coarse;
  if (study.is_static() || study.axis) return std::nullopt;
  const double excess = fit.chi2 - (setting.mask.sum() - static_cast<double>(fit.tangent.cols()));
  if (!(excess > 0.0)) return std::nullopt;
  const auto terms = terms_of(quantities(study, predict(study, fit.members)));
  const Eigen::MatrixXd known = orthonormal(fit.tangent);
  std::optional<Formula> best;
  for (const Direction& direction : directions(study)) {
    const auto columns = columns_along(setting, known, terms, direction);
    std::vector<const Term*> chosen;
    Eigen::MatrixXd basis(fit.residual.size(), 0), own = basis;
    Eigen::VectorXd left = fit.residual;
    while (chosen.size() < kMostTerms) {
      const auto [next, gain] = best_of(columns, basis, left);
      if (gain < kWorthATerm * excess) break;
      chosen.push_back(&terms[next]);
      own = appended(own, columns[next]);
      basis = orthonormal(own);
      left = fit.residual - basis * (basis.transpose() * fit.residual);
    }
    if (chosen.empty()) continue;
    const double share = taken_off(setting, own, fit.residual) / excess;
    if (share < std::max(kLeastShare, best ? best->share : 0.0)) continue;
    best = Formula{written(chosen, least_squares(own, fit.residual), direction.words), share};
  }
  return best;
}

}  // namespace dcnn
