// SPDX-License-Identifier: Apache-2.0
#include "dcnn/rivals/selectors.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/linear_algebra.h"
#include "dcnn/core/random.h"
#include "rivals/gram.h"

namespace dcnn::rivals {

using Eigen::Index;
using Eigen::VectorXd;

Block sum(const std::vector<Block>& blocks) {
  Block all = blocks.front();
  for (std::size_t k = 1; k < blocks.size(); ++k) {
    all.xx += blocks[k].xx;
    all.xy += blocks[k].xy;
    all.yy += blocks[k].yy;
    all.rows += blocks[k].rows;
  }
  return all;
}

Fit least_squares(const Block& all, const Columns& chosen) {
  Fit fit{VectorXd::Zero(all.xy.size()), all.yy};
  if (chosen.empty()) return fit;
  Eigen::MatrixXd A = all.xx(chosen, chosen);
  A.diagonal().array() += 1e-6 * all.rows;  // the ridge that users set against collinear columns
  const VectorXd x = solve_symmetric(A, all.xy(chosen));
  for (std::size_t k = 0; k < chosen.size(); ++k) fit.theta(chosen[k]) = x(static_cast<Index>(k));
  fit.error = error_of(all, fit.theta);
  return fit;
}

double error_of(const Block& b, const VectorXd& theta) {
  return std::max(1e-300, b.yy - 2.0 * theta.dot(b.xy) + theta.dot(b.xx * theta));
}

double bic(const Block& all, const Fit& fit, std::size_t columns) {
  return all.rows * std::log(fit.error / all.rows) +
         static_cast<double>(columns) * std::log(all.rows);
}

namespace {

Fit thresholded(const Block& all, double threshold, Columns& chosen) {
  chosen.resize(static_cast<std::size_t>(all.xy.size()));
  for (std::size_t k = 0; k < chosen.size(); ++k) chosen[k] = static_cast<Index>(k);
  Fit fit = least_squares(all, chosen);
  for (int round = 0; round < 20 && !chosen.empty(); ++round) {
    const std::size_t before = chosen.size();
    std::erase_if(chosen, [&](Index c) { return std::abs(fit.theta(c)) < threshold; });
    fit = least_squares(all, chosen);
    if (chosen.size() == before) break;
  }
  return fit;
}

/// The threshold of the lowest BIC, from 1 % of the target's rms to all of it.
VectorXd tuned_stlsq(const Block& all) {
  const double rms = std::sqrt(all.yy / all.rows);
  VectorXd best = VectorXd::Zero(all.xy.size());
  double lowest = bic(all, {best, all.yy}, 0);
  for (double part = 0.01; part <= 1.0; part *= 1.3) {
    Columns chosen;
    const Fit fit = thresholded(all, part * rms, chosen);
    const double now = bic(all, fit, chosen.size());
    if (now < lowest) lowest = now, best = fit.theta;
  }
  return best;
}

VectorXd ensemble(const std::vector<Block>& blocks) {
  constexpr int kMembers = 50;
  Rng rng({1, 50});
  const Block all = sum(blocks);
  VectorXd votes = VectorXd::Zero(all.xy.size());
  for (int m = 0; m < kMembers; ++m) {
    std::vector<Block> drawn;
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      drawn.push_back(blocks[rng.below(blocks.size())]);
    }
    votes.array() += (tuned_stlsq(sum(drawn)).array() != 0.0).cast<double>();
  }
  Columns chosen;
  for (Index c = 0; c < votes.size(); ++c) {
    if (votes(c) >= 0.6 * kMembers) chosen.push_back(c);
  }
  return least_squares(all, chosen).theta;
}

/// Adds what `next` proposes while BIC falls; at most 12 times.
template <class Next>
VectorXd forward(const Block& all, const Next& next) {
  Columns chosen;
  Fit fit = least_squares(all, chosen);
  for (int k = 0; k < 12; ++k) {
    Columns more = chosen;
    next(fit, more);
    const Fit candidate = least_squares(all, more);
    if (more.size() == chosen.size() ||
        bic(all, candidate, more.size()) >= bic(all, fit, chosen.size())) {
      break;
    }
    chosen = more;
    fit = candidate;
  }
  return fit.theta;
}

bool among(const Columns& columns, Index c) {
  return std::find(columns.begin(), columns.end(), c) != columns.end();
}

}  // namespace

VectorXd stlsq(const Block& all, double threshold) {
  Columns chosen;
  return thresholded(all, threshold, chosen).theta;
}

VectorXd matching_pursuit(const Block& all) {
  return forward(all, [&](const Fit& fit, Columns& chosen) {
    const VectorXd left = (all.xy - all.xx * fit.theta).cwiseAbs();
    Index best = -1;
    for (Index c = 0; c < left.size(); ++c) {
      if (!among(chosen, c) && (best < 0 || left(c) > left(best))) best = c;
    }
    if (best >= 0) chosen.push_back(best);
  });
}

namespace {

VectorXd greedy(const Block& all, const std::vector<Group>& groups) {
  return forward(all, [&](const Fit&, Columns& chosen) {
    Columns best = chosen;
    double lowest = std::numeric_limits<double>::infinity();
    for (const Group& g : groups) {
      if (among(chosen, g.begin)) continue;
      Columns more = chosen;
      for (Index c = g.begin; c < g.end; ++c) more.push_back(c);
      const double now = bic(all, least_squares(all, more), more.size());
      if (now < lowest) lowest = now, best = more;
    }
    chosen = best;
  });
}

}  // namespace

const std::vector<Method>& methods() {
  using Blocks = std::vector<Block>;
  using Groups = std::vector<Group>;
  static const std::vector<Method> all{
      {"stlsq", [](const Blocks& b, const Groups&) { return tuned_stlsq(sum(b)); }},
      {"ensemble-stlsq", [](const Blocks& b, const Groups&) { return ensemble(b); }},
      {"lasso-1se",
       [](const Blocks& b, const Groups&) { return lasso_cv(b, Rule::kOneStandardError); }},
      {"lasso-min", [](const Blocks& b, const Groups&) { return lasso_cv(b, Rule::kMinimum); }},
      {"omp-bic", [](const Blocks& b, const Groups&) { return matching_pursuit(sum(b)); }},
      {"greedy-bic", [](const Blocks& b, const Groups& g) { return greedy(sum(b), g); }}};
  return all;
}

}  // namespace dcnn::rivals
