// SPDX-License-Identifier: Apache-2.0
#include "dcnn/diagnosis/diagnose.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "dcnn/core/blocking.h"
#include "diagnosis/axes.h"
#include "diagnosis/axis_case.h"
#include "diagnosis/axis_words.h"
#include "diagnosis/budget.h"
#include "diagnosis/candidates.h"
#include "diagnosis/confidence.h"
#include "diagnosis/dead_channels.h"
#include "diagnosis/discovered.h"
#include "diagnosis/evidence/posterior_json.h"
#include "diagnosis/findings.h"
#include "diagnosis/heard.h"
#include "diagnosis/holdout.h"
#include "diagnosis/locate.h"
#include "diagnosis/online.h"
#include "diagnosis/own_numbers.h"
#include "diagnosis/own_zeros.h"
#include "diagnosis/plain_findings.h"
#include "diagnosis/portrait.h"
#include "diagnosis/rest.h"
#include "diagnosis/resting_search.h"
#include "diagnosis/weak_effects.h"
#include "diagnosis/words.h"

namespace dcnn {
namespace {

const char* verdict_of(bool named, bool remains) {
  if (named) return remains ? "partly-explained" : "explained";
  return remains ? "unexplained" : "consistent";
}

std::vector<std::string> names_of(const Case& study) {
  std::vector<std::string> names;
  for (const Log& log : study.logs) names.push_back(log.recording.name);
  return names;
}

/// The recordings whose offset is their own.
std::vector<std::string> zeroed_in(const Case& fit, const Case& holdout) {
  std::vector<std::string> names;
  for (const Case* study : {&fit, &holdout}) {
    for (const Log& log : study->logs) {
      if (log.zeroed) names.push_back(log.recording.name);
    }
  }
  return names;
}

/// RMSE on what was held out, before (of the simulator as it was given), with own numbers refitted,
/// and after.
Json errors_json(const Search& search, const HoldOut& simulator, const HoldOut& holdout,
                 const JointFit& given) {
  const Case& study = search.study();
  const JointFit& fit = search.fit();
  Json json{{"holdout_rmse_before", nullptr},
            {"holdout_rmse_parameters", nullptr},
            {"holdout_rmse_after", nullptr},
            {"holdout_rms_measured", nullptr},
            {"holdout_explained_before", nullptr}};
  if (holdout.empty()) return json;
  const HoldOut::Worth worth = simulator.worth({}, given.base);
  json["holdout_rms_measured"] = worth.measured_rms;
  json["holdout_explained_before"] = worth.explained;
  json["holdout_rmse_before"] = simulator.rmse({}, given.base);
  json["holdout_rmse_after"] = holdout.rmse(fit.members, fit.base);
  if (study.own_tool || study.axis) {
    const std::vector<Member> numbers = own_parameters(study);
    const auto own =
        given.base.size() > 0 || numbers.empty() ? given : joint_fit(search.setting(), numbers);
    json["holdout_rmse_parameters"] = holdout.rmse(own.members, own.base);
  }
  return json;
}

/// Stretches in which far more is left than elsewhere: they decided nothing.
Json outlying_json(const Search& search) {
  const Case& study = search.study();
  Json list = Json::array();
  for (const Span& span : search.outlying_spans()) {
    const Json axis = study.axis ? Json(study.axis->axis().name) : Json();
    list.push_back({{"recording", study.logs[span.log].recording.name},
                    {"interval_s", {span.begin, span.end}},
                    {"axis", axis}});
  }
  return list;
}

/// What reading made of each recording.
Json notes_of(const std::vector<const Case*>& studies) {
  Json list = Json::array();
  for (const Case* study : studies) {
    for (const Log& log : study->logs) {
      for (const auto& note : log.recording.notes) list.push_back(log.recording.name + ": " + note);
    }
  }
  return list;
}

Json deviations(const std::vector<Floor>& floors) {
  Json list = Json::array();
  for (const Floor& floor : floors) list.push_back(floor.deviation());
  return list;
}

/// Of names that laws took the place of, where held-out data refuted all those laws: they stand
/// again if the held-out data bear them out better than what stood beside the laws.
void take_back_names(Search& search, const HoldOut& holdout, const std::vector<Member>& names) {
  const JointFit before = joint_fit(search.setting(), names);
  const Signals with = holdout.prediction(before.members, before.base);
  const Signals without = holdout.prediction(search.fit().members, search.fit().base);
  if (holdout.log_support(with, without, search.floors()) > 0.0) search.hold(names);
}

/// Looks for other names than those that were refuted, where something remains: each round leaves
/// out a name for good. Names that the held-out data bear out may have gone for ones that they
/// refute, and stand again where they predict these better.
void look_beyond_refuted(Search& search, const HoldOut& holdout, Json& refuted) {
  for (Json more = refuted; !more.empty() && search.remains();) {
    const std::vector<Member> before = search.fit().members;
    const Signals by_them = holdout.prediction(before, search.fit().base);
    if (!search.look_again()) return;
    more = leave_refuted(search, holdout);
    for (const Json& name : more) refuted.push_back(name);
    const Signals now = holdout.prediction(search.fit().members, search.fit().base);
    if (holdout.log_support(now, by_them, search.floors()) >= 0.0) continue;
    search.adopt(before);
    return;
  }
}

}  // namespace

CaseDiagnosis diagnose_case(LoadedCase loaded,
                            const std::function<void(const std::string&)>& progress) {
  refuse_dead_channels(loaded.fit);
  refuse_dead_channels(loaded.holdout);
  std::vector<Span> held_out;
  if (loaded.holdout.logs.empty()) held_out = held_out_blocks(loaded.fit, true);
  const auto run = searched(loaded, held_out, progress);
  Search& search = *run;
  if (progress) progress("evaluating on the held-out data");
  const HoldOut holdout(search.study(), loaded.holdout);
  const std::optional<double> noisy_hum = take_hum_for_noise(search, holdout);
  Json refuted_names = leave_refuted_impacts(search, holdout);
  for (const Json& name : leave_refuted(search, holdout)) refuted_names.push_back(name);
  look_beyond_refuted(search, holdout, refuted_names);
  for (const Json& name : take_own_numbers(search, holdout)) refuted_names.push_back(name);
  add_weak_effects(search, holdout);
  const std::vector<BandTest> bands = search.bands();
  const std::vector<Member> names = search.names();
  auto laws = add_discovered(search, holdout);
  const Json refuted_laws = leave_refuted_laws(search, holdout, laws);
  for (const Json& law : refuted_laws) refuted_names.push_back(law);
  if (laws.empty() && !refuted_laws.empty()) take_back_names(search, holdout, names);
  // Names that were found beside laws, or in the place of one.
  for (const Json& name : leave_refuted(search, holdout)) refuted_names.push_back(name);
  auto alternatives = adopt_likelier(search, holdout);
  // What took a name's place is judged as that was; each round leaves one name fewer.
  for (Json more = leave_refuted(search, holdout); !more.empty();
       more = leave_refuted(search, holdout)) {
    for (const Json& name : more) refuted_names.push_back(name);
    alternatives = adopt_likelier(search, holdout);
  }
  // Beside fewer names a variation may be told no more.
  if (leave_refuted_variations(search, holdout) || search.leave_untold_bends())
    alternatives = adopt_likelier(search, holdout);
  const Case& study = search.study();
  const JointFit& fit = search.fit();
  JointFit given = joint_fit(search.setting(), {});
  if (study.axis && study.axis->base_is_known) given.base.resize(0);  // without its errors

  Diagnosis diagnosis;
  Json& report = diagnosis.report;
  const std::vector<std::string> zeroed = zeroed_in(study, loaded.holdout);
  report = {{"targets", study.targets},
            {"units", study.units},
            {"fit_recordings", names_of(study)},
            {"holdout_recordings", names_of(loaded.holdout)}};
  if (!zeroed.empty()) report["zeroed"] = zeroed;
  report["notes"] = notes_of({&study, &loaded.holdout});
  if (const double share = share_within(study, rests(study)); share > 0.0) {
    report["notes"].push_back(study.axis->axis().name + " stands still for " +
                              brief(100.0 * share) +
                              " % of the time, where friction may be any force up to the one that "
                              "breaks loose: these rows decide nothing");
  }
  if (noisy_hum) {
    report["notes"].push_back("a line at " + brief(*noisy_hum) +
                              " Hz, the phase of which does not last: it counts as noise");
  }
  if (study.axis && study.is_static()) {
    report["notes"].push_back(study.axis->axis().name +
                              ": positions at rest do not tell the noise of their readings: all "
                              "that is left may be noise, or a law of what is not logged");
  }
  if (study.axis && study.axis->sense < 0.0) {
    report["notes"].push_back(reaction_words(study.axis->axis()));
  }
  if (const auto note = note_of_zeros(search)) report["notes"].push_back(*note);
  const std::vector<std::string> without = study.without.names();
  if (!without.empty()) report["without"] = without;
  const std::vector<Floor> heldout_floors = holdout.floors(search);
  // What a loose load's impacts are is not predicted.
  std::optional<HoldOut::Excess> refuted;
  if (!search.loose_load()) refuted = holdout.excess(search, heldout_floors);
  // A machine's noise is of no shape that is known: a band of it may be louder than the rest.
  const double most = search.posterior().nothing > 0.5 ? prior::kMostOverNoise : 1.0;
  if (study.axis && fit.members.empty() && holdout.is_noise(search, heldout_floors, most))
    search.take_rest_for_noise();
  report["findings"] = findings_json(search, holdout, alternatives, heldout_floors,
                                     search.remains() || refuted.has_value());
  report["refuted"] = refuted_names;
  report["search"] = {{"passes", search.passes()}, {"complete", search.is_complete()}};
  report["rivals"] = rivals_json(search, alternatives);
  report["clock_end_s"] =
      study.shared_clock && study.has_clock() ? Json(study.end_of_clock) : Json();
  const auto doubtful =
      std::count_if(report["findings"].begin(), report["findings"].end(), is_doubtful);
  report["verdict"] = verdict_of(static_cast<std::size_t>(doubtful) < report["findings"].size(),
                                 search.remains() || refuted.has_value() || doubtful > 0);
  const bool corrected = is_corrected(study);
  Case simulator = corrected ? as_given(study) : study;
  if (given.base.size() > 0) set_base(simulator, given.base);
  const Signals before = difference(study, predict(simulator, {}));
  std::optional<HoldOut> as_it_was;  // the simulator as given, where a part of it was corrected
  if (corrected) as_it_was.emplace(simulator, as_given(loaded.holdout));
  const HoldOut& first = as_it_was ? *as_it_was : holdout;
  report["where"] = locate(study, before, search.floors());
  report["where"]["budget"] =
      budget(search.setting(), before, own_parameters(study), report["where"]["segments"]);
  // A form is not established beside which held-out data show more than noise.
  for (discovery::Discovered& law : laws) law.established = law.established && !refuted;
  const Json formulas = law_findings(search, laws, holdout);
  report["left_out"] = outlying_json(search);
  report["unnamed"] = unnamed_part(search, bands, formulas, refuted, !holdout.empty());
  for (const Json& law : formulas) report["findings"].push_back(law);
  Json sources = Json::array();
  for (const Floor& floor : search.floors()) sources.push_back(floor.source);
  report["posterior"] = evidence::posterior_json(search.posterior());
  report["structures"] = evidence::structures_json(search.posterior());
  report["fit"] = errors_json(search, first, holdout, given);
  report["fit"]["noise_floor"] = deviations(search.floors());
  report["fit"]["holdout_noise_floor"] = holdout.empty() ? Json() : deviations(heldout_floors);
  report["fit"]["noise_floor_source"] = sources;
  report["fit"]["oracle"] = nullptr;
  const std::optional<DerivativeSpec> online = best_online(search);
  report["fit"]["online"] = nullptr;
  if (online && !holdout.empty()) {
    const HoldOut streamed(by_derivative(study, *online), loaded.holdout);
    report["fit"]["online"] = {{"derivative", to_json(*online)},
                               {"holdout_rmse", streamed.rmse(fit.members, fit.base)}};
  }
  if (study.lowpass_hz > 0.0) {
    report["fit"]["unfiltered"] =
        errors_json(search, first.unfiltered(), holdout.unfiltered(), given);
  }
  add_limits(search, holdout, report);
  report["next_motion"] = nullptr;  // the design's, above this room
  report["smoother_hz"] = study.is_static() ? Json() : Json(study.derivative.cutoff_hz);
  diagnosis.corrected = study.simulator;
  if (!study.is_static()) diagnosis.corrected.derivative = study.derivative;
  diagnosis.corrected.online_derivative = online;
  for (EffectSpec effect : specs_of(fit.members)) {
    if (refuted && effect.law.is_object()) effect.law["established"] = false;
    diagnosis.corrected.effects.push_back(std::move(effect));
  }
  diagnosis.model = to_json(diagnosis.corrected);
  diagnosis.holdout = holdout.records(given, fit);
  if (corrected) {
    const Signals then = first.prediction(given.members, given.base);
    for (std::size_t k = 0; k < then.size(); ++k) diagnosis.holdout[k].before = then[k];
  }
  diagnosis.portraits = portraits(search);
  CaseDiagnosis result{std::move(diagnosis), base_parameters(study, fit.base), {}};
  if (corrected && !first.empty()) result.uncorrected = first.rmse(fit.members, fit.base);
  return result;
}

Diagnosis diagnose(const DiagnosisRequest& request,
                   const std::function<void(const std::string&)>& progress) {
  fix_blocking();
  if (request.system) return diagnose_axes(request, progress);
  return diagnose_case(load_wrist(request), progress).diagnosis;
}

}  // namespace dcnn
