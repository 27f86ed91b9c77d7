// SPDX-License-Identifier: Apache-2.0
// The zero-phase smoother of the pose, chosen on the force (never on the pose: on slow scans motion
// lies below the pose's noise that still stands in the force).
#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "data/bridge.h"
#include "data/spectral.h"
#include "dcnn/data/rotation.h"
#include "dcnn/physics/axis_machine.h"
#include "diagnosis/axis_case.h"
#include "diagnosis/candidates.h"
#include "diagnosis/search.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr double kTuning = 1.25;  // from one cut-off to the next
constexpr int kMostTunings = 6;

/// Whether a low-pass of both sides takes motion off.
bool is_cut(const Case& study) { return study.shown_hz() < study.motion_hz; }

/// A hand trembles at up to 14 Hz; a machine turns within some hundredths of a second, and what
/// lines the steps of its encoder make above that would be no motion.
DerivativeSpec low_pass_spec(const Case& study, double cutoff_hz, double subtraction,
                             const std::vector<double>& most_noise = {}) {
  // Hz: the bandwidth of a machine's motion; what a low-pass takes off is none.
  constexpr double kFastestMachine = 50.0;
  const double machine = is_cut(study) ? study.lowpass_hz : kFastestMachine;
  return {.kind = DerivativeSpec::Kind::kSpectral,
          .cutoff_hz = cutoff_hz,
          .subtraction = subtraction,
          .most_noise = most_noise,
          .fastest_hz = study.axis ? machine : DerivativeSpec().fastest_hz};
}

/// The most that poses, or positions of an axis, hold beyond the cut-off in each hertz or anywhere
/// above, in units of their noise's power.
std::vector<double> most_noise_of(const Case& study) {
  const LowPass filter{.cutoff_hz = study.derivative.cutoff_hz,
                       .fastest_hz = study.derivative.fastest_hz};
  std::vector<double> most;
  const auto add = [&](const Eigen::MatrixXd& pose, const Recording& recording) {
    const Bridged even = bridged(pose, recording);
    for (const Segment& s : even.segments) {
      for (Index j = 0; j < pose.cols(); ++j) {
        const auto x = even.columns.col(j).segment(s.begin, s.size());
        const std::vector<double> here = most_noise(x, recording.dt, filter);
        most.resize(here.size());
        for (std::size_t k = 0; k < most.size(); ++k) most[k] = std::max(most[k], here[k]);
      }
    }
  };
  for (const Log& log : study.logs) {
    if (study.axis) {
      for (const std::string& name : motion_columns(*study.axis)) {
        add(log.recording.column(name), log.recording);
      }
      continue;
    }
    add(quaternions(log.recording), log.recording);
    if (log.recording.has_all(kPosition)) add(log.recording.block(kPosition), log.recording);
  }
  return most;
}

/// dF/dt and d2F/dt2 of the prediction: what a delay or a low-pass looks like when small.
std::vector<Signals> lag_columns(const Case& study, const Signals& prediction) {
  std::vector<Signals> columns(2);
  for (std::size_t k = 0; k < prediction.size(); ++k) {
    const Eigen::MatrixXd& f = prediction[k];
    Eigen::MatrixXd first = Eigen::MatrixXd::Zero(f.rows(), f.cols()), second = first;
    for (Index i = 1; i + 1 < f.rows(); ++i) {
      first.row(i) = (f.row(i + 1) - f.row(i - 1)) / (2.0 * study.dt());
      second.row(i) = (f.row(i + 1) - 2.0 * f.row(i) + f.row(i - 1)) / (study.dt() * study.dt());
    }
    columns[0].push_back(first);
    columns[1].push_back(second);
  }
  return columns;
}

