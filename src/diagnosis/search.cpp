#include "diagnosis/search.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/candidates.h"
#include "diagnosis/detectors.h"
#include "diagnosis/events.h"

namespace dcnn {
namespace {

constexpr double kLeastNetGain = 30.0;  // of chi-square after 10 per number, to name an effect
constexpr double kLeastShare = 0.002;   // of what the model explains already
constexpr double kPerParameter = 10.0;
constexpr std::size_t kMostMembers = 6;  // more only ever fed what is not in the catalogue
constexpr Index kFine = 6;               // of these, looked at in full detail
constexpr std::size_t kRefined = 10;     // candidates whose shapes are refined before a decision

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

Eigen::MatrixXd appended(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  Eigen::MatrixXd both(b.rows(), a.cols() + b.cols());
  both << a, b;
  return both;
}

/// Chi-square that a small linear model (tool, sensor matrix, lag, offset) beside `members` leaves.
double linear_misfit(const Case& study, const std::vector<Member>& members) {
  const Signals prediction = predict(study, members);
  std::vector<Floor> floors(static_cast<std::size_t>(study.channel_count()));
  for (auto& floor : floors) floor.white = 1.0;
  std::vector<Eigen::VectorXd> levels;
  Signals measured;
  for (const Log& log : study.logs) {
    levels.push_back(Eigen::VectorXd::Ones(log.motion.samples()));
    measured.push_back(log.measured);
  }
  Case unsmoothed = study;  // its whitener must not depend on the cut-off
  unsmoothed.derivative.kind = DerivativeSpec::Kind::kSavitzkyGolay;
  const Whitener whitener(unsmoothed, floors, levels);
  Setting setting{unsmoothed, whitener, unsmoothed, whitener, measured, {}, {}};
  setting.mask = Eigen::VectorXd::Ones(setting.whitener.rows());
  setting.nuisance.resize(setting.whitener.rows(), 0);
  for (const auto& column : lag_columns(study, prediction)) {
    setting.nuisance = appended(setting.nuisance, setting.whitened(column));
  }
  JointFit empty;
  empty.members = members;
  empty.tangent = setting.nuisance;
  empty.residual = setting.whitened(difference(study, prediction));
  const Scan scan(setting, empty);
  Eigen::MatrixXd A = setting.nuisance;
  for (const char* name : {"mass", "com", "gain", "crosstalk", "bias"}) {
    const EffectKind& kind = *find_effect(name);
    if (!is_testable(study, kind)) continue;
    A = appended(A, scan.columns(make_member(kind, kind.fits[0], "", study.has_torque(),
                                             Eigen::VectorXd(0))));
  }
  return (empty.residual - A * least_squares(A, empty.residual)).squaredNorm();
}

/// 0 for blocks within one of the spans.
Eigen::VectorXd mask_of(const Whitener& whitener, const std::vector<Span>& a,
                        const std::vector<Span>& b) {
  Eigen::VectorXd mask = Eigen::VectorXd::Ones(whitener.rows());
  for (const auto* list : {&a, &b}) {
    for (const Span& span : *list) {
      for (std::size_t row = 0; row < whitener.row_info().size(); ++row) {
        const auto& at = whitener.row_info()[row];
        if (at.log == span.log && at.t >= span.begin && at.t <= span.end) {
          mask(static_cast<Index>(row)) = 0.0;
        }
      }
    }
  }
  return mask;
}

bool same_place(const Member& a, const Member& b) {
  return a.kind == b.kind && a.axis == b.axis && !a.interval_s && !b.interval_s;
}

}  // namespace

Signals difference(const Case& study, const Signals& prediction) {
  Signals left;
  for (std::size_t k = 0; k < study.logs.size(); ++k) {
    left.push_back(study.logs[k].measured - prediction[k]);
  }
  return left;
}

Search::Search(Case study, std::vector<Span> held_out,
               std::function<void(const std::string&)> progress)
    : study_(std::move(study)), progress_(std::move(progress)), held_out_(std::move(held_out)) {}

void Search::say(const std::string& text) const {
  if (progress_) progress_(text);
}

void Search::choose_cutoff(const std::vector<Member>& members) {
  if (study_.is_static()) {
    softer_ = harder_ = study_;
    return;
  }
  say("choosing the smoother");
  std::vector<double> grid;
  for (double hz = 5.0; hz < std::min(45.0, 0.2 / study_.dt()); hz *= 1.4) grid.push_back(hz);
  if (grid.empty()) grid.push_back(0.1 / study_.dt());
  std::vector<double> misfit(grid.size());
  const auto at = [&](double hz) {
    Case trial = study_;
    set_derivative(trial, {.kind = DerivativeSpec::Kind::kSpectral, .cutoff_hz = hz});
    return linear_misfit(trial, members);
  };
  for_each_piece(static_cast<Index>(grid.size()), [&](Index k) {
    misfit[static_cast<std::size_t>(k)] = at(grid[static_cast<std::size_t>(k)]);
  });
  const auto best =
      static_cast<std::size_t>(std::min_element(misfit.begin(), misfit.end()) - misfit.begin());
  double cutoff = grid[best];
  if (best > 0 && best + 1 < grid.size()) {  // vertex of the parabola through the three
    const double below = misfit[best - 1] - misfit[best], above = misfit[best + 1] - misfit[best];
    cutoff *= std::pow(1.4, 0.5 * (below - above) / (below + above));
  }
  const auto smoothed = [&](double hz) {
    Case other = study_;
    set_derivative(other, {.kind = DerivativeSpec::Kind::kSpectral, .cutoff_hz = hz});
    return other;
  };
  softer_ = smoothed(0.75 * cutoff);
  harder_ = smoothed(1.4 * cutoff);
  study_ = smoothed(cutoff);
}

void Search::make_setting(const std::vector<Member>& members) {
  const Signals prediction = predict(study_, members);
  left_ = difference(study_, prediction);
  Signals measured;
  for (const Log& log : study_.logs) measured.push_back(log.measured);
  floors_ = noise_floor(study_, left_);
  add_pose_noise(study_, floors_);
  const Whitener whitener(study_, floors_, noise_level(study_, left_));
  const Index stride = whitener.coarse_stride();
  setting_ = std::make_unique<Setting>(Setting{
      study_, whitener, thinned(study_, stride), whitener.at_stride(stride), measured, {}, {}});
  const Index rows = setting_->whitener.rows();
  setting_->mask = mask_of(setting_->whitener, held_out_, masked_);
  setting_->nuisance.resize(rows, 0);
  for (std::size_t k = 0; k < study_.logs.front().regressors.size(); ++k) {
    Signals column;
    for (const Log& log : study_.logs) column.push_back(log.regressors[k]);
    setting_->nuisance = appended(setting_->nuisance, setting_->whitened(column));
  }
  if (study_.is_static()) return;
  // What a little more or less smoothing changes, per channel.
  for (const Case* other : {&softer_, &harder_}) {
    const Signals there = predict(*other, members);
    for (Index j = 0; j < study_.channel_count(); ++j) {
      Signals change;
      for (std::size_t k = 0; k < there.size(); ++k) {
        change.push_back(Eigen::MatrixXd::Zero(there[k].rows(), there[k].cols()));
        change.back().col(j) = there[k].col(j) - prediction[k].col(j);
      }
      setting_->nuisance = appended(setting_->nuisance, setting_->whitened(change));
    }
  }
}

void Search::settle(const std::vector<Member>& members) {
  make_setting(members);
  fit_ = joint_fit(*setting_, members);
  left_ = difference(study_, predict(study_, fit_.members));
}

JointFit Search::without(std::size_t member) const {
  std::vector<Member> rest = fit_.members;
  rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(member));
  return joint_fit(*setting_, rest);
}

