// SPDX-License-Identifier: Apache-2.0
// The lattices on which readings lie: a coarse sensor's, and the decimals of the log.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "diagnosis/detectors.h"

namespace dcnn {
namespace {

constexpr double kFinestStep = 0.9e-3;  // N
constexpr std::size_t kFewestGaps = 8;

/// The finest difference between neighbouring values, if all differences are multiples of it; else
/// 0. None of too few values to tell.
std::optional<double> lattice(const Signals& measured, Index channel) {
  std::vector<double> values;
  for (const auto& m : measured) {
    for (Index i = 0; i < m.rows(); ++i) values.push_back(m(i, channel));
  }
  std::sort(values.begin(), values.end());
  const double size = std::max(std::abs(values.front()), std::abs(values.back()));
  double step = 0.0;
  std::vector<double> gaps;
  for (std::size_t k = 1; k < values.size(); ++k) {
    const double gap = values[k] - values[k - 1];
    if (gap > 1e-9 * size) gaps.push_back(gap);
  }
  if (gaps.size() < kFewestGaps) return std::nullopt;
  if (gaps.size() > values.size() / 4) return 0.0;  // hardly a value repeats
  step = *std::min_element(gaps.begin(), gaps.end());
  double sum = 0.0, count = 0.0;
  for (const double gap : gaps) {
    const double n = std::round(gap / step);
    if (std::abs(gap / step - n) > 0.02) return 0.0;
    sum += gap;
    count += n;
  }
  return sum / count;  // over the whole range: decimals of the log average out
}

Signals measured_of(const Case& study) {
  Signals measured;
  for (const Log& log : study.logs) {
    measured.push_back(log.measured);
    // What was subtracted from a zeroed one lies on no lattice; its differences do.
    if (log.zeroed) measured.back().rowwise() -= log.measured.row(0);
  }
  return measured;
}

/// Whether all values are multiples of the step.
bool lies_on(const Signals& measured, double step) {
  for (const auto& m : measured) {
    const double* x = m.data();
    for (Index i = 0; i < m.size(); ++i) {
      const double n = x[i] / step;
      if (std::abs(n - std::round(n)) > 1e-3) return false;
    }
  }
  return true;
}

}  // namespace

double rounding_step(const Case& study) {
  const Signals measured = measured_of(study);
  double least = 0.0;
  for (Index j = 0; j < study.channel_count(); ++j) {
    if (study.channels[static_cast<std::size_t>(j)] > 2) continue;
    const std::optional<double> step = lattice(measured, j);
    if (!step) continue;  // a force that hardly changes has few values on any lattice
    if (*step < kFinestStep && !study.axis) return 0.0;
    least = least == 0.0 ? *step : std::min(least, *step);
  }
  return least;
}

double reading_digit(const Case& study) {
  constexpr double kFinestDigit = 1e-9;
  const Signals measured = measured_of(study);
  for (double decade = 1.0; decade > kFinestDigit; decade *= 0.1) {
    for (const double part : {1.0, 0.5, 0.2}) {
      if (lies_on(measured, part * decade)) return part * decade;
    }
  }
  return kFinestDigit;
}

double rounding_deviation(const Case& study, double step) {
  constexpr double kNone = std::numeric_limits<double>::infinity();
  double range = kNone;
  for (Index j = 0; j < study.channel_count(); ++j) {
    double low = kNone, high = -kNone;
    for (const Log& log : study.logs) {
      low = std::min(low, log.measured.col(j).minCoeff());
      high = std::max(high, log.measured.col(j).maxCoeff());
    }
    range = std::min(range, std::max(step, high - low));
  }
  // Both ends of the range are rounded to a digit.
  return reading_digit(study) * std::sqrt(2.0 / 12.0) * step / range;
}

}  // namespace dcnn
