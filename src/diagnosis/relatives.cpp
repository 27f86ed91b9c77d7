// SPDX-License-Identifier: Apache-2.0
// Laws that are near the one that acts, and none of them: what gives them away.
#include <algorithm>
#include <set>
#include <string>

#include "diagnosis/axis_case.h"
#include "diagnosis/candidates.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/modulation.h"
#include "diagnosis/position_bins.h"
#include "diagnosis/search.h"
#include "physics/effect_law.h"

namespace dcnn {
namespace {

constexpr double kSlowestMode = 2.0;  // Hz

/// A wave beside a straight line or a loop over its angle that does not repeat itself within the
/// motion (a cubic less its line has one period and a half): together they are a spring that bends.
bool bends_a_spring(const Member& wave, const std::vector<Member>& members) {
  using Course = EffectKind::Course;
  const bool once =
      wave.kind->course == Course::kWave && wave.shapes(0) < kFewestRepeats * wave.least_shapes(0);
  const auto angle = [](const Member& m) { return m.axis.substr(0, m.axis.find(':')); };
  return once && std::any_of(members.begin(), members.end(), [&](const Member& m) {
           const Course course = m.kind->course;
           const bool bends = course == Course::kStraight || course == Course::kLoop;
           return bends && angle(m) == angle(wave);
         });
}

}  // namespace

/// Where little is left, and slowly, the offset wanders as no drift does: that falls on all columns
/// alike, and this is how loud it is. Else a wrong law may leave it, and 1.
double Search::rest_loudness() const {
  if (is_inexact() || is_overdispersed()) return 1.0;
  const double left = left_over(bands_);
  const bool slow = bands_.front().excess > prior::kMostlySlow * left;
  return slow && left < prior::kNothing * explained(false) ? loudest(bands_) : 1.0;
}

/// How far each member is from the law it is named after, above 1 refuted: it fits in some places
/// and not in others, or its strength depends on what its law does not know of. A law that explains
/// so much that what is wrong with it is `little` of it may be a little wrong.
std::vector<double> Search::doubts(double little) {
  std::vector<double> doubts(fit_.members.size(), 0.0);
  if (is_inexact() || study_.is_static() || study_.without.omnibus) return doubts;
  bands_ = band_tests(*setting_, fit_.residual);
  const auto tests = constancy(*setting_, fit_);
  const double loud = rest_loudness();
  const auto strengths = modulations(*setting_, fit_);
  double swings = 0.0;
  for (const BandTest& band : bands_) {
    if (band.stands_out() && band.from_hz >= kSlowestMode) swings += band.excess;
  }
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    if (fit_.members[m].fixed) continue;
    // An offset is no law of motion: what goes with it by so little is another effect beside it.
    const bool is_offset = fit_.members[m].kind->stage == Stage::kOffset;
    const double slack = (is_offset ? prior::kNothing : little) * std::max(0.0, net_gain(m));
    double& apart = doubts[m];
    const Modulation& strength = strengths[m];
    if (strength.gain > slack) {
      apart = std::min(strength.gain / loud, strength.beyond) / prior::kModulated;
    }
    if (tests[m].refutes() && tests[m].excess > slack) {
      const double beside = std::max(loud, tests[m].overdispersion);
      apart = std::max(apart, tests[m].above(beside) / prior::kInconstant);
    }
    if (bends_a_spring(fit_.members[m], fit_.members)) apart = kInfinity;
    // Beside low-frequency noise a constant offset is its mean.
    if (loud > 1.0 && fit_.members[m].kind->is_constant) apart = 0.0;
    // Motion that nobody sees rings in a mode here and there. One that leaves more where modes are,
    // or of whose remainder a second one, driven by what is seen, explains most, is one of several.
    if (fit_.members[m].kind->stage == Stage::kResonance) {
      const double second = second_mode(*setting_, fit_, fit_.members[m]);
      const bool several =
          second > std::max(prior::kSecondMode + prior::kLeastShare * net_gain(m), 0.5 * swings);
      apart = swings <= prior::kNothing * net_gain(m) && !several ? 0.0 : kInfinity;
    }
  }
  return doubts;
}

/// Takes back the member that is least the law it is named after.
bool Search::remove_near_laws() {
  const std::vector<double> far = doubts(prior::kLeastShare);
  const auto worst = std::max_element(far.begin(), far.end());
  if (worst == far.end() || *worst <= 1.0) return false;
  const auto at = static_cast<std::size_t>(worst - far.begin());
  std::vector<Member> rest = members_without(at);
  // What is certain of a drift that is none is its mean.
  const bool drifts = fit_.members[at].kind->stage == Stage::kOffset;
  if (rest_loudness() > 1.0 && drifts) add_constant(study_, rest);
  settle(rest);
  return true;
}

/// Where a law is refuted, the others are judged beside it, for without it what it stands for would
/// hide them: keeps those that it leaves alone, that act along another direction and are too strong
/// to be a mere correction of it. False where there is none, and where only drifts and steps are
/// refuted: an offset that wanders hides nothing that moves.
bool Search::keep_unaffected() {
  const std::vector<double> far = doubts(prior::kLeastShareBesideRefuted);
  const auto direction = [](const Member& m) { return m.axis.substr(m.axis.find(':') + 1); };
  double wrong = 0.0;
  bool moves = false;
  std::set<std::string> directions;
  for (std::size_t m = 0; m < far.size(); ++m) {
    if (far[m] <= 1.0) continue;
    wrong += std::max(0.0, net_gain(m));
    directions.insert(direction(fit_.members[m]));
    moves = moves || fit_.members[m].kind->stage != Stage::kOffset;
  }
  if (!moves) return false;
  const double least = std::max(prior::kKeptOfRefuted * wrong, left_over(bands_));
  std::vector<Member> kept;
  bool any = false;
  for (std::size_t m = 0; m < far.size(); ++m) {
    const Member& member = fit_.members[m];
    const bool stands = far[m] <= 1.0 && net_gain(m) > least &&
                        (member.axis.empty() || !directions.count(direction(member)));
    if (stands || member.fixed) kept.push_back(member);
    any = any || (stands && !member.fixed);
  }
  if (any) settle(kept);
  return any;
}

}  // namespace dcnn