std::vector<Trial> Search::additions(const JointFit& fit) const {
  const Scan scan(*setting_, fit);
  const Signals left = difference(study_, scan.chain().prediction());
  const std::vector<Member> list = candidates(scan, left, floors_);
  std::vector<Trial> trials(list.size());
  for_each_piece(static_cast<Index>(list.size()), [&](Index k) {
    const Member& member = list[static_cast<std::size_t>(k)];
    const bool taken = std::any_of(fit.members.begin(), fit.members.end(),
                                   [&](const Member& m) { return same_place(m, member); });
    if (!taken) trials[static_cast<std::size_t>(k)] = scan.evaluate(member, Detail::kCoarse);
  });
  // The best seed of each effect and axis, then the best axes of each effect.
  std::map<std::string, Trial> places;
  for (const Trial& trial : trials) {
    if (!trial.member.kind || trial.gain <= 0.0) continue;
    Trial& best = places[trial.member.name() + " " + trial.member.axis];
    if (trial.gain > best.gain) best = trial;
  }
  std::vector<Trial> ranked;
  for (const auto& [place, trial] : places) ranked.push_back(trial);
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Trial& a, const Trial& b) { return a.gain > b.gain; });
  std::map<std::string, int> seen;
  std::vector<Trial> chosen;
  for (const Trial& trial : ranked) {
    if (seen[trial.member.name()]++ >= 2) continue;
    if (chosen.size() >= kRefined && trial.gain < 0.3 * ranked.front().gain) break;
    chosen.push_back(trial);
    if (chosen.size() >= 2 * kRefined) break;
  }
  const auto by_net_gain = [](const Trial& a, const Trial& b) {
    return a.net_gain() > b.net_gain();
  };
  for_each_piece(static_cast<Index>(chosen.size()), [&](Index k) {
    Trial& trial = chosen[static_cast<std::size_t>(k)];
    trial = scan.refine(trial, Detail::kCoarse, 40);
  });
  std::stable_sort(chosen.begin(), chosen.end(), by_net_gain);
  for_each_piece(std::min<Index>(kFine, static_cast<Index>(chosen.size())), [&](Index k) {
    Trial& trial = chosen[static_cast<std::size_t>(k)];
    trial = scan.refine(scan.evaluate(trial.member, Detail::kFine), Detail::kFine, 14);
  });
  if (!study_.is_static() && events_allowed_) {
    chosen.push_back(find_contact(scan));
    chosen.push_back(find_step(scan));
  }
  std::erase_if(chosen, [](const Trial& trial) { return trial.gain <= 0.0; });
  std::stable_sort(chosen.begin(), chosen.end(), by_net_gain);
  return chosen;
}

