// What tests of their own find, what is taken back, and what cannot be excluded.
#include <algorithm>
#include <cmath>

#include "diagnosis/candidates.h"
#include "diagnosis/detectors.h"
#include "diagnosis/knocks.h"
#include "diagnosis/left_out.h"
#include "diagnosis/modulation.h"
#include "diagnosis/search.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr double kSlowestMode = 2.0;   // Hz
constexpr double kUnseen = 0.05;       // of a mode's gain: ringing that nobody sees the cause of
constexpr double kLeastDoubt = 0.001;  // of a member's gain
constexpr double kLittle = 0.05;       // of what was missing
constexpr double kSlowPart = 0.7;      // of what is left

/// A cogging beside a spring, or a hysteresis, of its angle that would make less than a turn if it
/// could: together they are a spring that bends.
bool bends_a_spring(const Member& cogging, const std::vector<Member>& members) {
  const bool least = cogging.name() == "cogging" && cogging.least_shapes.size() > 0 &&
                     cogging.shapes(0) < 1.01 * cogging.least_shapes(0);
  return least && std::any_of(members.begin(), members.end(), [&](const Member& m) {
           const bool bends = m.name() == "cable_spring" || m.name() == "hysteresis";
           return bends && m.axis == cogging.axis;
         });
}

}  // namespace

/// What tests of their own find in the raw force and at the log's rate.
void Search::detect() {
  for (const Clipping& clip : clipping(study_)) {
    const EffectKind& kind = *find_effect("saturation");
    Member member = make_member(kind, kind.fits[0],
                                admitted_axes(AxisRule::kSensor)[static_cast<std::size_t>(
                                    study_.channels[static_cast<std::size_t>(clip.channel)])],
                                study_.has_torque(), Eigen::VectorXd::Constant(1, clip.limit));
    member.fixed = true;
    // A limit is read off: known to the digit, or to the step that rounding makes of it.
    const double digit = std::max(reading_digit(study_), rounding_step(study_));
    member.fixed_deviation = Eigen::VectorXd::Constant(1, digit / std::sqrt(12.0));
    apart_.push_back(member);
    masked_.insert(masked_.end(), clip.spans.begin(), clip.spans.end());
  }
  // A machine's values come in any unit: its lattice matters where the noise does not cover it.
  const double least = study_.axis ? floors_.front().deviation() : 0.0;
  if (const double step = rounding_step(study_); step > least) {
    const EffectKind& kind = *find_effect("quantisation");
    Member member = make_member(kind, kind.fits[0], "", study_.has_torque(),
                                Eigen::VectorXd::Constant(1, step));
    member.fixed = true;
    member.fixed_deviation = Eigen::VectorXd::Constant(1, rounding_deviation(study_, step));
    rounding_ = member;
    for (Case* study : {&study_, &softer_, &harder_}) {
      study->rounding_step = step;
      study->rounding_noise = 0.3 * step;  // choose_rounding_noise()
    }
  }
  if (study_.is_static()) return;
  if (const auto hum = find_fast_hum(study_, left_, floors_)) {
    double power = 0.0, rows = 0.0;
    for (const auto& left : left_) {
      power += left.squaredNorm();
      rows += static_cast<double>(left.size());
    }
    // A motor's log is full of faint lines: of what is left on a machine one must be a share.
    const bool counts = !study_.axis || 0.5 * hum->amplitudes.squaredNorm() * rows > 0.002 * power;
    if (counts) apart_.push_back(*hum);
  }
  hear_knocks();
}

bool Search::hear_knocks() {
  if (knocking_ || study_.is_static() || !is_listed(study_, *find_effect("loose_load")))
    return false;
  const Knocks knocks = find_knocks(study_, left_);
  if (!knocks.member) return false;
  knocking_ = knocks.member;
  masked_.insert(masked_.end(), knocks.spans.begin(), knocks.spans.end());
  return true;
}

/// Takes back, the most doubtful first, what signs drawn at random for each second explain as
/// often: a coincidence of a few moments, not a law. (An event has too few seconds for this test.)
void Search::drop_coincidences() {
  constexpr double kMostLikely = 0.05, kCertain = 50.0;
  if (study_.is_static() || study_.without.flips) return;
  while (true) {
    double most = kMostLikely;
    std::optional<std::size_t> worst;
    for (std::size_t m = 0; m < fit_.members.size(); ++m) {
      if (stays(fit_.members[m]) || fit_.members[m].interval_s) continue;
      if (net_gain(m) > kCertain * setting_->price) continue;  // nor do a few moves have enough
      const double p = flip_p_value(*setting_, fit_, m);
      if (p > most) most = p, worst = m;
    }
    if (!worst) return;
    settle(members_without(*worst));
  }
}

