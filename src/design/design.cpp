// SPDX-License-Identifier: Apache-2.0
#include "dcnn/design/design.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "design/coverage.h"
#include "design/decision.h"
#include "design/proposals.h"
#include "design/separation.h"
#include "design/words.h"

namespace dcnn::design {
namespace {

constexpr double kSearchHz =
    100.0;  // forces are compared at this rate: what moves stays below some 10 Hz

/// What motions are judged by: information between structures and about the unknown.
class Judge {
 public:
  Judge(const Question& question, const Limits& limits, double rate_hz)
      : question_(question), limits_(limits), rate_hz_(rate_hz), predictor_(question, rate_hz) {}

  /// Scales of the states: the largest of some motions that use the limits.
  void set_scales(const std::vector<Spline>& splines) {
    for (const Spline& spline : splines) {
      const Eigen::VectorXd most = states_of(played(spline).motion).cwiseAbs().colwise().maxCoeff();
      largest_ = largest_.size() == 0 ? most : Eigen::VectorXd(largest_.cwiseMax(most));
    }
    largest_ = largest_.cwiseMax(1e-9);
  }

  Played played(const Spline& spline) const {
    return play(spline, limits_, question_.tool, rate_hz_, question_.start_s);
  }

  double unknown_information(const Motion& motion) const {
    return coverage(motion, largest_, static_cast<double>(motion.samples()));
  }

  std::vector<Prediction> predictions(const Motion& motion) const {
    std::vector<Prediction> all;
    for (std::size_t k = 0; k < question_.hypotheses.size(); ++k)
      all.push_back(predictor_.predict(k, motion));
    return all;
  }

  /// Sum over pairs of sqrt(p q) ln(1 + d²)/2, and the unknown's probability times the information
  /// about it, in nats. The square root weighs a pair as the bound of its error does (Kailath
  /// 1967).
  double value(const Spline& spline) const {
    const Motion motion = played(spline).motion;
    double sum = question_.unknown * unknown_information(motion);
    const std::vector<Prediction> all = predictions(motion);
    for (std::size_t a = 0; a < all.size(); ++a) {
      for (std::size_t b = 0; b < all.size(); ++b) {
        if (a == b) continue;
        const double weight =
            std::sqrt(question_.hypotheses[a].mass * question_.hypotheses[b].mass);
        sum += 0.5 * weight * elementary::log1p(separation(all[a], all[b]));
      }
    }
    return sum;
  }

  /// Every ordered pair on a motion, the rivals fitted through their laws.
  std::vector<Verdict> verdicts(const Motion& motion, Design& design) const {
    const std::vector<Prediction> all = predictions(motion);
    const auto& hypotheses = question_.hypotheses;
    std::vector<Verdict> list;
    double right = 0.0, named = 0.0;
    for (std::size_t a = 0; a < all.size(); ++a) {
      double missed = 0.0;
      for (std::size_t b = 0; b < all.size(); ++b) {
        if (a == b) continue;
        const double square = predictor_.fitted_square(b, motion, all[a].force);
        const double shared = shared_dimension(all[a], all[b]);
        const auto own = static_cast<double>(dimension(all[a])),
                   rival = static_cast<double>(dimension(all[b]));
        const int more = hypotheses[b].more_numbers - hypotheses[a].more_numbers;
        double before = hypotheses[b].chi2_above - hypotheses[a].chi2_above;
        // What further numbers gained by chance they lose where the next recording tells them
        // better.
        if (more > 0) before = std::max(0.0, before);
        const double needed = exclusion_threshold(more) - before;
        const Contest contest{square, std::max(0.0, own - shared), std::max(0.0, rival - shared)};
        const double p = probability_above(contest, needed);
        list.push_back({question_.name_of(a, b), question_.name_of(b, a), std::sqrt(square), p});
        missed += 1.0 - p;
      }
      right += hypotheses[a].mass * std::max(0.0, 1.0 - missed);
      named += hypotheses[a].mass;
    }
    if (all.size() > 1) design.probability = right / named;
    return list;
  }

 private:
  const Question& question_;
  const Limits& limits_;
  double rate_hz_;
  Predictor predictor_;
  Eigen::VectorXd largest_;
};

/// The best of random motions, changed as long as that improves it.
Spline best_spline(Judge& judge, const DesignRequest& request,
                   const std::function<void(double)>& progress) {
  constexpr int kShareDrawn = 3;  // one of so many is drawn anew, before the others change the best
  const double rate_hz = std::min(kSearchHz, request.limits.rate_hz);
  Rng rng({request.seed, 21});
  const auto draw = [&] {
    return within(draw_spline(request.limits, request.seconds, rng), request.limits, rate_hz);
  };
  const int drawn = std::max(1, request.evaluations / kShareDrawn);
  std::vector<Spline> first;
  for (int k = 0; k < drawn; ++k) first.push_back(draw());
  judge.set_scales(first);
  Spline best = first[0];
  double most = judge.value(best);
  for (int k = 1; k < request.evaluations; ++k) {
    const auto place = static_cast<std::size_t>(k);
    Spline next = place < first.size()
                      ? first[place]
                      : within(changed(best, request.limits, rng), request.limits, rate_hz);
    const double value = judge.value(next);
    if (value > most) {
      most = value;
      best = std::move(next);
    }
    if (progress) progress(static_cast<double>(k + 1) / request.evaluations);
  }
  return best;
}

Table table_of(const Played& played, bool of_joints) {
  Table table;
  table.columns = {"t"};
  const Index joints = of_joints ? played.coordinates.value.cols() : 0;
  for (Index k = 0; k < joints; ++k) table.columns.push_back("q" + std::to_string(k + 1));
  for (const char* name : {"x", "y", "z", "alpha", "beta", "gamma"})
    table.columns.emplace_back(name);
  table.values.resize(played.pose.rows(), 1 + joints + 6);
  table.values.col(0) = played.coordinates.t;
  if (joints > 0) table.values.middleCols(1, joints) = played.coordinates.value;
  table.values.rightCols(6) = played.pose;
  return table;
}

}  // namespace

Design make_design(const DesignRequest& request, const std::function<void(double)>& progress) {
  require(request.seconds >= 2.0 && request.seconds <= 3600.0, Exit::kUsage,
          "a motion has 2 to 3600 s, not ", request.seconds);
  require(request.evaluations >= 1, Exit::kUsage, "a design judges at least one motion");
  const Question question = question_of(request.report, request.model, request.where);
  Judge judge(question, request.limits, std::min(kSearchHz, request.limits.rate_hz));
  const Spline best =
      within(best_spline(judge, request, progress), request.limits, request.limits.rate_hz);
  Design design;
  const Played coarse = judge.played(best);
  design.chosen = question.chosen();
  design.unknown = question.unknown;
  design.information = judge.unknown_information(coarse.motion);
  design.verdicts = judge.verdicts(coarse.motion, design);
  const Played fine =
      play(best, request.limits, question.tool, request.limits.rate_hz, question.start_s);
  for (const Usage& one : usage(fine, request.limits)) {
    design.greatest_use = std::max(design.greatest_use, one.share);
    design.limits.push_back(limit_words(one));
  }
  require(design.greatest_use <= 1.0, Exit::kFailure, "the designed motion breaks a limit");
  design.motion = table_of(fine, request.limits.joints.has_value());
  design.words = motion_words(fine, question, design);
  return design;
}

}  // namespace dcnn::design