/// Chi-square that a small linear model leaves, and how many numbers it is the sum of.
struct Misfit {
  double square, rows;
  double variance() const { return square / rows; }
};
/// Of tool, sensor matrix, lag and offset beside `members`.
Misfit linear_misfit(const Case& study, const std::vector<Member>& members) {
  const Signals prediction = predict(study, members);
  std::vector<Floor> floors(static_cast<std::size_t>(study.channel_count()));
  for (auto& floor : floors) floor.white = 1.0;
  Signals levels;
  Signals measured;
  for (const Log& log : study.logs) {
    levels.push_back(Eigen::MatrixXd::Ones(log.motion.samples(), study.channel_count()));
    measured.push_back(log.measured);
  }
  Case unsmoothed = study;  // its whitener must not depend on the cut-off
  unsmoothed.derivative.kind = DerivativeSpec::Kind::kSavitzkyGolay;
  for (Log& log : unsmoothed.logs) log.motion.is_fast = false;
  const Whitener whitener(unsmoothed, floors, levels);
  const Index stride = whitener.coarse_stride();
  Setting setting{
      unsmoothed, whitener, thinned(unsmoothed, stride), whitener.at_stride(stride), measured,
      {},         {}};
  setting.mask = Eigen::VectorXd::Ones(setting.whitener.rows());
  setting.nuisance.resize(setting.whitener.rows(), 0);
  for (const auto& column : lag_columns(study, prediction)) {
    setting.nuisance = appended(setting.nuisance, setting.whitened(column));
  }
  for (const auto& column : own_offsets(study)) {
    setting.nuisance = appended(setting.nuisance, setting.whitened(column));
  }
  JointFit empty;
  empty.members = members;
  empty.tangent = setting.nuisance;
  empty.residual = setting.whitened(difference(study, prediction));
  const Scan scan(setting, empty);
  Eigen::MatrixXd A = setting.nuisance;
  for (std::size_t k = 0; k < study.logs.front().regressors.size(); ++k) {
    Signals column;
    for (const Log& log : study.logs) column.push_back(log.regressors[k]);
    A = appended(A, setting.whitened(column));
  }
  for (const char* name : {"mass", "com", "gain", "crosstalk", "bias"}) {
    const EffectKind& kind = *find_effect(name);
    if (!is_listed(study, kind) || !is_testable(study, kind)) continue;
    const Member member = make_member(study, kind, kind.fits[0], "", Eigen::VectorXd(0));
    A = appended(A, scan.columns(member, Detail::kCoarse));
  }
  const Eigen::VectorXd left = empty.residual - A * least_squares(A, empty.residual);
  return {left.squaredNorm(), static_cast<double>(left.size())};
}

}  // namespace

void Search::choose_cutoff(const std::vector<Member>& members) {
  if (study_.is_static() || (study_.axis && !is_derived(study_.axis->system, study_.axis->index))) {
    smoothed_.clear();
    return;
  }
  say("choosing the smoother");
  std::vector<double> grid;
  const double pace = std::max(1.0, study_.shown_hz() / 20.0);
  const double top = std::min(45.0 * pace, (pace > 1.0 ? 0.4 : 0.2) / study_.dt());
  // What a low-pass of both sides shows of the motion passes whole: at twice its edge 0.4 % is
  // left.
  const double whole = is_cut(study_) ? std::min(2.0 * study_.lowpass_hz, study_.motion_hz) : 0.0;
  for (double hz = std::max(5.0 * pace, whole); hz < top; hz *= 1.4) grid.push_back(hz);
  if (grid.empty())
    grid.push_back(is_cut(study_) ? std::min(whole, 0.4 / study_.dt()) : 0.1 / study_.dt());
  // Each cut-off without and, where the pose is differentiated, with the Wiener gain.
  // Its spectrum is averaged over half a hertz, which must hold five bins.
  constexpr double kWienerSeconds = 10.0;  // s
  const std::size_t kinds = study_.axis || longest_seconds(study_) < kWienerSeconds ? 1 : 2;
  std::vector<double> all(kinds * grid.size());
  for_each_piece(static_cast<Index>(all.size()), [&](Index k) {
    const auto at = static_cast<std::size_t>(k);
    Case trial = study_;
    set_derivative(trial,
                   low_pass_spec(study_, grid[at % grid.size()], at < grid.size() ? 0.0 : 1.0));
    all[at] = linear_misfit(trial, members).square;
  });
  const auto least = std::min_element(all.begin(), all.end()) - all.begin();
  const std::size_t kind = static_cast<std::size_t>(least) / grid.size();
  const std::size_t best = static_cast<std::size_t>(least) % grid.size();
  const auto begin = all.begin() + static_cast<std::ptrdiff_t>(kind * grid.size());
  const std::vector<double> misfit(begin, begin + static_cast<std::ptrdiff_t>(grid.size()));
  study_.derivative.subtraction = kind == 0 ? 0.0 : 1.0;
  study_.derivative.most_noise.clear();
  other_filter_.reset();
  if (kinds == 2) {  // the best of the other kind
    const auto others = all.begin() + static_cast<std::ptrdiff_t>((1 - kind) * grid.size());
    const auto at = std::min_element(others, others + std::ptrdiff_t(grid.size())) - others;
    other_filter_ =
        low_pass_spec(study_, grid[static_cast<std::size_t>(at)], kind == 0 ? 1.0 : 0.0);
  }
  double cutoff = grid[best];
  if (best > 0 && best + 1 < grid.size()) {  // vertex of the parabola through the three
    const double below = misfit[best - 1] - misfit[best], above = misfit[best + 1] - misfit[best];
    cutoff *= elementary::pow(1.4, 0.5 * (below - above) / (below + above));
  }
  smooth(cutoff);
  pass_motion(members);
}

