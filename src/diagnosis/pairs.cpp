// SPDX-License-Identifier: Apache-2.0
// Two members at once, against one or two others: what a greedy search cannot see.
#include <algorithm>

#include "core/linear_algebra.h"
#include "diagnosis/candidates.h"
#include "diagnosis/search.h"

namespace dcnn {
namespace {

constexpr std::size_t kMost = 26;  // linear candidates compared

bool is_linear(const Member& member) {
  return member.own_shapes() == 0 && member.amplitudes.size() > 0 && !member.interval_s;
}

/// The gain of fitting these columns, from the Gram matrix of all.
double gain_of(const Eigen::MatrixXd& gram, const Eigen::VectorXd& match,
               const std::vector<Index>& columns) {
  const Eigen::VectorXd b = match(columns);
  return b.dot(solve_gram(gram(columns, columns), b, 1e-9).col(0));
}

struct Pool {
  std::vector<Member> members;
  std::vector<std::vector<Index>> columns;  // of the matrix below
  Eigen::MatrixXd gram;
  Eigen::VectorXd match;
  double price = kNumberPrice;

  double net_gain(std::vector<std::size_t> chosen) const {
    std::vector<Index> all;
    for (const std::size_t k : chosen) all.insert(all.end(), columns[k].begin(), columns[k].end());
    return gain_of(gram, match, all) - price * static_cast<double>(all.size());
  }
};

Pool make_pool(const Scan& scan, const std::vector<Member>& list) {
  std::vector<Trial> trials;
  for (const Member& member : list) {
    if (is_linear(member)) trials.push_back(scan.evaluate(member));
  }
  std::stable_sort(trials.begin(), trials.end(),
                   [](const Trial& a, const Trial& b) { return a.gain > b.gain; });
  if (trials.size() > kMost) trials.resize(kMost);
  Pool pool;
  pool.price = scan.setting().price;
  std::vector<Eigen::MatrixXd> parts;
  Index count = 0;
  for (const Trial& trial : trials) {
    parts.push_back(scan.off_model(scan.columns(trial.member)));
    pool.members.push_back(trial.member);
    pool.columns.emplace_back();
    for (Index k = 0; k < parts.back().cols(); ++k, ++count) {
      if (!parts.back().col(k).isZero(0.0)) pool.columns.back().push_back(count);
    }
  }
  Eigen::MatrixXd all(scan.residual().size(), count);
  Index at = 0;
  for (const auto& part : parts) {
    all.middleCols(at, part.cols()) = part;
    at += part.cols();
  }
  pool.gram = all.transpose() * all;
  pool.match = all.transpose() * scan.residual();
  return pool;
}

}  // namespace

bool Search::replace_pairs() {
  const auto& members = fit_.members;
  for (std::size_t a = 0; a < members.size(); ++a) {
    for (std::size_t b = a + 1; b < members.size(); ++b) {
      if (!is_linear(members[a]) || !is_linear(members[b])) continue;
      std::vector<Member> rest;
      for (std::size_t m = 0; m < members.size(); ++m) {
        if (m != a && m != b) rest.push_back(members[m]);
      }
      const JointFit base = joint_fit(*setting_, rest);
      const Scan scan(*setting_, base);
      const Signals left = difference(study_, scan.chain().prediction());
      std::vector<Member> list = candidates(scan, left, floors_);
      std::erase_if(list, [&](const Member& m) { return was_refuted(m); });
      const Pool pool = make_pool(scan, list);
      const double own = base.chi2 - fit_.chi2 -
                         setting_->price * (members[a].parameters() + members[b].parameters());
      double most = own + 0.2 * setting_->price;
      std::vector<std::size_t> best;
      for (std::size_t i = 0; i < pool.members.size(); ++i) {
        for (std::size_t j = i; j < pool.members.size(); ++j) {
          const std::vector<std::size_t> chosen =
              i == j ? std::vector<std::size_t>{i} : std::vector<std::size_t>{i, j};
          const double gain = pool.net_gain(chosen);
          if (gain > most) most = gain, best = chosen;
        }
      }
      if (best.empty()) continue;
      std::vector<Member> others = rest;
      for (const std::size_t k : best) others.push_back(pool.members[k]);
      const JointFit fit = joint_fit(*setting_, others);
      int numbers = 0;
      for (const std::size_t k : best) numbers += pool.members[k].parameters();
      if (base.chi2 - fit.chi2 - setting_->price * numbers < own + 0.2 * setting_->price) continue;
      settle(fit.members);  // the pool's amplitudes know no bounds
      return true;
    }
  }
  return false;
}

}  // namespace dcnn
