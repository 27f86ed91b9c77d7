// SPDX-License-Identifier: Apache-2.0
// From the simulator as given to a model that leaves nothing but noise, or as near as names go.
#pragma once

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "diagnosis/evidence/posterior.h"
#include "diagnosis/impacts.h"
#include "diagnosis/judgement.h"
#include "diagnosis/scan.h"
#include "diagnosis/slow_part.h"
#include "diagnosis/span.h"

namespace dcnn {

/// What a model is weighed by: what it leaves, the noise that is estimated from that, and all that
/// fits beside it share.
struct Surroundings {
  Signals left;  ///< measured - predicted, at the log's rate
  std::vector<Floor> floors;
  std::vector<SlowPart> slow;
  std::unique_ptr<Setting> setting;
};

/// Another effect in the place of a member.
struct Alternative {
  std::string name;
  std::vector<Member> members;  ///< the whole model with it, fitted
  Eigen::VectorXd base;         ///< and the coefficients of its linear base, where there is one
  std::vector<Floor> floors;    ///< the noise by which both are weighed
  /// Variances by which noise of the motion makes its prediction noisier than that of the chosen.
  std::vector<double> noisier;
  double log_odds = 0.0;     ///< ln of its evidence over that of the model that was chosen
  double chi2_above = 0.0;   ///< its chi-square less that of the chosen
  double log_support = 0.0;  ///< ln of the factor by which held-out data change those odds
};

class Search {
 public:
  /// `progress` is told in words what is being done; it may be empty.
  /// Rows in `held_out` are not looked at.
  Search(Case study, std::vector<Span> held_out, std::function<void(const std::string&)> progress);

  void run();

  /// Times that the recordings have been predicted, once for each effect of the prediction.
  double passes() const;
  /// Whether all exchanges were tried, among names alone and beside laws.
  bool is_complete() const { return !ended_early_ && !is_spent() && !laws_are_spent(); }
  /// Whether the search for laws without a name has taken all that it may take: what is left then
  /// is not looked at again.
  bool laws_are_spent() const;

  const Case& study() const { return study_; }
  const JointFit& fit() const { return fit_; }
  const Setting& setting() const { return *setting_; }
  const std::vector<Floor>& floors() const { return floors_; }
  const Signals& left() const { return left_; }  ///< measured - predicted, at the log's rate
  /// Whether something acts that no name explains; a law without a name is such.
  bool remains() const { return remains_ || names().size() < fit_.members.size(); }
  const std::optional<Member>& rounding() const { return rounding_; }
  /// Names that data to which they were not fitted spoke against.
  const std::vector<Member>& refuted() const { return refuted_; }
  const std::optional<Member>& loose_load() const { return impacts_.member; }
  const Impacts& impacts() const { return impacts_; }
  /// Stretches that decide nothing, for far more is left there than elsewhere.
  const std::vector<Span>& outlying_spans() const { return outlying_; }
  const std::vector<BandTest>& bands() const { return bands_; }
  const evidence::Posterior& posterior() const { return posterior_; }
  /// For each member, other effects that the recordings cannot exclude in its place.
  std::vector<std::vector<Alternative>> alternatives() const;