bool Search::is_alarming_now() {
  bands_ = band_tests(*setting_, fit_.residual);
  return !study_.without.omnibus && is_alarming(bands_, explained(true));
}

/// Where little is left, and slowly, the offset wanders as no drift does: that falls on all columns
/// alike, and this is how loud it is. Else a wrong law may leave it, and 1.
double Search::rest_loudness() const {
  if (study_.axis) return 1.0;
  const double left = left_over(bands_);
  const bool slow = bands_.front().excess > kSlowPart * left;
  return slow && left < kLittle * explained(false) ? loudest(bands_) : 1.0;
}

/// Takes back the member that is least the law it is named after: one that fits in some places and
/// not in others, or whose strength depends on what its law does not know of.
bool Search::take_back_relatives() {
  if (study_.axis || study_.is_static() || study_.without.omnibus) return false;
  bands_ = band_tests(*setting_, fit_.residual);
  const auto tests = constancy(*setting_, fit_);
  const auto strengths = modulations(*setting_, fit_);
  double swings = 0.0;
  for (const BandTest& band : bands_) {
    if (band.stands_out() && band.from_hz >= kSlowestMode) swings += band.excess;
  }
  const double loud = rest_loudness();
  double most = 1.0;
  std::optional<std::size_t> worst;
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    if (fit_.members[m].fixed) continue;
    // A law that explains a thousand times what is wrong with it may be a little wrong.
    const double slack = kLeastDoubt * std::max(0.0, net_gain(m));
    double apart = strengths[m] > slack ? strengths[m] / (kModulated * loud) : 0.0;
    if (tests[m].refutes() && tests[m].excess > slack) {
      apart = std::max(apart, tests[m].above(loud) / kInconstant);
    }
    if (bends_a_spring(fit_.members[m], fit_.members)) apart = kInfinity;
    // Beside an offset that wanders a bias is its mean.
    if (loud > 1.0 && fit_.members[m].name() == "bias") apart = 0.0;
    // Motion that nobody sees rings in a mode here and there. One that leaves something where modes
    // are is one of several.
    if (fit_.members[m].kind->stage == Stage::kResonance) {
      apart = swings > kUnseen * net_gain(m) ? kInfinity : 0.0;
    }
    if (apart > most) most = apart, worst = m;
  }
  if (!worst) return false;
  std::vector<Member> rest = members_without(*worst);
  // What is certain of a drift that is none is its mean.
  const EffectKind& bias = *find_effect("bias");
  const bool drifts = fit_.members[*worst].kind->stage == Stage::kOffset;
  if (loud > 1.0 && drifts && is_listed(study_, bias) &&
      std::none_of(rest.begin(), rest.end(), [&](const Member& m) { return m.kind == &bias; })) {
    rest.push_back(make_member(bias, bias.fits[0], "", study_.has_torque(), {}));
  }
  settle(rest);
  return true;
}

/// Leaves out a faint name that only makes up for what a relative of a stronger law leaves: without
/// it that law's strength varies by more than the name explains.
bool Search::uncover_relatives() {
  constexpr double kFaint = 6.0;  // prices
  if (study_.axis || study_.is_static() || study_.without.omnibus) return false;
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    if (fit_.members[m].fixed || net_gain(m) > kFaint * setting_->price) continue;
    const JointFit& rest = without(m);
    const double needed = kModulated + setting_->price + std::max(0.0, net_gain(m));
    for (const double strength : modulations(*setting_, rest)) {
      if (strength < needed || strength < kLeastDoubt * explained(false)) continue;
      settle(std::vector<Member>(rest.members));
      return true;
    }
  }
  return false;
}

