// SPDX-License-Identifier: Apache-2.0
// Published numbers and how well they are known.
#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "core/tails.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/judgement.h"
#include "diagnosis/scan.h"

namespace dcnn {
namespace {

constexpr double kSandwichSeconds = 1.0;
constexpr double kWidest = 6.0;  // of a logarithm: more says nothing

/// Numbers of a member's published parameters at given coordinates.
Eigen::VectorXd published(const Member& member, const std::vector<std::string>& names) {
  const Json parameters = parameters_of(member);
  Eigen::VectorXd values(static_cast<Index>(names.size()));
  for (std::size_t k = 0; k < names.size(); ++k) {
    values(static_cast<Index>(k)) = parameters.at(names[k]).get<double>();
  }
  return values;
}

/// d(published)/d(coordinates) by differences.
Eigen::MatrixXd published_gradient(const Member& member, const std::vector<std::string>& names) {
  const Index amplitudes = member.amplitudes.size(), shapes = member.shapes.size();
  const Eigen::VectorXd here = published(member, names);
  Eigen::MatrixXd gradient(here.size(), amplitudes + shapes);
  for (Index k = 0; k < amplitudes + shapes; ++k) {
    Member moved = member;
    double step = 1e-6;
    if (k < amplitudes) {
      step = std::max(1e-9, 1e-5 * member.amplitudes.cwiseAbs().maxCoeff());
      moved.amplitudes(k) += step;
    } else {
      const ShapeParameter& shape = member.shape(k - amplitudes);
      double& value = moved.shapes(k - amplitudes);
      const double most = member.most_shapes(k - amplitudes);
      if (search_scale(shape, value) + step > search_scale(shape, most)) step = -step;
      value = from_search_scale(moved, k - amplitudes, search_scale(shape, value) + step);
    }
    gradient.col(k) = (published(moved, names) - here) / step;
  }
  return gradient;
}

/// The numbers that double where all amplitudes do, and nothing else: strengths, no angles.
std::vector<bool> strengths(const Member& member, const std::vector<std::string>& names) {
  Member twice = member;
  twice.amplitudes *= 2.0;
  const Eigen::VectorXd here = published(member, names), there = published(twice, names);
  std::vector<bool> list;
  for (Index k = 0; k < here.size(); ++k) {
    list.push_back(here(k) != 0.0 && std::abs(there(k) / here(k) - 2.0) < 1e-9);
  }
  return list;
}

/// The covariance of a member's coordinates with what its published numbers take from them.
struct Spread {
  Eigen::MatrixXd gradient, covariance;

