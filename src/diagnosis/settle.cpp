// SPDX-License-Identifier: Apache-2.0
// Floor, whitening and nuisance for what a set of members leaves.
#include <algorithm>
#include <cmath>

#include "dcnn/data/filter.h"
#include "diagnosis/axis_case.h"
#include "diagnosis/base_errors.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/periodograms.h"
#include "diagnosis/search.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr Index kFewestBlocks = 7;  // as many as poses: four numbers and three degrees of freedom

/// 0 for blocks within one of the spans.
Eigen::VectorXd mask_of(const Whitener& whitener, const std::vector<Span>& a,
                        const std::vector<Span>& b) {
  Eigen::VectorXd mask = Eigen::VectorXd::Ones(whitener.rows());
  for (const auto* list : {&a, &b}) {
    for (const Span& span : *list) {
      for (std::size_t row = 0; row < whitener.row_info().size(); ++row) {
        const auto& at = whitener.row_info()[row];
        if (span.holds(at.log, at.t)) mask(static_cast<Index>(row)) = 0.0;
      }
    }
  }
  return mask;
}

}  // namespace

Surroundings Search::surroundings(const std::vector<Member>& members) const {
  Surroundings made;
  std::vector<Floor>& floors = made.floors;
  const Signals prediction = predict(study_, members);
  made.left = difference(study_, prediction);
  Signals measured;
  for (const Log& log : study_.logs) measured.push_back(log.measured);
  const Signals raw = study_.lowpass_hz > 0.0 ? unfiltered_left(study_, members) : made.left;
  const auto levels = noise_level(study_, raw);
  if (noise_) {
    floors = *noise_;
  } else {
    floors = noise_floor(study_, raw, levels);
  }
  bound_by_residual(study_, raw, levels, floors);
  add_pose_noise(study_, floors);
  add_position_noise(study_, members, made.left, floors);
  if (in_slow_noise_) {
    const Signals even = evened(study_, made.left, levels);  // of which the floors are, too
    made.slow = slow_parts(study_, even, floors).value_or(made.slow);
  }
  for (std::size_t j = 0; j < made.slow.size(); ++j) {
    made.slow[j].add_to(floors[j]);
    floors[j].source += "; below, slow noise that depends on nothing";
  }
  for (const Member& m : members) {
    if (!ringing_ || m.kind->stage != Stage::kResonance) continue;
    const auto own = std::find(study_.channels.begin(), study_.channels.end(), axis_index(m.axis));
    if (own == study_.channels.end()) continue;
    floors[static_cast<std::size_t>(own - study_.channels.begin())].modes.push_back(
        {m.shapes(0), m.shapes(1), m.amplitudes(0)});
  }
  // What a machine leaves above the motion's band has friction's harmonics in it: its colour says
  // nothing of the noise in the band until all that is left bears it out.
  for (Floor& floor : floors) {
    if (!study_.axis || noise_) continue;
    Floor unfiltered = floor;
    unfiltered.lowpass_hz = 0.0;
    unfiltered.interpolated.clear();
    floor.white = unfiltered.deviation() * unfiltered.deviation();
    floor.coloured = floor.filtered = floor.flicker = 0.0;
    floor.bounds.clear();
  }
  if (study_.axis && !noise_) bound_by_residual(study_, raw, levels, floors);
  add_rounding(study_, floors);
  Whitener whitener(study_, floors, levels, noise_correlation(study_, raw, levels));
  const Index blocks = whitener.rows() / study_.channel_count();
  // The ends of a short stretch, a tenth of it each, are left out.
  const double fewest = static_cast<double>(kFewestBlocks), seconds = longest_seconds(study_);
  const double needed =
      std::max(fewest * whitener.block_seconds() / 0.8,
               seconds * fewest / static_cast<double>(std::max<Index>(1, blocks)));
  require(blocks >= kFewestBlocks, Exit::kData, study_.logs.front().recording.name,
          ": too short to tell noise from missing physics: ", brief(seconds),
          " s; record at least ", brief(needed), " s without gaps");
  std::vector<Span> masked = masked_;
  masked.insert(masked.end(), impacts_.spans.begin(), impacts_.spans.end());
  masked.insert(masked.end(), outlying_.begin(), outlying_.end());
  const Eigen::VectorXd mask = mask_of(whitener, held_out_, masked);
  if (study_.axis) whitener.allow_for_error(made.left, mask);
  const Index stride = whitener.coarse_stride();
  made.setting = std::make_unique<Setting>(Setting{
      study_, whitener, thinned(study_, stride), whitener.at_stride(stride), measured, {}, {}});
  Setting& setting = *made.setting;
  const Index rows = setting.whitener.rows();
  setting.mask = mask;
  setting.nuisance.resize(rows, 0);
  for (std::size_t k = 0; k < study_.logs.front().regressors.size(); ++k) {
    Signals column;
    for (const Log& log : study_.logs) {
      column.push_back(
          low_pass(log.regressors[k], log.motion.segments, log.motion.dt, study_.lowpass_hz));
    }
    setting.nuisance = appended(setting.nuisance, setting.whitened(column));
  }
  for (const Signals& column : own_offsets(study_)) {
    setting.nuisance = appended(setting.nuisance, setting.whitened(column));
  }
  for (const Signals& column : base_errors(study_)) {
    setting.nuisance = appended(setting.nuisance, setting.whitened(column));
  }
  if (study_.is_static() || study_.without.smoothing) return made;
  // What other filters of the pose change, per channel.
  for (const Case& other : smoothed_) {
    const Signals there = predict(other, members);
    for (Index j = 0; j < study_.channel_count(); ++j) {
      Signals change;
      for (std::size_t k = 0; k < there.size(); ++k) {
        change.push_back(Eigen::MatrixXd::Zero(there[k].rows(), there[k].cols()));
        change.back().col(j) = there[k].col(j) - prediction[k].col(j);
      }
      setting.nuisance = appended(setting.nuisance, setting.whitened(change));
    }
  }
  return made;
}

