#include "design/decision.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/elementary.h"
#include "dcnn/diagnosis/decision.h"

namespace dcnn::design {
namespace {

double normal_below(double z) { return 0.5 * std::erfc(-z / std::numbers::sqrt2); }

/// P(X > x), X non-central chi-square: (X/(k + l))^(1/3) is nearly normal with mean 1 - v and variance
/// v = 2 (k + 2 l)/(9 (k + l)²).
double chi_square_above(double x, double k, double l) {
  if (!(k + l > 0.0)) return x < 0.0 ? 1.0 : 0.0;
  if (x <= 0.0) return 1.0;
  const double v = 2.0 * (k + 2.0 * l) / (9.0 * (k + l) * (k + l));
  return normal_below((1.0 - v - elementary::pow(x / (k + l), 1.0 / 3.0)) / std::sqrt(v));
}

}  // namespace

double probability_above(const Contest& contest, double threshold) {
  // What moves the true structure along the difference is one of its own directions.
  const double own = contest.separation > 0.0 ? std::max(1.0, contest.own) : contest.own;
  constexpr double kHardlyAny = 0.05;  // degrees of freedom
  if (contest.rival < kHardlyAny) return chi_square_above(threshold, own, contest.separation);
  // The mean over quantiles of the rival's own part, y = rival (1 - v + z sqrt(v))³.
  constexpr int kQuantiles = 200;
  constexpr double kFarthest = 4.0;  // deviations
  const double v = 2.0 / (9.0 * contest.rival);
  double sum = 0.0, weight = 0.0;
  for (int i = 0; i < kQuantiles; ++i) {
    const double z = kFarthest * (2.0 * (i + 0.5) / kQuantiles - 1.0), w = elementary::exp(-0.5 * z * z);
    const double root = std::max(0.0, 1.0 - v + z * std::sqrt(v));
    sum += w * chi_square_above(threshold + contest.rival * root * root * root, own, contest.separation);
    weight += w;
  }
  return sum / weight;
}

double exclusion_threshold(int more) {
  if (more <= 0) return kAsLikely - kNumberPrice * more;
  return -kLeastOfMore * kNumberPrice * more;
}

}  // namespace dcnn::design