/// Adds the effect that gains most, if it gains enough.
bool Search::grow() {
  if (fit_.members.size() >= kMostMembers) return false;
  say("looking for what is missing beside " + std::to_string(fit_.members.size()) + " effects");
  const auto trials = additions(fit_);
  if (trials.empty()) return false;
  const Trial& best = trials.front();
  const double explained = std::max(0.0, chi2_before_ - fit_.chi2);
  if (best.net_gain() < kLeastNetGain || best.gain < kLeastShare * explained) return false;
  std::vector<Member> members = fit_.members;
  members.push_back(best.member);
  settle(members);
  return true;
}

/// Leaves out members that no longer earn their numbers.
bool Search::simplify() {
  bool changed = false;
  for (std::size_t m = 0; m < fit_.members.size() && fit_.members.size() > 1;) {
    if (fit_.members[m].fixed) {
      ++m;
      continue;
    }
    const JointFit rest = without(m);
    const double rise = rest.chi2 - fit_.chi2;
    if (rise >= kPerParameter * fit_.members[m].parameters() + kLeastNetGain) {
      ++m;
      continue;
    }
    settle(rest.members);
    changed = true;
    m = 0;
  }
  return changed;
}

/// Exchanges a member for another effect that serves better in its place.
bool Search::swap() {
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    if (fit_.members[m].fixed) continue;
    const JointFit rest = without(m);
    const double own = rest.chi2 - fit_.chi2 - kPerParameter * fit_.members[m].parameters();
    for (const Trial& trial : additions(rest)) {
      if (trial.member.kind == fit_.members[m].kind && trial.member.axis == fit_.members[m].axis) {
        continue;
      }
      if (trial.net_gain() < own - 20.0) break;  // the linear estimate may be a little off
      std::vector<Member> members = rest.members;
      members.push_back(trial.member);
      const JointFit other = joint_fit(*setting_, members);
      if (rest.chi2 - other.chi2 - kPerParameter * trial.member.parameters() > own + 2.0) {
        settle(members);
        return true;
      }
    }
  }
  return false;
}

/// Adds, exchanges and leaves out effects until nothing gains.
void Search::explore() {
  bool recut = false;
  for (int round = 0; round < 12; ++round) {
    if (grow()) {
      while (simplify()) {
      }
      continue;
    }
    if (fit_.members.size() == apart_.size()) return;
    say("trying other effects in place of those found");
    if (swap()) continue;
    if (replace_pairs()) continue;
    if (recut || study_.is_static()) return;
    recut = true;
    const bool lag = std::any_of(fit_.members.begin(), fit_.members.end(),
                                 [](const Member& m) { return m.kind->stage == Stage::kDynamics; });
    const double before = study_.derivative.cutoff_hz;
    if (!lag && before > 9.0 && before < 13.0) return;
    choose_cutoff(fit_.members);
    settle(fit_.members);
    if (std::abs(study_.derivative.cutoff_hz / before - 1.0) < 0.1) return;
  }
}

