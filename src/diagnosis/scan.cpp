#include "diagnosis/scan.h"

#include <algorithm>
#include <cmath>

namespace dcnn {
namespace {

constexpr double kUnit =
    1e-3;  // amplitude of a column: small enough for angles, large for rounding

/// Amplitudes an effect cannot have without being another one.
bool is_itself(const Case& study, const Member& member) {
  const std::string name = member.name();
  // On an axis the position says which way a force resists.
  if (study.axis && name == "hysteresis") return member.amplitudes(0) > 0.0;
  if (study.axis && name == "flexible_resonance") return member.shapes(1) < 0.5;
  if (name != "stribeck_friction") return true;
  const double ratio = member.amplitudes(1) / std::max(1e-300, member.amplitudes(0));
  return ratio > 1.0 && (!study.axis || ratio < 4.0);
}

}  // namespace

Scan::Scan(const Setting& setting, const JointFit& fit)
    : setting_(setting),
      chain_(setting.study, fit.members),
      coarse_chain_(setting.coarse, fit.members),
      here_(setting.whitened(chain_.prediction())),
      coarse_here_(setting.coarse_whitener(coarse_chain_.prediction()).cwiseProduct(setting.mask)),
      basis_(orthonormal(setting.study.without.projection ? setting.nuisance : fit.tangent)) {
  residual_ = off_model(fit.residual);
}

Eigen::MatrixXd Scan::off_model(const Eigen::MatrixXd& columns) const {
  return columns - basis_ * (basis_.transpose() * columns);
}

Eigen::MatrixXd Scan::columns(const Member& member, Detail detail) const {
  const bool coarse = detail == Detail::kCoarse;
  const Chain& chain = coarse ? coarse_chain_ : chain_;
  const Eigen::VectorXd& here = coarse ? coarse_here_ : here_;
  const auto with = [&](const Member& extra) -> Eigen::VectorXd {
    const Signals signals = chain.with(extra);
    if (!coarse) return setting_.whitened(signals);
    return setting_.coarse_whitener(signals).cwiseProduct(setting_.mask);
  };
  Member unit = member;
  if (member.amplitudes.size() == 0) return with(unit) - here;
  Eigen::MatrixXd columns(here.size(), member.amplitudes.size());
  // From a common point with all amplitudes alike, since some laws divide by one of them.
  const bool needs_origin = member.amplitudes.size() == 2;
  Eigen::VectorXd origin = here;
  if (needs_origin) {
    unit.amplitudes.setConstant(kUnit);
    origin = with(unit);
  }
  for (Index j = 0; j < columns.cols(); ++j) {
    unit.amplitudes.setConstant(needs_origin ? kUnit : 0.0);
    unit.amplitudes(j) += kUnit;
    columns.col(j) = (with(unit) - origin) / kUnit;
  }
  return columns;
}

Trial Scan::evaluate(const Member& member, Detail detail) const {
  Trial trial;
  trial.member = member;
  trial.price = setting_.price;
  const Eigen::MatrixXd raw = columns(member, detail), c = off_model(raw);
  const double energy = raw.squaredNorm();
  trial.kept = energy > 0.0 ? c.squaredNorm() / energy : 0.0;
  const Eigen::VectorXd match = c.transpose() * residual_;
  if (member.amplitudes.size() == 0) {
    trial.gain = std::max(0.0, 2.0 * match(0) - c.squaredNorm());
    return trial;
  }
  trial.member.amplitudes = least_squares(c, residual_);
  const Eigen::MatrixXd gram = c.transpose() * c;
  trial.deviation =
      gram.diagonal().unaryExpr([](double g) { return g > 0.0 ? 1.0 / std::sqrt(g) : 0.0; });
  if (!trial.member.amplitudes.allFinite()) return trial;
  const bool wrong_sign = member.form->non_negative && trial.member.amplitudes.minCoeff() < 0.0;
  if (wrong_sign || !is_itself(setting_.study, trial.member)) return trial;
  trial.gain = std::max(0.0, match.dot(trial.member.amplitudes));
  return trial;
}

std::optional<double> Scan::least_detectable(const Member& member) const {
  constexpr double kTestable = 0.002;  // share of the energy that must be its own
  constexpr double kPower = 1.28;      // of a normal at 90 %
  const Eigen::MatrixXd raw = columns(member, Detail::kCoarse), own = off_model(raw);
  Index best = 0;
  own.colwise().squaredNorm().maxCoeff(&best);
  const double energy = own.col(best).squaredNorm();
  if (!(energy > kTestable * raw.col(best).squaredNorm()) || energy == 0.0) return std::nullopt;
  const double needed = std::sqrt(30.0 + 10.0 * member.parameters()) + kPower;
  Member unit = member;
  double scale = 1.0;
  if (member.amplitudes.size() > 0) {
    unit.amplitudes.setConstant(member.amplitudes.size() == 2 ? kUnit : 0.0);
    unit.amplitudes(best) += kUnit;
    scale = kUnit;
  }
  double most = 0.0;
  const Signals with = coarse_chain_.with(unit), &without = coarse_chain_.prediction();
  for (Index j = 0; j < setting_.study.channel_count(); ++j) {
    double square = 0.0, count = 0.0;
    for (std::size_t k = 0; k < with.size(); ++k) {
      square += (with[k].col(j) - without[k].col(j)).squaredNorm();
      count += static_cast<double>(with[k].rows());
    }
    most = std::max(most, std::sqrt(square / count));
  }
  return most / scale * needed / std::sqrt(energy);
}

/// A line over all recordings is far narrower than one in a recording, from which its frequency was
/// seeded: the best of a comb first.
Trial Scan::tuned(const Trial& start, Detail detail) const {
  Trial best = start;
  const double width = 0.6 / longest_seconds(setting_.study);
  const double step = std::max(0.25 / span_seconds(setting_.study), width / 40.0);
  for (double away = -width; away <= width; away += step) {
    Member member = start.member;
    member.shapes(0) += away;
    const Trial trial = evaluate(member, detail);
    if (trial.gain > best.gain) best = trial;
  }
  return best;
}

Trial Scan::refine(const Trial& seed, Detail detail, int evaluations) const {
  const bool is_line = seed.member.name() == "hum" && !setting_.study.without.refinement;
  const Trial start = is_line && detail == Detail::kCoarse ? tuned(seed, detail) : seed;
  const auto& shapes = start.member.form->shapes;
  const Index n = start.member.shapes.size();
  if (n == 0 || setting_.study.without.refinement) return start;
  Eigen::VectorXd x(n), size(n);
  for (Index i = 0; i < n; ++i) {
    const ShapeParameter& shape = shapes[static_cast<std::size_t>(i)];
    x(i) = search_scale(shape, start.member.shapes(i));
    size(i) = shape.low > 0.0 ? 0.4 : 0.15 * (shape.high - shape.low);
    if (detail == Detail::kFine) size(i) *= 0.2;
    if (start.member.name() == "cogging") size(i) = 0.01;
    if (is_line) size(i) = 0.1 / (span_seconds(setting_.study) * start.member.shapes(i));
    if (start.member.name() == "flexible_resonance" && i == 0) size(i) = 0.05;
  }
  Trial best = start;
  const auto loss = [&](const Eigen::VectorXd& at) {
    Member member = start.member;
    for (Index i = 0; i < n; ++i) {
      member.shapes(i) = from_search_scale(member, i, at(i));
    }
    const Trial trial = evaluate(member, detail);
    if (trial.gain > best.gain) best = trial;
    return -trial.gain;
  };
  simplex_search(loss, x, size, n == 1 ? evaluations * 2 / 3 : evaluations);
  return best;
}

Eigen::VectorXd simplex_search(const std::function<double(const Eigen::VectorXd&)>& f,
                               const Eigen::VectorXd& x, const Eigen::VectorXd& size,
                               int evaluations) {
  const Index n = x.size();
  std::vector<std::pair<double, Eigen::VectorXd>> points{{f(x), x}};
  for (Index i = 0; i < n; ++i) {
    Eigen::VectorXd p = x;
    p(i) += size(i);
    points.emplace_back(f(p), p);
  }
  const auto by_value = [](const auto& a, const auto& b) { return a.first < b.first; };
  for (int used = static_cast<int>(n) + 1; used < evaluations;) {
    std::stable_sort(points.begin(), points.end(), by_value);
    auto& worst = points.back();
    Eigen::VectorXd centre = Eigen::VectorXd::Zero(n);
    for (Index i = 0; i < n; ++i) centre += points[static_cast<std::size_t>(i)].second;
    centre /= static_cast<double>(n);
    const auto at = [&](double factor) {
      Eigen::VectorXd p = centre + factor * (worst.second - centre);
      ++used;
      return std::pair{f(p), p};
    };
    auto trial = at(-1.0);
    if (trial.first < points.front().first) {
      auto further = at(-2.0);
      worst = further.first < trial.first ? further : trial;
    } else if (trial.first < points[static_cast<std::size_t>(n - 1)].first) {
      worst = trial;
    } else {
      auto inner = at(trial.first < worst.first ? -0.5 : 0.5);
      if (inner.first < std::min(trial.first, worst.first)) {
        worst = inner;
      } else {
        for (std::size_t i = 1; i < points.size(); ++i) {
          points[i].second = 0.5 * (points[i].second + points[0].second);
          points[i].first = f(points[i].second);
          ++used;
        }
      }
    }
    if ((points.back().second - points.front().second).cwiseAbs().maxCoeff() <
        1e-3 * size.maxCoeff())
      break;
  }
  return std::min_element(points.begin(), points.end(), by_value)->second;
}

}  // namespace dcnn