  /// Takes back members that other data or another law refute, and judges what is left. They are
  /// not tried again.
  void leave_out(const std::vector<std::size_t>& members);
  /// What is left is noise, as data say that decided nothing.
  void take_rest_for_noise() { remains_ = false; }
  /// Takes back the hum that was heard above the motion's band, and judges what is left.
  void leave_hum();
  /// Removes the loose load, and searches in the rows that its impacts had masked.
  void leave_impacts();
  /// Searches beside what is left for other names than those that were left out: whether there are
  /// other members than before.
  bool look_again();
  /// Takes these members, but for those that do not earn their numbers, and judges what is left.
  void begin_with(const std::vector<Member>& members);
  /// Adds what gains beside the members, none of which is exchanged for it.
  void add_beside();
  /// Takes another model, whose members were fitted, and judges what it leaves.
  void adopt(const std::vector<Member>& members);
  /// Leaves out levers and lags that gain less than their price, and lags at their bound, which are
  /// no estimates: forces then act at the sensor's origin, driven laws follow their signal at once.
  void leave_untold_parts();
  /// Holds at zero what the recordings do not tell of effects with several numbers.
  void hold_untold();
  /// Leaves out all but what tests of their own found.
  void begin_anew();
  /// Whether a band holds more than noise and the error of the laws that were found leave.
  bool is_alarming_now();
  /// -2 ln of the likelihood, and the price of all numbers of the names.
  double penalised_deviance() const;
  /// Fits laws without a name beside the names, in place of those that were there.
  void put_beside(const std::vector<Member>& laws);
  /// Looks for names beside the laws: whether there are more than before.
  bool name_beside_laws();
  /// Whether names and laws leave nothing but noise; then weighs the names beside the laws.
  bool confirms_names();
  /// Fits these members; laws among them are no part of what is searched for.
  void hold(const std::vector<Member>& members);
  /// Leaves names that explain nothing beside the others, numbers at their price.
  void leave_idle_names();
  /// The members that are no laws without a name.
  std::vector<Member> names() const;
  /// Whitens again for what these members leave, and fits them.
  void settle(const std::vector<Member>& members);
  /// Leaves of a law that bends a commoner one, as friction of gears does, the commoner one where
  /// the recordings do not tell how it bends: whether there was such.
  bool leave_untold_bends();
  std::vector<Member> members_without(std::size_t member) const;
  /// The model without one member, the others refitted.
  const JointFit& without(std::size_t member) const;
  /// The best additions to the model at hand, at most one per effect, refined, best first; contacts
  /// and steps among them where `events`.
  std::vector<Trial> additions(bool events = true) const;

  /// Tells whoever follows the search what it does now.
  void say(const std::string& text) const;

 private:
  /// Whether data on which it was not fitted have refuted this effect there.
  bool was_refuted(const Member& candidate) const;
  /// What is known of the model without one member: computed when it is first asked for.
  struct Place {
    std::optional<JointFit> rest;
    std::optional<std::vector<Trial>> others;
  };
  /// The best additions to a model; contacts and steps among them where `events`. What is far below
  /// `needed`, a net gain, is not refined; where there is none, far below the best.
  std::vector<Trial> additions(const JointFit& fit, bool events,
                               std::optional<double> needed) const;
  /// The best effects in place of a member, its own among them.
  const std::vector<Trial>& others(std::size_t member) const;
  /// What a member takes off chi-square, and that beyond the price of its numbers.
  double gain(std::size_t member) const;
  double net_gain(std::size_t member) const;
  /// The latter as a trial in its place tells it, with the other members' shapes as they are
  /// without it: what trials of other effects there are to be compared with.
  double net_gain_as_trial(std::size_t member) const;
  void forget_places();
  /// What is left counts as noise: of poses at rest, which have no spectrum, and beside a tool's
  /// own numbers that held-out data have chosen.
  bool is_overdispersed() const { return study_.is_static() || beside_own_numbers_; }
  /// What is left is the error of laws, as always of a machine: noise is no measure of it.
  bool is_inexact() const { return study_.axis || swamped_; }
  /// Whether what a tool leaves swamps its noise, and was not known to.
  bool swamps_noise();
  /// Chi-square that the members took off: all, for what an error of the motion makes of their
  /// forces; or those with numbers, for what an error of a law may hide (what has no number of its
  /// own, as the inertial terms, cannot be a little wrong).
  double explained(bool all) const;
  /// How far the gain of an addition may be from that of a joint fit.
  double doubt(const Trial& trial) const;
  /// Found by a test that a joint fit cannot repeat.
  bool stays(const Member& member) const;
  /// A mode is among the members that are fitted.
  bool rings() const;
  void smooth(double cutoff_hz);
  std::vector<Case*> cases();  ///< study_ and the same under other filters
  void choose_cutoff(const std::vector<Member>& members);
  void pass_motion(const std::vector<Member>& members);
  void pass_more_motion();
  void tune_to_mode();
  bool choose_rounding_noise();
  Surroundings surroundings(const std::vector<Member>& members) const;
  void make_setting(const std::vector<Member>& members);
  void fit_beside_base(const std::vector<Member>& members);
  bool grow();
  bool simplify();
  bool straighten();
  std::optional<std::size_t> cancelled() const;
  bool swap();
  bool floor_moved() const;
  bool replace_pairs();
  void explore();
  /// Leaves rows out that are outlying beside the model at hand: whether others than before.
  bool mask_outlying();
  void detect();
  std::optional<Member> heard_hum(const Signals& left) const;
  bool hums_no_more();
  bool detect_impacts();
  bool still_has_impacts();
  void search_without_impacts();
  void drop_coincidences();
  void drop_unconfirmed();
  void let_ring();
  bool are_constant() const;
  bool noise_suffices();
  /// A product of pose, rates, force or time gains in what is left.
  bool depends_on_motion() const;
  bool is_independent();
  bool may_be_slow_noise(const Member& member) const;
  bool admit_slow_noise();
  void put_events_beside_noise(const std::vector<Member>& found);
  bool admit_colour();
  bool admit_own_zeros();
  void judge();
  void conclude();
  bool begin_with_own_numbers();
  /// How much worse a model is beside the noise at hand than that at hand, in prices of a number.
  double worse(const std::vector<Member>& members) const;
  bool put_common_laws();
  void search_beside_common_laws();
  bool begin_without_refuted();
  /// What a search from another beginning changes.
  struct State {
    std::vector<Member> members;
    Case study;
    std::vector<Case> smoothed;
    std::optional<DerivativeSpec> other_filter;
    bool tuned, ringing, in_slow_noise, events_allowed;
  };
  State state() const;
  /// The same again, but for the members, which settle() takes.
  void restore(const State& state);
  void leave_bounded_lags();
  void straighten_drifts();
  bool keep_what_carries_over();
  void keep_what_is_confirmed();
  double rest_loudness() const;
  std::vector<double> doubts(double little);
  bool remove_near_laws();
  bool keep_unaffected();
  /// Evidence of the members, of subsets of them, and of none, with and without an unknown: the
  /// place of the most probable among them.
  std::size_t weigh_once();
  /// Leaves the most probable of these.
  void weigh();
  /// What the weighed structures say of something that no name explains.
  void judge_rest();
  /// Passes after which effects are no more added and exchanged: some fifty times what a search for
  /// one effect takes, so that a search among laws none of which fits ends too.
  static constexpr double kMostPasses = 50'000.0;
  bool is_spent() const { return passes() - begun_ >= kMostPasses; }
  /// Lets what follows take at least this share of the limit.
  void allow(double share);
  /// What a search beside other noise begins with: what tests of their own found; all that was
  /// found where it is spent, for it would find nothing again.
  std::vector<Member> to_begin_with() const;