/// What tests of their own find in the raw force and at the log's rate.
void Search::detect() {
  for (const Clipping& clip : clipping(study_)) {
    const EffectKind& kind = *find_effect("saturation");
    Member member = make_member(kind, kind.fits[0],
                                admitted_axes(AxisRule::kSensor)[static_cast<std::size_t>(
                                    study_.channels[static_cast<std::size_t>(clip.channel)])],
                                study_.has_torque(), Eigen::VectorXd::Constant(1, clip.limit));
    member.fixed = true;
    apart_.push_back(member);
    masked_.insert(masked_.end(), clip.spans.begin(), clip.spans.end());
  }
  if (const double step = rounding_step(study_); step > 0.0) {
    const EffectKind& kind = *find_effect("quantisation");
    Member member = make_member(kind, kind.fits[0], "", study_.has_torque(),
                                Eigen::VectorXd::Constant(1, step));
    member.fixed = true;
    rounding_ = member;
    for (Case* study : {&study_, &softer_, &harder_}) {
      study->rounding_step = step;
      // The floor holds the rounding's own variance too.
      const double all = floors_.front().deviation();
      study->rounding_noise =
          std::sqrt(std::max(all * all - step * step / 12.0, 1e-4 * step * step));
    }
  }
  if (study_.is_static()) return;
  if (const auto hum = find_fast_hum(study_, left_, floors_)) apart_.push_back(*hum);
  const Knocks knocks = find_knocks(study_, left_, floors_);
  if (knocks.member) {
    knocking_ = knocks.member;
    masked_.insert(masked_.end(), knocks.spans.begin(), knocks.spans.end());
  }
}

/// Takes back what a remainder nobody can name makes doubtful: events, and members that fit in some
/// places and not in others.
void Search::judge() {
  bands_ = band_tests(*setting_, fit_.residual);
  const double explained = std::max(0.0, chi2_before_ - fit_.chi2);
  remains_ = is_alarming(bands_, explained);
  if (!remains_) return;
  say("something is left that no effect explains: names are tested again");
  if (events_allowed_) {
    events_allowed_ = false;
    std::vector<Member> rest;
    for (const Member& m : fit_.members) {
      if (!m.interval_s) rest.push_back(m);
    }
    if (rest.size() < fit_.members.size()) {
      settle(rest);
      explore();
    }
  }
  for (bool changed = true; changed && !fit_.members.empty();) {
    changed = false;
    const auto tests = constancy(*setting_, fit_);
    std::size_t worst = 0;
    for (std::size_t m = 1; m < tests.size(); ++m) {
      if (tests[m].z > tests[worst].z) worst = m;
    }
    if (!tests[worst].refutes()) break;
    std::vector<Member> rest = fit_.members;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(worst));
    settle(rest);
    changed = true;
  }
  bands_ = band_tests(*setting_, fit_.residual);
}

void Search::run() {
  choose_cutoff({});
  settle({});
  detect();
  settle(apart_);
  chi2_before_ = joint_fit(*setting_, {}).chi2;
  explore();
  chi2_before_ = joint_fit(*setting_, {}).chi2;
  judge();
}

std::vector<std::vector<std::string>> Search::alternatives() const {
  constexpr double kNear = 12.0;
  std::vector<std::vector<std::string>> all(fit_.members.size());
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    const Member& own = fit_.members[m];
    if (own.fixed) continue;
    const JointFit rest = without(m);
    const double net = rest.chi2 - fit_.chi2 - kPerParameter * own.parameters();
    for (const Trial& trial : additions(rest)) {
      if (trial.member.kind == own.kind || trial.net_gain() < net - 2.0 * kNear) continue;
      std::vector<Member> members = rest.members;
      members.push_back(trial.member);
      const JointFit other = joint_fit(*setting_, members);
      if (rest.chi2 - other.chi2 - kPerParameter * trial.member.parameters() > net - kNear &&
          std::find(all[m].begin(), all[m].end(), trial.member.name()) == all[m].end()) {
        all[m].push_back(trial.member.name());
      }
    }
  }
  return all;
}

}  // namespace dcnn
