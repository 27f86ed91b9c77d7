// SPDX-License-Identifier: Apache-2.0
#include "data/spikes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/elementary.h"
#include "core/tails.h"
#include "data/median.h"
#include "data/resolution.h"
#include "dcnn/core/number.h"

namespace dcnn {
namespace {

constexpr double kLeast = 8.0;         // deviations from the neighbours: nearer ones show nothing
constexpr double kLonely = 0.3;        // of a spike's height: how far its neighbours are apart
constexpr double kOnALine = 1e-3;      // of large distances: rounding of rows filled in by lines
constexpr double kByNoise = 0.001;     // probability below which a row is called no reading
constexpr std::size_t kFew = 3;        // rows of a recording that may be lost, however short it is
constexpr double kMostSpikes = 0.001;  // of its rows: more are heavy-tailed noise, or impacts

/// x_i less the median of its four neighbours, (T); 0 at the ends.
Eigen::VectorXd off_neighbours(const Eigen::VectorXd& x) {
  Eigen::VectorXd out = Eigen::VectorXd::Zero(x.size());
  for (Index i = 2; i + 2 < x.size(); ++i) {
    double near[4] = {x[i - 2], x[i - 1], x[i + 1], x[i + 2]};
    std::sort(near, near + 4);
    out[i] = x[i] - 0.5 * (near[1] + near[2]);
  }
  return out;
}

struct Spike {
  double height = 0.0;  ///< in deviations
  Index row = 0;
};

/// Single rows far from their neighbours, the farthest first.
std::vector<Spike> lonely_rows(const Eigen::VectorXd& x, const Eigen::VectorXd& far, double scale) {
  std::vector<Spike> spikes;
  for (Index i = 3; i + 3 < x.size(); ++i) {
    const double height = std::abs(far[i]);
    const Eigen::Vector4d near(x[i - 2], x[i - 1], x[i + 1], x[i + 2]);
    const double beside = near.maxCoeff() - near.minCoeff();
    if (height < kLeast * scale || beside > kLonely * height || x[i] == 0.0) continue;
    spikes.push_back({height / scale, i});
  }
  std::sort(spikes.begin(), spikes.end(),
            [](const Spike& a, const Spike& b) { return a.height > b.height; });
  return spikes;
}

}  // namespace

double heavy_tail(double z) { return 19.0 / elementary::pow(z, 5); }

Outliers least_likely_outliers(const std::vector<double>& heights, Index rows) {
  Outliers out;
  for (std::size_t k = 1; k <= heights.size(); ++k) {
    const double mean = static_cast<double>(rows) * heavy_tail(heights[k - 1]);
    const double p = poisson_tail(static_cast<double>(k), mean);
    if (p < out.p) out = {k, p};
  }
  out.p = std::min(1.0, static_cast<double>(heights.size()) * out.p);
  if (out.count == 0) out.p = 1.0;
  return out;
}

double deviation_of_moving(const Eigen::VectorXd& distances) {
  std::vector<double> sizes;
  for (const double value : distances) {
    if (value != 0.0) sizes.push_back(std::abs(value));
  }
  if (sizes.empty()) return 0.0;
  std::sort(sizes.begin(), sizes.end());
  const double large = sizes[static_cast<std::size_t>(0.9 * static_cast<double>(sizes.size()))];
  const auto moving = std::lower_bound(sizes.begin(), sizes.end(), kOnALine * large);
  if (moving - sizes.begin() > sizes.end() - moving) sizes.erase(sizes.begin(), moving);
  return kDeviationOfMedian * median(std::move(sizes));
}

std::string Spikes::words(const std::string& column) const {
  const bool one = rows.size() == 1;
  return std::to_string(rows.size()) + (one ? " outlier in " : " outliers in ") + column +
         (one ? ", " : ", up to ") + brief(height) + " standard deviations from " +
         (one ? "its" : "their") + " neighbours";
}

Spikes spikes_of(const Eigen::VectorXd& values) {
  const Eigen::VectorXd far = off_neighbours(values);
  const double scale = std::max(deviation_of_moving(far), 0.5 * resolution(values));
  if (scale <= 0.0) return {};
  const std::vector<Spike> all = lonely_rows(values, far, scale);
  std::vector<double> heights;
  for (const Spike& spike : all) heights.push_back(spike.height);
  const Outliers outliers = least_likely_outliers(heights, values.size());
  Spikes spikes;
  if (outliers.count == 0) return spikes;
  for (std::size_t k = 0; k < outliers.count; ++k) spikes.rows.push_back(all[k].row);
  std::sort(spikes.rows.begin(), spikes.rows.end());
  spikes.height = all[0].height;
  spikes.p = outliers.p;
  return spikes;
}

void mend_spikes(Recording& recording, const std::vector<std::string>& columns) {
  if (recording.dt == 0.0) return;
  for (const std::string& name : columns) {
    if (!recording.has(name)) continue;
    Eigen::VectorXd x = recording.column(name);
    const Spikes spikes = spikes_of(x);
    const auto most = static_cast<std::size_t>(kMostSpikes * static_cast<double>(x.size()));
    if (spikes.p >= kByNoise || spikes.rows.size() > std::max(kFew, most)) continue;
    const Eigen::VectorXd far = off_neighbours(x);
    for (const Index row : spikes.rows) x[row] -= far[row];
    recording.set(name, x);
    recording.notes.push_back(spikes.words(name) + "; replaced by the median of the neighbours");
  }
}

}  // namespace dcnn