/// Lets motion beyond the cut-off pass, of this recording and of others that move otherwise: what
/// exceeds the pose's noise, or as many times that as does not make the force worse known by more
/// than a number costs, or as these recordings reach.
void Search::pass_motion(const std::vector<Member>& members) {
  const Misfit least = linear_misfit(study_, members);
  for (const double times : {1.0, 10.0, 100.0}) {
    Case trial = study_;
    trial.derivative.most_noise = {times};
    set_derivative(trial, trial.derivative);
    if (linear_misfit(trial, members).square > least.square + kNumberPrice * least.variance())
      continue;
    study_.derivative.most_noise = {times};
    smooth(study_.derivative.cutoff_hz);
    return;
  }
  study_.derivative.most_noise = most_noise_of(study_);
}

/// Beside what was found since, more motion may pass: what a missing law leaves speaks against fast
/// motion that it goes with.
void Search::pass_more_motion() {
  const bool limited = study_.derivative.most_noise.size() > 1;
  if (!limited || study_.is_static() || fit_.members.empty()) return;
  pass_motion(fit_.members);
  if (study_.derivative.most_noise.size() == 1) settle(fit_.members);
}

/// A mode makes much of little motion near its own frequency, which the first choice took for
/// noise: its numbers and the smoother are found together, from the cut-off at hand upwards, the
/// likeliest kept if it leaves nothing but what rings unseen. Before anything else can be taken for
/// it.
void Search::tune_to_mode() {
  if (tuned_ || ringing_ || !rings() || study_.axis || !is_alarming_now()) return;
  tuned_ = ringing_ = true;
  say("choosing the smoother with the mode");
  const double before = study_.derivative.cutoff_hz, top = 0.2 / study_.dt();
  const std::vector<Member> without_tuning = fit_.members;
  double best = before, least = kInfinity;
  std::vector<Member> members = fit_.members;
  double hz = before;
  for (int step = 0; step < kMostTunings && hz < top; ++step, hz *= kTuning) {
    if (step > 0) smooth(hz);
    settle(fit_.members);
    const double unlikely = fit_.chi2 + setting_->whitener.log_determinant();
    if (unlikely < least) least = unlikely, best = hz, members = fit_.members;
  }
  smooth(best);
  settle(members);
  if (!is_alarming_now()) return;
  ringing_ = false;
  smooth(before);
  settle(without_tuning);
}

/// Motion too fast for the smoother, or too small for the pose to show it, shakes the modes that
/// were found. It is noise like the pose's own; once it counts as such, what had only served to
/// explain it goes.
void Search::let_ring() {
  if (!rings() || study_.axis) return;
  ringing_ = true;
  settle(fit_.members);
  while (simplify()) {
  }
  explore();
}

void Search::smooth(double cutoff_hz) {
  constexpr double kOver = 3.0;  // of the noise that the Wiener gain takes off
  const DerivativeSpec chosen = study_.derivative;
  const auto smoothed = [&](double hz, double times) {
    Case other = study_;
    set_derivative(other, low_pass_spec(study_, hz, times * chosen.subtraction, chosen.most_noise));
    return other;
  };
  smoothed_ = {smoothed(0.75 * cutoff_hz, kOver), smoothed(1.4 * cutoff_hz, 1.0 / kOver)};
  if (other_filter_) {
    smoothed_.push_back(study_);
    set_derivative(smoothed_.back(), *other_filter_);
  }
  study_ = smoothed(cutoff_hz, 1.0);
}

std::vector<Case*> Search::cases() {
  std::vector<Case*> list{&study_};
  for (Case& other : smoothed_) list.push_back(&other);
  return list;
}

}  // namespace dcnn
