// SPDX-License-Identifier: Apache-2.0
#include "dcnn/discovery/discover.h"

#include <algorithm>

#include "discovery/judge.h"
#include "discovery/mutate.h"
#include "discovery/priors.h"
#include "discovery/scan.h"

namespace dcnn::discovery {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr std::size_t kScanned = 10;
constexpr std::size_t kMostRivals = 4;

using Terms = std::vector<Sketch>;

/// An orthonormal basis of the columns of both, the first being one already.
MatrixXd extended(const MatrixXd& basis, const MatrixXd& columns) {
  MatrixXd all(columns.rows(), basis.cols() + columns.cols());
  if (basis.cols() > 0) all.leftCols(basis.cols()) = basis;
  Index count = basis.cols();
  for (Index k = 0; k < columns.cols(); ++k) {
    VectorXd c = columns.col(k);
    const double before = c.norm();
    for (int pass = 0; pass < 2; ++pass) {  // twice is enough (Kahan and Parlett)
      c -= all.leftCols(count) * (all.leftCols(count).transpose() * c);
    }
    if (c.norm() > 1e-6 * before && before > 0.0) all.col(count++) = c.normalized();
  }
  return all.leftCols(count);
}

/// The problem that other laws leave: their numbers are fitted beside the next one.
Problem beside(const Problem& problem, const Terms& terms) {
  if (terms.empty()) return problem;
  Problem rest = problem;
  const Data data(problem);
  for (const Sketch& sketch : terms) {
    rest.residual -= sketch.amplitude * data.column(sketch);
    rest.known = extended(rest.known, tangent_of(data, sketch));
  }
  rest.residual -= rest.known * (rest.known.transpose() * rest.residual);
  return rest;
}

Terms without(Terms terms, std::size_t k) {
  terms.erase(terms.begin() + static_cast<std::ptrdiff_t>(k));
  return terms;
}

/// Numbers of all fitted again together.
void settle(const Problem& problem, Terms& terms, int steps) {
  terms = refined_together(Data(problem), terms, steps);
}

/// Gain of all together, less their penalties.
double score_of(const Problem& problem, const Terms& terms) {
  const double before = problem.residual.squaredNorm();
  const double gain = before - beside(problem, terms).residual.squaredNorm();
  double score = gain;
  for (const Sketch& sketch : terms) score -= penalty(sketch, gain);
  return score;
}

/// The forms of the first few searched beside the others.
void evolve_beside(const Problem& problem, Terms& terms) {
  const std::size_t forms = std::min<std::size_t>(terms.size(), prior::kMostEvolved);
  for (std::size_t k = 0; k < forms; ++k) {
    const Problem rest = beside(problem, without(terms, k));
    const Data data(rest);
    terms[k] = evolved(data, {weighed(data, terms[k])}).front().sketch;
  }
  settle(problem, terms, 4);
}

/// The best form of one term, or nothing.
std::optional<Sketch> evolved_term(const Problem& problem) {
  const Data data(problem);
  std::vector<Trial> trials = scan(data, kScanned);
  if (trials.empty() || trials.front().gain < prior::kAccepted) return std::nullopt;
  trials = evolved(data, std::move(trials));
  if (trials.front().score < prior::kAccepted) return std::nullopt;
  return trials.front().sketch;
}

/// The best entry of the dictionary, its numbers fitted, or nothing.
std::optional<Sketch> plain_term(const Problem& problem) {
  constexpr std::size_t kFitted = 4;
  const Data data(problem);
  std::optional<Trial> best;
  for (const Trial& trial : scan(data, kFitted)) {
    Trial now = refined(data, trial.sketch, 6);
    now.score = now.gain - penalty(now.sketch, now.gain);
    if (!best || now.score > best->score) best = std::move(now);
  }
  if (!best || best->score < prior::kAccepted) return std::nullopt;
  return best->sketch;
}

/// Terms one after the other, each in its best form.
Terms greedy(const Problem& problem) {
  Terms terms;
  for (int k = 0; k < prior::kMostEvolved; ++k) {
    const auto next = evolved_term(beside(problem, terms));
    if (!next) break;
    terms.push_back(*next);
    if (terms.size() > 1) settle(problem, terms, 3);
  }
  return terms;
}

/// Entries of the dictionary first, all of them, and the forms of the first few beside the others
/// then: a sum of laws is not taken for products.
Terms gathered(const Problem& problem) {
  Terms terms;
  for (int k = 0; k < prior::kMostLaws; ++k) {
    const auto next = plain_term(beside(problem, terms));
    if (!next) break;
    terms.push_back(*next);
    if (terms.size() > 1) settle(problem, terms, 2);
  }
  evolve_beside(problem, terms);
  return terms;
}

/// Leaves out what does not earn its numbers beside the others, the least first.
void prune(const Problem& problem, Terms& terms) {
  while (terms.size() > 1) {
    std::size_t least = 0;
    double worst = prior::kAccepted;
    for (std::size_t k = 0; k < terms.size(); ++k) {
      const Problem rest = beside(problem, without(terms, k));
      const Trial trial = weighed(Data(rest), terms[k]);
      const double score = trial.gain - penalty(terms[k], trial.gain);
      if (score < worst) worst = score, least = k;
    }
    if (worst >= prior::kAccepted) return;
    terms = without(terms, least);
    settle(problem, terms, 3);
  }
}

/// Replaces terms by plainer forms that are worth as much beside the others: numbers that were
/// fitted again may have made a factor needless, or its constant.
void make_plainer(const Problem& problem, Terms& terms) {
  constexpr int kSteps = 6;      // a limit of computation
  constexpr double kSame = 0.1;  // of chi-square: where fits of one law end
  for (std::size_t k = 0; k < terms.size(); ++k) {
    const Problem rest = beside(problem, without(terms, k));
    const Data data(rest);
    for (;;) {
      std::vector<Trial> trials;
      for (const Sketch& sketch : plainer(data, terms[k])) {
        trials.push_back(refined(data, sketch, kSteps));
      }
      if (trials.empty()) break;
      trials.push_back(weighed(data, terms[k]));
      rank(trials);
      const law::Structure own = structure_of(terms[k]);
      const auto at = std::find_if(trials.begin(), trials.end(), [&](const Trial& trial) {
        return structure_of(trial.sketch) == own;
      });
      const Trial& best = at == trials.begin() ? trials[1] : trials.front();
      if (best.score < at->score - kSame) break;
      terms[k] = best.sketch;
    }
  }
}

/// Whether the terms leave nothing but noise.
bool suffices(const Problem& problem, const Terms& terms) {
  const auto rows = static_cast<double>((problem.residual.array() != 0.0).count());
  return beside(problem, terms).residual.squaredNorm() < prior::kNoise * rows;
}

/// The best of sums that were found in two ways; greedy alone where one law explains all.
Terms search(const Problem& problem) {
  const auto is_spent = [&] { return problem.is_spent && problem.is_spent(); };
  Terms first = greedy(problem);
  prune(problem, first);
  if (first.empty() || (first.size() == 1 && suffices(problem, first)) || is_spent()) return first;
  Terms second = gathered(problem);
  prune(problem, second);
  Terms& best = score_of(problem, second) > score_of(problem, first) ? second : first;
  if (!suffices(problem, best) && !is_spent()) {
    // Each term was found beside others that have changed since.
    Terms again = best;
    evolve_beside(problem, again);
    for (std::size_t k = 0; k < again.size(); ++k) {
      const Problem rest = beside(problem, without(again, k));
      again[k] = with_finer_curves(Data(rest), again[k]);
    }
    prune(problem, again);
    if (score_of(problem, again) > score_of(problem, best)) return again;
  }
  return best;
}

/// Other forms of a term within the margin, beside the other terms.
std::vector<std::string> rivals_of(const Data& data, const Sketch& sketch) {
  std::vector<std::string> list;
  const auto trials = evolved(data, {weighed(data, sketch)});
  const double least =
      trials.front().score - std::max(prior::kRival, prior::kRivalShare * trials.front().gain);
  for (const Trial& trial : trials) {
    if (list.size() >= kMostRivals || trial.score < least) break;
    if (structure_of(trial.sketch) == structure_of(sketch)) continue;
    list.push_back(law::expression(law_of(trial.sketch, data.signals())));
  }
  return list;
}

Discovered judged_beside(const Problem& problem, const Terms& terms, std::size_t k, bool rivals) {
  const Problem rest = beside(problem, without(terms, k));
  const Data data(rest);
  Trial trial = weighed(data, terms[k]);
  trial.sketch.amplitude = terms[k].amplitude;  // beside the others as they are
  // An error of the motion may buy as much of a small term as of the greatest.
  const double largest = problem.residual.squaredNorm() - rest.residual.squaredNorm() + trial.gain;
  trial.score = trial.gain - penalty(trial.sketch, largest);
  Discovered found = judged(data, trial);
  if (rivals && is_accepted(found)) found.rivals = rivals_of(data, trial.sketch);
  return found;
}

/// The one to leave out: the weakest that is not accepted.
std::optional<std::size_t> least_worthy(const std::vector<Discovered>& laws) {
  std::optional<std::size_t> least;
  for (std::size_t k = 0; k < laws.size(); ++k) {
    if (is_accepted(laws[k])) continue;
    if (!least || laws[k].gain < laws[*least].gain) least = k;
  }
  return least;
}

/// The terms that are accepted beside the others, which are judged again without the rest.
std::vector<Discovered> accepted(const Problem& problem, Terms terms, bool rivals) {
  for (;;) {
    make_plainer(problem, terms);
    if (terms.size() > 1) settle(problem, terms, 8);
    for (Sketch& sketch : terms) sketch = with_round_references(sketch);
    settle(problem, terms, 0);  // their amplitudes
    std::vector<Discovered> laws;
    for (std::size_t k = 0; k < terms.size(); ++k) {
      laws.push_back(judged_beside(problem, terms, k, rivals && terms.size() == 1));
    }
    const auto least = least_worthy(laws);
    if (!least) return laws;
    terms = without(terms, *least);
    settle(problem, terms, 4);
  }
}

bool can_be_searched(const Problem& problem) {
  for (const Record& record : problem.records) {
    const Motion& motion = *record.motion;
    if (motion.is_static() || motion.v_B.rows() != motion.samples() ||
        motion.a_B.rows() != motion.samples()) {
      return false;
    }
  }
  return !problem.records.empty() && problem.residual.squaredNorm() > 0.0;
}

}  // namespace

std::vector<Discovered> discover(const Problem& problem) {
  if (!can_be_searched(problem)) return {};
  auto laws = accepted(problem, search(problem), true);
  std::stable_sort(laws.begin(), laws.end(),
                   [](const Discovered& a, const Discovered& b) { return a.gain > b.gain; });
  return laws;
}

std::vector<Discovered> refitted(const Problem& problem, const std::vector<Discovered>& laws) {
  Terms terms;
  const Data data(problem);
  for (const Discovered& found : laws) terms.push_back(sketch_of(found.law, data.signals()));
  terms = refined_together(data, terms, 8);
  auto again = accepted(problem, terms, false);
  for (Discovered& found : again) {
    for (const Discovered& before : laws) {
      if (before.law.structure == found.law.structure) found.rivals = before.rivals;
    }
  }
  return again;
}

}  // namespace dcnn::discovery
