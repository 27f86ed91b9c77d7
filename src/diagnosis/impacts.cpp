// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/impacts.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/elementary.h"
#include "data/median.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/impact_forces.h"
#include "diagnosis/noise_floor.h"
#include "diagnosis/slug.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr double kShortest = 0.003;  // s, half of what an impact lasts in a recording
constexpr double kSpread = 0.025;    // of a slide's duration: how well its end is foretold
constexpr double kFirstGap = 0.001, kLastGap = 0.035, kNextGap = 1.06;  // m
constexpr std::size_t kFewest = 4;                                      // ways from stop to stop
constexpr int kOtherTimes = 60;
constexpr double kMostLog = 700.0;  // of a ratio, before its exponential overflows

/// What a slug of 1 kg would explain.
struct Evidence {
  double sum = 0.0, square = 0.0, most = 0.0;
  void add(double found, double height) {
    sum += found * height;
    square += height * height;
    most = std::max(most, found * height);
  }
  double slug() const { return square > 0.0 ? sum / square : 0.0; }
  double strength() const { return square > 0.0 ? sum / std::sqrt(square) : 0.0; }
};

/// Of the forces, which tell the slug, and of their scores, which tell whether there is one: single
/// outliers of a heavy-tailed noise count no more there than the greatest of as many normal values.
struct Impulses {
  Evidence forces, scores;
};

class Ear {
 public:
  Ear(const Case& study, const Signals& left, const Signals& levels, std::size_t channel)
      : dt_(study.dt()) {
    ToolModel moving = study.simulator.model;
    moving.inertial = ToolModel::Inertial::kLinear;
    std::vector<double> heights;
    for (std::size_t k = 0; k < study.logs.size(); ++k) {
      const Motion& motion = study.logs[k].motion;
      fields_.push_back({felt_acceleration(moving, motion).col(study.channels[channel]), {}});
      channels_.emplace_back(left[k].col(static_cast<Index>(channel)),
                             levels[k].col(static_cast<Index>(channel)));
      const Forces& forces = channels_.back().about(shape(1));
      for (Index i = forces.far; forces.has(i); i += 3) {
        heights.push_back(std::abs(forces.values(i)));
      }
    }
    if (!heights.empty()) sigma_ = kDeviationOfMedian * median(heights) / shape(1).deviation();
  }

  /// The impacts that are heard best.
  void listen() {
    for (const double grip : {0.0, 0.1, 0.2, 0.3, 0.4, 0.55, 0.75, 1.0}) {
      for (AxisField& field : fields_) field.leave(grip);
      for (double gap = kFirstGap; gap < kLastGap; gap *= kNextGap) {
        for (const double rebound : {0.0, 0.3, 0.6}) take({gap, grip, rebound});
      }
    }
    if (heard.scores.strength() <= 0.0) return;
    compare_with_other_times();
    weigh();
  }

  /// ln of the mean of the likelihood ratios to no impacts, over a grid and its probabilities.
  double support(const std::vector<Impacts::Tried>& list) {
    std::vector<Evidence> all;
    double grip = -1.0;
    for (const Impacts::Tried& tried : list) {
      if (tried.slug.grip != grip) {
        grip = tried.slug.grip;
        for (AxisField& field : fields_) field.leave(grip);
      }
      all.push_back(take(tried.slug).forces);
    }
    if (heard.forces.square <= 0.0) return 0.0;  // no impact is due
    compare_with_other_times();
    double sum = 0.0;
    for (std::size_t k = 0; k < all.size(); ++k) {
      const double m = list[k].mass;
      const double log_ratio = (m * all[k].sum - 0.5 * m * m * all[k].square) / (scale * scale);
      sum += list[k].probability * elementary::exp(std::min(log_ratio, kMostLog));
    }
    return elementary::log(sum);
  }

  double significance() const { return heard.scores.strength() / scores_scale_; }
  bool is_heard() const {
    std::size_t ways = 0;
    Index last = -1;
    for (const Impact& impact : impacts) {
      if (impact.from != last) ++ways;
      last = impact.from;
    }
    const Evidence& e = heard.scores;
    const double others = significance() * (1.0 - e.most / e.sum);
    return heard.forces.sum > 0.0 && significance() > prior::kImpacts &&
           others > prior::kImpactsWithoutOne && ways >= kFewest &&
           e.strength() > prior::kImpactsOverOthers * most_elsewhere;
  }

  Impulses heard;
  std::vector<Impact> impacts;
  double most_elsewhere = 0.0;  ///< strength of the scores
  double scale = 1.0;           ///< deviation of the forces' strength where there are no impacts

  /// Slug [kg] and gap [m], means over all that was tried, by likelihood; and their deviations.
  Eigen::Vector2d mean, deviation;
  std::vector<Impacts::Tried> likely;

 private:
  const Template& shape(Index wide) const { return shapes_.try_emplace(wide, wide).first->second; }

