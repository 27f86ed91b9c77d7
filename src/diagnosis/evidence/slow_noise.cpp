// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/evidence/slow_noise.h"

#include <cmath>
#include <map>

#include "core/elementary.h"
#include "dcnn/data/fourier.h"
#include "diagnosis/evidence/marginal.h"
#include "diagnosis/evidence/priors.h"

namespace dcnn::evidence {
namespace {

constexpr double kHighest = 3.0;  // Hz, of the transform
constexpr int kCorners = 12, kLevels = 8;

struct Term {
  double hz, square;
};

/// Squares of the orthonormal cosine transform of each channel's runs, without the mean.
std::map<std::uint32_t, std::vector<Term>> transformed(const Grid& grid,
                                                       const Eigen::VectorXd& residual) {
  std::map<std::uint32_t, std::vector<Term>> terms;
  for (const Grid::Run& run : grid.runs()) {
    const auto n = static_cast<double>(run.count);
    const Eigen::VectorXd sums = cosine_transform(residual.segment(run.first, run.count));
    for (Index k = 1; k < run.count; ++k) {
      const double hz = static_cast<double>(k) / (2.0 * n * grid.seconds());
      if (hz > kHighest) break;
      terms[run.channel].push_back({hz, sums(k) * sums(k) * 2.0 / n});
    }
  }
  return terms;
}

}  // namespace

SlowNoise slow_noise(const Grid& grid, const Eigen::VectorXd& residual) {
  SlowNoise noise;
  noise.log_factor = elementary::log(prior::kSlowNoise / (1.0 - prior::kSlowNoise));
  if (grid.study().is_static()) return noise;
  for (const auto& entry : transformed(grid, residual)) {
    const std::vector<Term>& terms = entry.second;
    std::vector<double> factors;
    const auto weigh = [&](const auto& density_at) {
      double factor = 0.0;
      for (const Term& term : terms) {
        const double density = density_at(term.hz);
        factor -= 0.5 * (elementary::log(density) + term.square * (1.0 / density - 1.0));
      }
      return factor;
    };
    // 1/f noise and a first-order Gauss-Markov process, either as likely as the other.
    const double one_over_f = elementary::log(2.0 * kCorners);
    const double markov = elementary::log(2.0 * kCorners * kLevels);
    for (int k = 0; k < kCorners; ++k) {
      const double corner =
          prior::kLeastCorner *
          elementary::pow(prior::kMostCorner / prior::kLeastCorner, k / (kCorners - 1.0));
      factors.push_back(weigh([&](double hz) { return 1.0 + corner / hz; }) - one_over_f);
      for (int l = 0; l < kLevels; ++l) {
        const double level = elementary::pow(prior::kMostSlowNoise, (l + 0.5) / kLevels);
        factors.push_back(
            weigh([&](double hz) { return 1.0 + level / (1.0 + (hz / corner) * (hz / corner)); }) -
            markov);
      }
    }
    noise.log_factor += log_sum(factors);
    for (double from = kHighest / 64.0; from < kHighest; from *= 2.0) {
      double sum = 0.0, count = 0.0;
      for (const Term& term : terms) {
        if (term.hz >= from && term.hz < 2.0 * from) sum += term.square, ++count;
      }
      // Beyond what so few squares of normal numbers reach by chance.
      const double most =
          prior::kMostSlowNoise * (1.0 + 3.0 * std::sqrt(2.0 / std::max(1.0, count)));
      if (count > 0.0 && sum / count > most) noise.plausible = false;
    }
  }
  return noise;
}

}  // namespace dcnn::evidence
