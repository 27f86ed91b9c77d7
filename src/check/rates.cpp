// SPDX-License-Identifier: Apache-2.0
#include "check/rates.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "check/joints.h"
#include "check/statistics.h"
#include "core/elementary.h"
#include "data/held_rows.h"
#include "dcnn/core/number.h"

namespace dcnn::check {
namespace {

using Eigen::Index;
constexpr double kPerDegree = 180.0 / std::numbers::pi;
constexpr double kRateOff = 0.1;     // of a factor that matters: filters lower a rate, too
constexpr double kRateError = 0.03;  // of a rate's deviation: its own filter, its own delay

/// Rows that move by more than the rms of the motion: at rest there is nothing to compare, and the
/// logged rate's noise there would favour the meaning that divides it by most.
std::vector<Index> moving_rows(const Eigen::MatrixXd& rate) {
  const Eigen::VectorXd square = rate.rowwise().squaredNorm();
  const double mean = square.mean();
  std::vector<Index> moving;
  for (Index i = 0; i < square.size(); ++i) {
    if (square(i) >= mean) moving.push_back(i);
  }
  return moving;
}

Eigen::Map<const Eigen::VectorXd> as_vector(const std::vector<double>& values) {
  return {values.data(), static_cast<Index>(values.size())};
}

}  // namespace

std::vector<RateMeaning> rate_meanings(const Eigen::MatrixXd& rate, bool turns, bool radians) {
  std::vector<RateMeaning> all{{rate, 1.0, "as declared"}, {-rate, 1.0, "of the other sign"}};
  if (turns && radians) {
    all.push_back({rate, kPerDegree, "in degrees per second where the position is in radians"});
  }
  if (turns && !radians) {
    all.push_back(
        {rate, 1.0 / kPerDegree, "in radians per second where the position is in degrees"});
  }
  if (turns) all.push_back({rate, 30.0 / std::numbers::pi, "in revolutions per minute"});
  all.push_back({rate, 1e3, "1000 times too large (milli-units, or a clock in ms)"});
  all.push_back({rate, 1e-3, "1000 times too small"});
  return all;
}

double rate_cost(const Eigen::MatrixXd& logged, const RateMeaning& meaning, double independent) {
  const std::vector<Index> moving = moving_rows(meaning.rate);
  const Eigen::MatrixXd rate = meaning.scale * meaning.rate(moving, Eigen::all);
  const Eigen::MatrixXd off = logged(moving, Eigen::all) - rate;
  const double variance = median(off.rowwise().squaredNorm());
  const auto rows = static_cast<double>(rate.rows());
  const double size = rate.squaredNorm() / rows;
  const double share = rows / static_cast<double>(meaning.rate.rows());
  return 0.5 * share * independent *
         elementary::log(std::max(variance + kRateError * kRateError * size, 1e-300));
}

double unrelated_cost(const Eigen::MatrixXd& logged, const Eigen::MatrixXd& rate,
                      double independent) {
  return rate_cost(logged, {rate, 0.0, "unrelated"}, independent);
}

std::optional<RateMeaning> scaled_rate(const Eigen::MatrixXd& logged,
                                       const std::vector<RateMeaning>& known) {
  const std::vector<Index> moving = moving_rows(known[0].rate);
  const Eigen::MatrixXd rate = known[0].rate(moving, Eigen::all);
  const double factor =
      logged(moving, Eigen::all).cwiseProduct(rate).sum() / std::max(rate.squaredNorm(), 1e-300);
  if (factor <= 0.0) return std::nullopt;
  const bool is_known = std::any_of(known.begin(), known.end(), [&](const RateMeaning& meaning) {
    return std::abs(factor / meaning.scale - 1.0) < kRateOff;
  });
  if (is_known) return std::nullopt;
  const double price = elementary::log(kRateDecades * std::numbers::ln10 / kRateError);
  const std::string words = brief(factor) + " times that: in another unit, or by another clock";
  return RateMeaning{known[0].rate, factor, words, price};
}

std::vector<JointRate> joint_rates(const Log& log, const Sampled& rows, const Reading& reading) {
  std::vector<JointRate> out;
  const double dt = log.step * reading.clock;
  for (const Joint& joint : log.joints) {
    if (joint.position.empty() || joint.velocity.empty()) continue;
    if (never_changes(log.column(joint.position))) continue;
    const double angle = joint.turns ? reading.angle : 1.0, unit = joint.turns ? reading.rate : 1.0;
    const Eigen::MatrixXd rate = angle / dt * rows.smoothed(log.column(joint.position), rows.first);
    if (rate.norm() == 0.0) continue;
    out.push_back({joint.velocity, joint.position, joint.turns,
                   rows.smoothed(log.column(joint.velocity), rows.value), unit,
                   rate_meanings(rate, joint.turns, angle == unit && angle == 1.0)});
  }
  return out;
}

double rates_weight(const Log& log, const Sampled& rows, const Reading& reading) {
  if (rows.half == 0 || rows.centres.size() < 12) return 0.0;
  const double independent = independent_residuals(log, rows);
  double each = 0.0;
  std::vector<double> all;  // of one meaning for every rate
  for (const JointRate& joint : joint_rates(log, rows, reading)) {
    const auto others = static_cast<double>(joint.meanings.size() - 1);
    std::vector<double> terms;
    for (std::size_t k = 0; k < joint.meanings.size(); ++k) {
      // A density of what was logged, in the units of the file.
      RateMeaning meaning = joint.meanings[k];
      meaning.scale /= joint.unit;
      const double prior = k == 0 ? 1.0 - kFaultPrior : kFaultPrior / others;
      const double weight = -rate_cost(joint.logged, meaning, independent);
      terms.push_back(elementary::log(prior) + weight);
      if (all.size() <= k) all.push_back(elementary::log(prior));
      all[k] += weight;
    }
    terms.push_back(elementary::log(kFaultPrior) -
                    unrelated_cost(joint.logged, joint.meanings[0].rate, independent));
    each += log_sum(as_vector(terms));
  }
  if (all.empty()) return 0.0;
  all.push_back(each);
  return log_sum(as_vector(all));
}

}  // namespace dcnn::check
