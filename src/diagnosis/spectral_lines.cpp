#include "diagnosis/spectral_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dcnn/data/fourier.h"

namespace dcnn {

Eigen::VectorXd hann_power(const Eigen::VectorXd& x, Index length) {
  const Index n = x.size();
  const Eigen::ArrayXd phase = Eigen::ArrayXd::LinSpaced(n, 0.5, static_cast<double>(n) - 0.5) *
                               2.0 * std::numbers::pi / double(n);
  Eigen::VectorXd tapered = Eigen::VectorXd::Zero(length);
  tapered.head(n) = (x.array() - x.mean()) * (1.0 - phase.cos());
  return fourier(tapered).cwiseAbs2() / (1.5 * static_cast<double>(n));
}

std::vector<Peak> spectral_lines(const Case& study, const Signals& left,
                                 const std::vector<Floor>& floors, double from_hz, double to_hz,
                                 Index channel, int most) {
  // The longest recording tells frequencies best.
  std::size_t longest = 0;
  for (std::size_t k = 0; k < left.size(); ++k) {
    if (left[k].rows() > left[longest].rows()) longest = k;
  }
  const Floor& floor = floors[static_cast<std::size_t>(channel)];
  const double dt = study.dt();
  const Index length = fast_length(left[longest].rows());
  const Eigen::VectorXd power = hann_power(left[longest].col(channel), length);
  // A line stands out of what is beside it, whatever the floor may be there.
  const auto around = static_cast<Index>(1.5 * static_cast<double>(length) * dt);
  const auto level_beside = [&](Index k) {
    std::vector<double> beside;
    for (Index i = std::max<Index>(1, k - around); i < std::min(power.size(), k + around); ++i) {
      if (std::abs(i - k) > 3) beside.push_back(power(i));
    }
    const auto middle = beside.begin() + static_cast<std::ptrdiff_t>(beside.size() / 2);
    std::nth_element(beside.begin(), middle, beside.end());
    return *middle / std::log(2.0);  // of an exponential distribution: its mean from its median
  };
  std::vector<Peak> peaks;
  for (Index k = 2; k + 2 < power.size(); ++k) {
    const double hz = static_cast<double>(k) / (static_cast<double>(length) * dt);
    if (hz < from_hz || hz > to_hz || power(k) < power(k - 1) || power(k) < power(k + 1)) continue;
    peaks.push_back({hz, power(k) / std::max(1e-300, floor.density(hz)), 0.0});
  }
  std::sort(peaks.begin(), peaks.end(), [](auto& a, auto& b) { return a.ratio > b.ratio; });
  std::vector<Peak> apart;
  for (const Peak& peak : peaks) {
    const bool near = std::any_of(apart.begin(), apart.end(), [&](const Peak& other) {
      return std::abs(other.hz - peak.hz) < std::max(0.1, 0.04 * peak.hz);
    });
    if (!near) apart.push_back(peak);
    if (static_cast<int>(apart.size()) == most) break;
  }
  for (Peak& peak : apart) {
    const auto k = std::llround(peak.hz * static_cast<double>(length) * dt);
    peak.prominence = power(k) / std::max(1e-300, level_beside(k));
  }
  return apart;
}

}  // namespace dcnn
