// SPDX-License-Identifier: Apache-2.0
#include "design/decision.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/elementary.h"
#include "core/tails.h"
#include "dcnn/diagnosis/decision.h"

namespace dcnn::design {
namespace {

double normal_below(double z) { return normal_tail(-z); }

/// Normal deviates for means over quantiles, and their weights.
struct Quantiles {
  std::vector<double> z, weight;
};
Quantiles quantiles() {
  constexpr int kCount = 60;
  constexpr double kFarthest = 4.0;  // deviations
  Quantiles q;
  double sum = 0.0;
  for (int i = 0; i < kCount; ++i) {
    q.z.push_back(kFarthest * (2.0 * (i + 0.5) / kCount - 1.0));
    q.weight.push_back(elementary::exp(-0.5 * q.z.back() * q.z.back()));
    sum += q.weight.back();
  }
  for (double& w : q.weight) w /= sum;
  return q;
}

/// The quantile of a chi-square that belongs to a normal deviate: k (1 - v + z sqrt(v))³, v = 2/(9
/// k) (Wilson and Hilferty 1931).
double chi_square_quantile(double k, double z) {
  constexpr double kHardlyAny = 0.05;  // degrees of freedom
  if (k < kHardlyAny) return 0.0;
  const double v = 2.0 / (9.0 * k), root = std::max(0.0, 1.0 - v + z * std::sqrt(v));
  return k * root * root * root;
}

}  // namespace

double probability_above(const Contest& contest, double threshold) {
  // (Z + d)² + V - W: Z along the difference, V of the other own directions, W of the rival's.
  const bool along = contest.own > 0.0 || contest.separation > 0.0;
  const double others = std::max(0.0, contest.own - 1.0), d = std::sqrt(contest.separation);
  const Quantiles q = quantiles();
  double sum = 0.0;
  for (std::size_t i = 0; i < q.z.size(); ++i) {
    const double w = chi_square_quantile(contest.rival, q.z[i]);
    for (std::size_t j = 0; j < q.z.size(); ++j) {
      const double x = threshold + w - chi_square_quantile(others, q.z[j]);
      double p = x < 0.0 ? 1.0 : 0.0;
      if (along && x >= 0.0) p = normal_below(d - std::sqrt(x)) + normal_below(-d - std::sqrt(x));
      sum += q.weight[i] * q.weight[j] * p;
      if (others == 0.0) {  // one value of V stands for all
        sum += q.weight[i] * (1.0 - q.weight[j]) * p;
        break;
      }
    }
  }
  return std::min(1.0, sum);  // of weights that sum to 1 but for rounding
}

double exclusion_threshold(int more) {
  if (more <= 0) return kAsLikely - kNumberPrice * more;
  return -kLeastOfMore * kNumberPrice * more;
}

}  // namespace dcnn::design