/// Takes back what a remainder nobody can name makes doubtful: events, and members that fit in some
/// places and not in others.
void Search::judge() {
  drop_coincidences();
  if (study_.axis) keep_what_carries_over();
  remains_ = is_alarming_now();
  if (remains_ && (loosen() || admit_flicker())) remains_ = false;
  if (!remains_ && !take_back_relatives() && !uncover_relatives()) return;
  remains_ = true;
  say("something is left that no effect explains: names are tested again");
  if (events_allowed_) {
    events_allowed_ = false;
    forget_places();
    std::vector<Member> rest;
    for (const Member& m : fit_.members) {
      if (!m.interval_s) rest.push_back(m);
    }
    if (rest.size() < fit_.members.size()) {
      settle(rest);
      explore();
    }
  }
  if (study_.axis) {
    keep_what_carries_over();
    bands_ = band_tests(*setting_, fit_.residual);
    return;
  }
  while (take_back_relatives()) {
  }
  drop_coincidences();
  drop_minor();
  prefer_fewer_numbers();
  if (study_.is_static()) return;
  choose_cutoff(fit_.members);  // beside what is no more another one was best
  settle(fit_.members);
  bands_ = band_tests(*setting_, fit_.residual);
}

/// Beside a remainder nobody can name, a name that explains less than what is left is more likely a
/// part of it; where that is little, a name must stand out from it as it must from the noise.
void Search::drop_minor() {
  while (true) {
    bands_ = band_tests(*setting_, fit_.residual);
    const double loud = rest_loudness(), left = left_over(bands_);
    double most = 0.0;
    std::optional<std::size_t> worst;
    for (std::size_t m = 0; m < fit_.members.size(); ++m) {
      const Member& member = fit_.members[m];
      if (member.fixed) continue;
      const double price = setting_->price * member.parameters();
      const double noise = loud * (least_net_gain(*setting_) + price) - price;
      const double needed = loud > 1.0 ? std::min(left, noise) : left;
      if (needed - net_gain(m) > most) most = needed - net_gain(m), worst = m;
    }
    if (!worst) return;
    settle(members_without(*worst));
  }
}

/// Of a machine, where laws are never constant to the last digit: a name must help on pieces of
/// time on which it was not fitted; and a mode takes nothing off.
void Search::keep_what_carries_over() {
  constexpr double kMostOfIt = 0.5;
  std::vector<Member> members = fit_.members;
  std::erase_if(members, [](const Member& m) {
    return m.kind->stage == Stage::kResonance && m.amplitudes(0) < 0.0;
  });
  if (members.size() < fit_.members.size()) settle(members);
  while (!fit_.members.empty()) {
    const auto shares = left_out_shares(*setting_, fit_);
    const auto worst = std::min_element(shares.begin(), shares.end());
    if (*worst >= kMostOfIt) break;
    settle(members_without(static_cast<std::size_t>(worst - shares.begin())));
  }
}

std::vector<std::vector<std::string>> Search::alternatives() const {
  constexpr double kNear = 12.0;        // of chi-square
  constexpr double kLeastOfMore = 0.5;  // of the price of a number
  constexpr double kBend = 0.06;        // of a gain: what another bend of a law is worth
  const double price = setting_->price, loud = rest_loudness();
  std::vector<std::vector<std::string>> all(fit_.members.size());
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    const Member& own = fit_.members[m];
    if (own.fixed) continue;
    const JointFit& rest = without(m);
    const double net = net_gain(m), own_gain = rest.chi2 - fit_.chi2;
    for (const Trial& trial : others(m)) {
      // What explains a remainder better than the member explains its own is none in its place.
      if (remains_ && trial.member.axis != own.axis) continue;
      if (trial.member.kind == own.kind ||
          trial.net_gain() < net - std::max(0.4 * kNear * price, doubt(trial))) {
        continue;
      }
      std::vector<Member> members = rest.members;
      members.push_back(trial.member);
      const JointFit other = joint_fit(*setting_, members);
      // One that needs more numbers holds the named one as a special case: where they gain nothing,
      // nothing speaks for it.
      const int more = trial.member.parameters() - own.parameters();
      const double near = 0.1 * kNear * price;
      double least = more > 0 ? kLeastOfMore * price * more * loud : price * more - near;
      // A small force hides how it bends.
      if (more > 0 && same_family(trial.member, own))
        least = std::min(least, kBend * own_gain - near);
      if (fit_.chi2 - other.chi2 > least &&
          std::find(all[m].begin(), all[m].end(), trial.member.name()) == all[m].end()) {
        all[m].push_back(trial.member.name());
      }
    }
  }
  return all;
}

}  // namespace dcnn
