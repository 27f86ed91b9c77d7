// SPDX-License-Identifier: Apache-2.0
// Minimisation without derivatives (Nelder and Mead 1965).
#include <algorithm>

#include "diagnosis/scan.h"

namespace dcnn {

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