void Search::make_setting(const std::vector<Member>& members) {
  Surroundings made = surroundings(members);
  left_ = std::move(made.left);
  floors_ = std::move(made.floors);
  slow_ = std::move(made.slow);
  setting_ = std::move(made.setting);
}

/// What rounding makes of the mean depends on the noise before it, which a coarse lattice hides:
/// the noise that leaves least. True where that is another one than before.
bool Search::choose_rounding_noise() {
  const double q = study_.rounding_step, before = study_.rounding_noise;
  if (q == 0.0) return false;
  double best = before, least = fit_.chi2;
  Case trial = study_;
  for (double share = 0.03; share < 0.9; share *= 1.25) {
    trial.rounding_noise = share * q;
    const Eigen::VectorXd left =
        setting_->whitened(difference(trial, predict(trial, fit_.members)));
    const double chi2 =
        (left - setting_->nuisance * least_squares(setting_->nuisance, left)).squaredNorm();
    if (chi2 < least) least = chi2, best = trial.rounding_noise;
  }
  for (Case* study : cases()) study->rounding_noise = best;
  return std::abs(best / before - 1.0) > 0.1;
}

/// Whether the floor below this fit is far from the one that it was weighed by, as it is where its
/// members began far from their best.
bool Search::floor_moved() const {
  const Signals left = unfiltered_left(study_, fit_.members);
  const auto now = noise_floor(study_, left, noise_level(study_, left));
  for (std::size_t j = 0; j < now.size(); ++j) {
    if (floors_[j].deviation() > prior::kFloorMoved * now[j].deviation()) return true;
  }
  return false;
}

/// Whitens for what these members leave, and fits them and the simulator's linear base.
void Search::fit_beside_base(const std::vector<Member>& members) {
  make_setting(members);
  fit_ = joint_fit(*setting_, members);
  if (study_.logs.front().regressors.empty()) return;
  // What filters and gains do to the base simulator they do to the fitted one.
  for (Case* study : cases()) set_base(*study, fit_.base);
  setting_->coarse = thinned(study_, setting_->whitener.coarse_stride());
  fit_ = joint_fit(*setting_, fit_.members);
}

void Search::settle(const std::vector<Member>& members) {
  fit_beside_base(members);
  if (study_.axis && floor_moved()) fit_beside_base(fit_.members);
  if (choose_rounding_noise()) fit_beside_base(fit_.members);
  left_ = difference(study_, predict(study_, fit_.members));
  // Overdispersion: what no effect explains counts as noise, its variance times chi-square per row,
  // and so does a number's price (McCullagh and Nelder, Generalized Linear Models, 1989, 4.5). A
  // machine always leaves something, in far fewer independent rows than it has. Of a tool that
  // moves an unknown is weighed in its own terms, and laws are looked for in it.
  const double share = is_inexact()         ? kMachineShare
                       : is_overdispersed() ? kNumberPrice / setting_->mask.sum()
                                            : 0.0;
  setting_->price = std::max(kNumberPrice, share * fit_.chi2);
  // Of noise that rises as 1/f the next recording would show another slope.
  if (!slow_.empty()) setting_->price = std::max(prior::kPriceInSlowNoise, setting_->price);
  forget_places();
}

}  // namespace dcnn