  double deviation(Index k) const {
    return std::sqrt(std::max(0.0, gradient.row(k).dot(covariance * gradient.row(k).transpose())));
  }
  double correlation(Index k, Index coordinate) const {
    const double both = deviation(k) * std::sqrt(std::max(0.0, covariance(coordinate, coordinate)));
    return both > 0.0 ? gradient.row(k).dot(covariance.col(coordinate)) / both : 0.0;
  }
};

/// Whether the interval of published number k is one of its logarithm.
bool is_logarithmic(const Member& member, const Spread& spread, Index k, bool strength) {
  for (Index i = 0; i < member.shapes.size(); ++i) {
    if (member.shape(i).low <= 0.0) continue;
    const Index coordinate = member.amplitudes.size() + i;
    if (strength && std::abs(spread.correlation(k, coordinate)) > prior::kTied) return true;
    // d(value)/d(log shape) = value: it is that shape.
    const double value = member.shapes(i);
    if (std::abs(spread.gradient(k, coordinate) / value - 1.0) < 1e-3) return true;
  }
  return false;
}

Estimate interval_of(std::string name, double value, double deviation, bool logarithmic) {
  const std::string unit = unit_of_parameter(name);
  if (!logarithmic || value == 0.0) {
    return {std::move(name), unit, value, value - kNormal95 * deviation,
            value + kNormal95 * deviation};
  }
  const double factor = elementary::exp(std::min(kWidest, kNormal95 * deviation / std::abs(value)));
  const double near = value / factor, far = value * factor;
  return {std::move(name), unit, value, std::min(near, far), std::max(near, far)};
}

/// Of what a test of its own has found: independent coordinates, on the plain scale.
Eigen::MatrixXd fixed_covariance(const Member& member) {
  Eigen::VectorXd sd = member.fixed_deviation;
  for (Index k = 0; k < member.shapes.size(); ++k) {
    if (member.shape(k).low > 0.0) {
      sd(member.amplitudes.size() + k) /= member.shapes(k);  // of its logarithm
    }
  }
  return sd.cwiseAbs2().asDiagonal();
}

/// A resonance that nothing drives at its own frequency has many local minima of nearly the same
/// depth, and the curvature of one tells nothing of the others: the intervals hold all that the
/// recordings cannot tell from the best (7.81: chi-square of frequency, damping and share at 95 %).
void widen_over_local_minima(const Setting& setting, const JointFit& fit, std::size_t m,
                             std::vector<Estimate>& numbers) {
  constexpr double kWithin = 7.81 * prior::kSelection * prior::kSelection;
  std::vector<Member> others = fit.members;
  others.erase(others.begin() + static_cast<std::ptrdiff_t>(m));
  const JointFit rest = joint_fit(setting, others);
  std::vector<std::string> names;
  for (const Estimate& e : numbers) names.push_back(e.name);
  for (const Member& likely : Scan(setting, rest).as_likely(fit.members[m], kWithin)) {
    const Eigen::VectorXd values = published(likely, names);
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      const double value = values(static_cast<Index>(k));
      numbers[k].low = std::min(numbers[k].low, value);
      numbers[k].high = std::max(numbers[k].high, value);
    }
  }
}

/// Of numbers that are held at zero: the interval in which the recordings leave each.
void widen_held(const Member& member, const std::vector<std::string>& names,
                std::vector<Estimate>& numbers) {
  for (const Member::Held& held : member.held) {
    for (const double end : {held.low, held.high}) {
      Member moved = member;
      moved.amplitudes(held.amplitude) = end;
      const Eigen::VectorXd values = published(moved, names);
      for (std::size_t k = 0; k < numbers.size(); ++k) {
        if (numbers[k].value != 0.0) continue;
        numbers[k].low = std::min(numbers[k].low, values(static_cast<Index>(k)));
        numbers[k].high = std::max(numbers[k].high, values(static_cast<Index>(k)));
      }
    }
  }
}

}  // namespace

std::vector<std::vector<Estimate>> estimates(const Setting& setting, const JointFit& fit) {
  const Eigen::MatrixXd inverse = normal_inverse(fit.tangent.transpose() * fit.tangent);
  Eigen::MatrixXd middle = Eigen::MatrixXd::Zero(inverse.rows(), inverse.cols());
  for (const auto& rows : time_blocks(setting, kSandwichSeconds)) {
    const Eigen::VectorXd g = fit.tangent(rows, Eigen::all).transpose() * fit.residual(rows);
    middle += g * g.transpose();
  }
  const Eigen::MatrixXd sandwich = inverse * middle * inverse;
  std::vector<std::vector<Estimate>> all;
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    const Member& member = fit.members[m];
    const Index first = tangent_columns(fit, m).first;
    // Of a law its size and its lever are fitted beside the names.
    const Index count = member.fixed && member.law.is_null() ? 0 : member.coordinates();
    std::vector<std::string> names;
    const Json parameters = parameters_of(member);
    for (const auto& [name, value] : parameters.items()) names.push_back(name);
    const Eigen::VectorXd values = published(member, names);
    const Eigen::MatrixXd gradient = published_gradient(member, names);
    std::vector<Spread> spreads;
    if (count > 0) {
      spreads = {{gradient, inverse.block(first, first, count, count)},
                 {gradient, sandwich.block(first, first, count, count)}};
    } else if (member.fixed && member.fixed_deviation.size() > 0) {
      spreads = {{gradient, fixed_covariance(member)}};
    }
    const std::vector<bool> is_strength = strengths(member, names);
    all.emplace_back();
    for (std::size_t k = 0; k < names.size(); ++k) {
      const auto at = static_cast<Index>(k);
      const auto widest = std::max_element(
          spreads.begin(), spreads.end(),
          [at](const Spread& a, const Spread& b) { return a.deviation(at) < b.deviation(at); });
      const bool known = widest != spreads.end();
      all.back().push_back(
          interval_of(names[k], values(at), known ? prior::kSelection * widest->deviation(at) : 0.0,
                      known && is_logarithmic(member, *widest, at, is_strength[k])));
    }
    widen_held(member, names, all.back());
    if (member.kind->stage == Stage::kResonance && !setting.study.without.refinement) {
      widen_over_local_minima(setting, fit, m, all.back());
    }
  }
  return all;
}

}  // namespace dcnn
