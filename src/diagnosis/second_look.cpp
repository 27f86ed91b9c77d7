// Before a remainder is called unexplained: what could make it without any effect being missing.
#include <algorithm>

#include "diagnosis/axis_case.h"
#include "diagnosis/search.h"

namespace dcnn {
namespace {

constexpr double kLooser = 1.2;  // of the smoother's cut-off

}  // namespace

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

/// Whether a smoother that lets a little more of the motion through leaves nothing: the pose's
/// noise and the motion may meet between two cut-offs, and a mode makes much of little motion.
bool Search::loosen() {
  if (study_.is_static() || study_.axis) return false;
  const double below = study_.derivative.cutoff_hz / 2.0;
  const bool slow = std::any_of(bands_.begin(), bands_.end(), [&](const BandTest& band) {
    return band.stands_out() && band.from_hz < below;
  });
  if (slow) return false;
  const double cutoff = study_.derivative.cutoff_hz;
  const std::vector<Member> members = fit_.members;
  double looser = cutoff;
  for (int step = 0; step < (ringing_ ? 3 : 1); ++step) {
    smooth(looser *= kLooser);
    settle(members);
    if (!is_alarming_now()) return true;
  }
  smooth(cutoff);
  settle(members);
  is_alarming_now();
  return false;
}

bool Search::are_constant() const {
  const auto tests = constancy(*setting_, fit_);
  return std::none_of(tests.begin(), tests.end(),
                      [](const Constancy& test) { return test.refutes(); });
}

/// Whether beside the noise that was admitted no law gains and nothing is left, in no band and of
/// no product of what moves.
bool Search::noise_suffices() { return !grow() && is_independent(); }

/// Whether noise of one colour, which the band above the motion bears out, is all that is left: far
/// below that band its colour is hardly known from there.
bool Search::admit_colour() {
  if (study_.is_static() || study_.without.coloured_floor) return false;
  const Signals raw = study_.lowpass_hz > 0.0 ? unfiltered_left(study_, fit_.members) : left_;
  const std::vector<Member> members = fit_.members;
  noise_ = noise_of_all(study_, raw, noise_level(study_, raw));
  if (noise_) {
    settle(members);
    if (noise_suffices()) return true;
    noise_.reset();
    settle(members);
    is_alarming_now();
  }
  return false;
}

/// Beside a slow remainder a law must gain by the numbers that a simpler relative lacks what it
/// would have to in noise as loud; a machine's drift their price, also after other names are gone
/// (one that settles long after the recording ends is a straight line).
void Search::prefer_fewer_numbers() {
  const double loud = rest_loudness();
  if (loud == 1.0 && !study_.axis) return;
  for (std::size_t m = 0; m < fit_.members.size(); ++m) {
    const Member& own = fit_.members[m];
    if (own.fixed || (study_.axis && own.kind->stage != Stage::kOffset)) continue;
    const auto simpler = std::find_if(others(m).begin(), others(m).end(), [&](const Trial& trial) {
      return same_family(trial.member, own) && trial.member.parameters() < own.parameters();
    });
    if (simpler == others(m).end()) continue;
    std::vector<Member> members = without(m).members;
    members.push_back(simpler->member);
    const JointFit other = joint_fit(*setting_, members);
    const int more = own.parameters() - simpler->member.parameters();
    const double least =
        study_.axis ? setting_->price * more : loud * least_gain(*setting_, more, false);
    if (other.chi2 - fit_.chi2 > least) continue;
    settle(other.members);
    m = 0;
  }
}

}  // namespace dcnn
