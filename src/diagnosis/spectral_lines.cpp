#include "diagnosis/spectral_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/elementary.h"
#include "dcnn/data/fourier.h"

namespace dcnn {

Eigen::VectorXd hann_power(const Eigen::VectorXd& x, Index length) {
  const Index n = x.size();
  const Eigen::ArrayXd phase = Eigen::ArrayXd::LinSpaced(n, 0.5, static_cast<double>(n) - 0.5) *
                               2.0 * std::numbers::pi / double(n);
  Eigen::VectorXd tapered = Eigen::VectorXd::Zero(length);
  tapered.head(n) = (x.array() - x.mean()) * (1.0 - elementary::cos(phase));
  return fourier(tapered).cwiseAbs2() / (1.5 * static_cast<double>(n));
}

namespace {

constexpr Index kFewestBeside = 12;  // bins, on each side

/// The mean level beside bin k of a sum of `terms` periodograms, from its median; none of a
/// spectrum with nothing beside it.
std::optional<double> level_beside(const Eigen::VectorXd& power, Index k, Index around, int terms) {
  std::vector<double> beside;
  for (Index i = std::max<Index>(1, k - around); i < std::min(power.size(), k + around); ++i) {
    if (std::abs(i - k) > 3) beside.push_back(power(i));
  }
  if (beside.empty()) return std::nullopt;
  const auto middle = beside.begin() + static_cast<std::ptrdiff_t>(beside.size() / 2);
  std::nth_element(beside.begin(), middle, beside.end());
  // Of an exponential distribution, and nearly of a gamma distribution.
  const double median = terms == 1 ? elementary::log(2.0) : 1.0 - 1.0 / (3.0 * terms);
  return *middle / median;
}

/// The bins of local maxima between two frequencies, the greatest first, none near a greater one.
std::vector<Index> maxima(const Eigen::VectorXd& power, const Eigen::VectorXd& relative,
                          double bin_hz, double from_hz, double to_hz, int most) {
  std::vector<Index> bins;
  for (Index k = 2; k + 2 < power.size(); ++k) {
    const double hz = static_cast<double>(k) * bin_hz;
    if (hz < from_hz || hz > to_hz || power(k) < power(k - 1) || power(k) < power(k + 1)) continue;
    bins.push_back(k);
  }
  std::sort(bins.begin(), bins.end(), [&](Index a, Index b) { return relative(a) > relative(b); });
  std::vector<Index> apart;
  for (const Index k : bins) {
    const bool near = std::any_of(apart.begin(), apart.end(), [&](Index other) {
      const double hz = static_cast<double>(k) * bin_hz;
      return std::abs(static_cast<double>(other - k)) * bin_hz < std::max(0.1, 0.04 * hz);
    });
    if (!near) apart.push_back(k);
    if (static_cast<int>(apart.size()) == most) break;
  }
  return apart;
}

Eigen::VectorXd densities(const Floor& floor, Index bins, double bin_hz) {
  Eigen::VectorXd density(bins);
  for (Index k = 0; k < bins; ++k) {
    density(k) = std::max(1e-300, floor.density(static_cast<double>(k) * bin_hz));
  }
  return density;
}

}  // namespace

std::vector<Peak> spectral_lines(const Case& study, const Signals& left,
                                 const std::vector<Floor>& floors, double from_hz, double to_hz,
                                 Index channel, int most) {
  // The longest recording tells frequencies best.
  const auto longest = std::max_element(
      left.begin(), left.end(), [](const auto& a, const auto& b) { return a.rows() < b.rows(); });
  const Index length = fast_length(longest->rows());
  const double bin_hz = 1.0 / (static_cast<double>(length) * study.dt());
  const Eigen::VectorXd power = hann_power(longest->col(channel), length);
  const Eigen::VectorXd ratio = power.cwiseQuotient(
      densities(floors[static_cast<std::size_t>(channel)], power.size(), bin_hz));
  std::vector<Peak> peaks;
  for (const Index k : maxima(power, ratio, bin_hz, from_hz, to_hz, most)) {
    peaks.push_back({static_cast<double>(k) * bin_hz, ratio(k)});
  }
  return peaks;
}

bool CommonLine::stands_out() const { return excess > 13.5 + 5.0 * std::sqrt(terms); }

std::vector<CommonLine> common_lines(const Case& study, const Signals& left,
                                     const std::vector<Floor>& floors, double from_hz, double to_hz,
                                     int most) {
  Index longest = 0;
  for (const auto& recording : left) longest = std::max(longest, recording.rows());
  const Index length = fast_length(longest);
  const double bin_hz = 1.0 / (static_cast<double>(length) * study.dt());
  const auto around = std::max(kFewestBeside, static_cast<Index>(1.5 / bin_hz));
  const auto terms = static_cast<int>(floors.size() * left.size());
  Eigen::VectorXd sum;
  for (std::size_t j = 0; j < floors.size(); ++j) {
    Eigen::VectorXd density;
    for (const auto& recording : left) {
      const Eigen::VectorXd power = hann_power(recording.col(static_cast<Index>(j)), length);
      if (density.size() == 0) density = densities(floors[j], power.size(), bin_hz);
      if (sum.size() == 0) sum = Eigen::VectorXd::Zero(power.size());
      sum += power.cwiseQuotient(density);
    }
  }
  std::vector<CommonLine> lines;
  for (const Index k : maxima(sum, sum, bin_hz, from_hz, to_hz, most)) {
    const auto level = level_beside(sum, k, around, terms);
    if (!level) continue;
    const double unit = std::max(1e-300, *level / terms);
    lines.push_back({static_cast<double>(k) * bin_hz, sum(k), sum(k) / unit - terms, terms});
  }
  return lines;
}

}  // namespace dcnn