  /// Matched to changes of momentum, `shift` samples after they are due.
  Impulses evidence(const std::vector<Impact>& list, Index shift) const {
    Impulses e;
    for (const Impact& impact : list) {
      const Channel& channel = channels_[impact.log];
      const double seconds = kSpread * dt_ * static_cast<double>(impact.at - impact.from);
      const Index wide = std::max<Index>(1, std::llround(std::max(kShortest, seconds) / dt_ - 0.5));
      const Template& found = shape(wide);
      const Forces& forces = channel.about(found);
      const Index at = impact.at + shift;
      if (!forces.has(at)) continue;
      const double unit = sigma_ * found.deviation() * channel.level(at);
      const double height = impact.change / (static_cast<double>(2 * wide + 1) * dt_) / unit;
      e.forces.add(forces.values(at) / (sigma_ * found.deviation()), height);
      e.scores.add(forces.scores(at), height);
    }
    return e;
  }

  Impulses take(const Slug& slug) {
    const std::vector<Impact> list = impacts_of(fields_, slug, dt_);
    const Impulses e = evidence(list, 0);
    tried_.push_back({slug, e.forces});
    strongest_ = std::max(strongest_, e.forces.strength());
    if (e.scores.square > 0.0 &&
        (impacts.empty() || e.scores.strength() > heard.scores.strength())) {
      heard = e, impacts = list;
    }
    return e;
  }

  void compare_with_other_times() {
    std::vector<double> forces, scores;
    for (int k = 0; k < kOtherTimes; ++k) {
      const double seconds = (k % 2 ? 1.0 : -1.0) * (0.1 + 0.02 * k);
      const Impulses e = evidence(impacts, std::llround(seconds / dt_));
      forces.push_back(std::abs(e.forces.strength()));
      scores.push_back(std::abs(e.scores.strength()));
    }
    most_elsewhere = *std::max_element(scores.begin(), scores.end());
    scale = std::max(1.0, kDeviationOfMedian * median(forces));
    scores_scale_ = std::max(1.0, kDeviationOfMedian * median(scores));
  }

  void weigh() {
    double all = 0.0;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero(), squares = Eigen::Vector2d::Zero();
    for (const auto& [slug, e] : tried_) {
      if (e.sum <= 0.0) continue;
      const double below = strongest_ * strongest_ - e.strength() * e.strength();
      const double weight = elementary::exp(-0.5 * below / (scale * scale));
      const Eigen::Vector2d at(e.slug(), slug.gap);
      const Eigen::Vector2d own(scale * scale / e.square,
                                elementary::pow(0.5 * (kNextGap - 1.0) * slug.gap, 2));
      likely.push_back({slug, e.slug(), weight});
      all += weight;
      sum += weight * at;
      squares += weight * (at.cwiseAbs2() + own);
    }
    mean = sum / all;
    deviation = (squares / all - mean.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
    for (Impacts::Tried& tried : likely) tried.probability /= all;
  }

  double strongest_ = 0.0, scores_scale_ = 1.0;
  double dt_, sigma_ = 1.0;
  std::vector<AxisField> fields_;
  std::vector<Channel> channels_;
  mutable std::map<Index, Template> shapes_;
  std::vector<std::pair<Slug, Evidence>> tried_;
};

}  // namespace

Impacts find_impacts(const Case& study, const Signals& left) {
  const EffectKind& kind = *find_effect("loose_load");
  if (!is_testable(study, kind)) return {};
  const auto levels = noise_level(study, left);
  std::optional<Ear> best;
  std::size_t channel = 0;
  for (std::size_t j = 0; j < study.channels.size(); ++j) {
    if (study.channels[j] > 2) continue;
    Ear ear(study, left, levels, j);
    ear.listen();
    if (ear.is_heard() && (!best || ear.significance() > best->significance())) {
      best = std::move(ear), channel = j;
    }
  }
  if (!best) return {};
  Impacts found;
  const auto name = static_cast<std::size_t>(study.channels[channel]);
  found.member = make_member(study, kind, kind.fits[0], admitted_axes(AxisRule::kSensor)[name],
                             Eigen::VectorXd::Constant(1, best->mean(1)));
  found.member->amplitudes(0) = best->mean(0);
  found.member->fixed = true;
  found.member->fixed_deviation = best->deviation;
  found.tried = std::move(best->likely);
  for (const Impact& impact : best->impacts) {
    const Eigen::VectorXd& t = study.logs[impact.log].motion.t;
    found.spans.push_back({impact.log, t(impact.from), t(impact.at) + 0.12});
  }
  return found;
}

double impacts_support(const Case& recordings, const Signals& left, const Impacts& impacts) {
  const auto axes = admitted_axes(AxisRule::kSensor);
  for (std::size_t j = 0; j < recordings.channels.size(); ++j) {
    const auto component = static_cast<std::size_t>(recordings.channels[j]);
    if (component > 2 || axes[component] != impacts.member->axis) continue;
    return Ear(recordings, left, noise_level(recordings, left), j).support(impacts.tried);
  }
  return 0.0;
}

}  // namespace dcnn