  Case study_;
  std::vector<Case>
      smoothed_;  // the same under other filters of the pose: what filtering alone does
  std::optional<DerivativeSpec>
      other_filter_;  // with a Wiener gain, if the chosen has none, and vice versa
  std::function<void(const std::string&)> progress_;
  std::vector<Floor> floors_;
  std::unique_ptr<Setting> setting_;
  JointFit fit_;
  mutable std::vector<Place> places_;  // one a member, of fit_
  Signals left_;
  std::vector<Span> held_out_;  // and the rests() of a machine
  std::vector<Span> masked_, outlying_;
  std::vector<Member> apart_;              // members found by tests of their own
  std::optional<Member> rounding_;         // named, but no part of what is fitted
  Impacts impacts_;                        // nor are these
  std::vector<Member> refuted_;            // by data on which they were not fitted
  std::set<const EffectKind*> set_aside_;  // kinds that a second beginning does without
  std::vector<BandTest> bands_;
  evidence::Posterior posterior_;
  std::optional<std::vector<Floor>> noise_;  // admitted in place of the floor from above the motion
  bool in_slow_noise_ = false;  // slow_ is estimated beside the members that are fitted
  bool tried_slow_noise_ = false;
  std::vector<SlowPart> slow_;  // of each channel, beside the floor from above the motion
  bool events_allowed_ = true, remains_ = false;
  double begun_ = 0.0;  // passes before the search among names alone, or beside laws, began
  bool ended_early_ = false, began_again_ = false;
  Index samples_ = 0;                // of the recordings
  bool beside_own_numbers_ = false;  // which held-out data have chosen
  bool swamped_ = false;                   // the noise of a tool, by what its laws leave
  bool tuned_ = false;               // the smoother, to a mode
  bool ringing_ = false;  // what shakes the motion unseen rings in the modes that were found
};

/// Whether a drift is among the members of which the recordings tell no time constant (its 95 %
/// interval spans two decades), or a law that bends a commoner one by as little told numbers.
bool has_untold_shape(const Setting& setting, const JointFit& fit);

/// Which effects these are, and where.
std::multiset<std::string> places_of(const std::vector<Member>& members);

/// measured - predicted per recording, of one that was zeroed without its mean.
Signals difference(const Case& study, const Signals& prediction);

}  // namespace dcnn
