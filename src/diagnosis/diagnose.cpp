#include "dcnn/diagnosis/diagnose.h"

#include <algorithm>
#include <cmath>

#include "core/elementary.h"
#include "dcnn/core/blocking.h"
#include "diagnosis/axes.h"
#include "diagnosis/budget.h"
#include "diagnosis/candidates.h"
#include "diagnosis/evidence/posterior_json.h"
#include "diagnosis/formula.h"
#include "diagnosis/holdout.h"
#include "diagnosis/locate.h"
#include "diagnosis/portrait.h"
#include "diagnosis/words.h"

namespace dcnn {
namespace {

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double v : values) sum += v;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

/// Members that are the simulator's own numbers.
std::vector<Member> own_parameters(const Case& study) {
  std::vector<Member> members;
  for (const char* name : {"mass", "com", "gravity_tilt", "bias", "gain"}) {
    const EffectKind& kind = *find_effect(name);
    // Of another machine's simulator its scale is all that is known; a fitted base is fitted.
    const bool scale = std::string(name) == "gain";
    if (scale != (study.axis != nullptr) || !is_testable(study, kind)) continue;
    Member member = make_member(kind, kind.fits[0], "", study.has_torque(), Eigen::VectorXd(0));
    member.amplitudes.setZero();
    members.push_back(member);
  }
  return members;
}

Json parameters_json(const std::vector<Estimate>& numbers) {
  Json json = Json::object();
  for (const Estimate& e : numbers) {
    json[e.name] = {{"value", e.value}, {"ci95", {e.low, e.high}}, {"unit", e.unit}};
  }
  return json;
}

/// Writes down a finished search.
class Writer {
 public:
  Writer(const Search& search, const HoldOut& holdout) : search_(search), holdout_(holdout) {}

  Json findings(const std::vector<std::vector<std::string>>& alternatives) const {
    const JointFit& fit = search_.fit();
    const auto numbers = estimates(search_.setting(), fit);
    const double after = mean(holdout_.rmse(fit.members, fit.base));
    Json list = Json::array();
    for (std::size_t m = 0; m < fit.members.size(); ++m) {
      const Member& member = fit.members[m];
      Json entry = base_entry(member, numbers[m]);
      JointFit rest = member.fixed ? fit : search_.without(m);
      std::vector<Member>& others = rest.members;
      if (member.fixed) others.erase(others.begin() + static_cast<std::ptrdiff_t>(m));
      entry["confidence"] = entry["p_value"] = nullptr;
      if (!member.fixed) {
        entry["confidence"] = search_.posterior().inclusion(member);
        entry["p_value"] = flip_p_value(search_.setting(), fit, m);
      }
      entry["alternatives"] = alternatives[m];
      entry["holdout_gain"] =
          1.0 - after / std::max(1e-300, mean(holdout_.rmse(others, rest.base)));
      list.push_back(entry);
    }
    for (const auto* apart : {&search_.rounding(), &search_.knocking()}) {
      if (*apart) list.push_back(found_apart(**apart));
    }
    return list;
  }

  /// What would have been named from which size on, and what these recordings cannot show.
  void add_limits(Json& report) const {
    const Case& study = search_.study();
    const Scan scan(search_.setting(), search_.fit());
    report["not_detected"] = report["not_testable"] = Json::array();
    for (const EffectKind* kind : effect_kinds()) {
      if (kind->fits.empty() || is_found(*kind) || !is_listed(study, *kind)) continue;
      std::string why;
      if (!is_testable(study, *kind, &why)) {
        report["not_testable"].push_back({{"effect", kind->name}, {"why", why}});
        continue;
      }
      const auto least = worst_axis(scan, *kind);
      if (!least.has_value()) {
        report["not_testable"].push_back(
            {{"effect", kind->name}, {"why", "on this motion it looks like what was fitted"}});
      } else if (*least > 0.0) {
        report["not_detected"].push_back(
            {{"effect", kind->name}, {"minimum_detectable_rms", *least}});
      }
    }
  }

 private:
  Json base_entry(const Member& member, const std::vector<Estimate>& numbers) const {
    Json entry{{"effect", member.name()},
               {"kind", member.kind->kind},
               {"axis", nullptr},
               {"interval_s", nullptr},
               {"parameters", parameters_json(numbers)},
               {"words", in_words(member, numbers)}};
    if (!member.axis.empty()) entry["axis"] = member.axis;
    if (member.interval_s) {
      entry["interval_s"] = {member.interval_s->first, member.interval_s->second};
    }
    if (!member.recording.empty()) entry["recording"] = member.recording;
    return entry;
  }

  Json found_apart(const Member& member) const {
    JointFit alone;
    alone.members = {member};
    alone.residual = search_.fit().residual;
    alone.tangent.resize(alone.residual.size(), 0);
    Json entry = base_entry(member, estimates(search_.setting(), alone)[0]);
    entry.update({{"confidence", nullptr},
                  {"p_value", nullptr},
                  {"alternatives", Json::array()},
                  {"holdout_gain", nullptr}});
    return entry;
  }

  bool is_found(const EffectKind& kind) const {
    const auto same = [&](const Member& m) { return m.kind == &kind; };
    const auto& members = search_.fit().members;
    const auto &rounding = search_.rounding(), &knocking = search_.knocking();
    return std::any_of(members.begin(), members.end(), same) || (rounding && same(*rounding)) ||
           (knocking && same(*knocking));
  }

  /// The largest of the least detectable sizes over axes; 0 for what a test of its own looks for.
  std::optional<double> worst_axis(const Scan& scan, const EffectKind& kind) const {
    const EffectFit& form = kind.fits[0];
    const bool seeded = std::all_of(form.shapes.begin(), form.shapes.end(),
                                    [](const ShapeParameter& s) { return !s.seeds.empty(); });
    if (!seeded || kind.interval == IntervalRule::kRequired ||
        kind.interval == IntervalRule::kOnset) {
      return 0.0;
    }
    Eigen::VectorXd shapes(static_cast<Index>(form.shapes.size()));
    for (std::size_t k = 0; k < form.shapes.size(); ++k) {
      shapes(static_cast<Index>(k)) = form.shapes[k].seeds[form.shapes[k].seeds.size() / 2];
    }
    std::optional<double> most;
    for (const auto& axis : axes_of(search_.study(), kind)) {
      const auto least = scan.least_detectable(
          make_member(kind, form, axis, search_.study().has_torque(), seed_scale(axis) * shapes));
      if (least && (!most || *least > *most)) most = least;
    }
    return most;
  }

  const Search& search_;
  const HoldOut& holdout_;
};

const char* verdict_of(bool named, bool remains) {
  if (named) return remains ? "partly-explained" : "explained";
  return remains ? "unexplained" : "consistent";
}

/// What no name explains: by channel, in the band where it is.
Json unnamed_part(const Search& search) {
  Json excess = Json::array();
  for (Index j = 0; j < search.study().channel_count(); ++j) {
    double square = 0.0, count = 0.0;
    for (const auto& r : search.left()) {
      square += r.col(j).squaredNorm();
      count += static_cast<double>(r.rows());
    }
    const double s = search.floors()[static_cast<std::size_t>(j)].deviation();
    excess.push_back(search.remains() ? std::sqrt(std::max(0.0, square / count - s * s)) : 0.0);
  }
  Json part{{"excess_rms", excess}, {"formula", nullptr}, {"words", nullptr}};
  if (!search.remains()) return part;
  const BandTest* most = &search.bands().front();
  for (const BandTest& band : search.bands()) {
    if (band.excess > most->excess) most = &band;
  }
  part["words"] = "something that no effect of the catalogue explains, mostly between " +
                  brief(most->from_hz) + " and " + brief(most->to_hz) + " Hz";
  if (const auto formula = formula_of(search.setting(), search.fit())) {
    part["formula"] = formula->text;
    part["words"] = part["words"].get<std::string>() + "; " + brief(100.0 * formula->share) +
                    " % of it is like " + formula->text;
  }
  return part;
}

Json next_motion(const Json& findings) {
  for (const Json& finding : findings) {
    if (finding["alternatives"].empty()) continue;
    const auto one = finding["effect"].get<std::string>();
    const auto other = finding["alternatives"][0].get<std::string>();
    return {{"separates", {one, other}}, {"words", separating_motion(one, other)}, {"seconds", 30}};
  }
  return nullptr;
}

std::vector<std::string> names_of(const Case& study) {
  std::vector<std::string> names;
  for (const Log& log : study.logs) names.push_back(log.recording.name);
  return names;
}

/// RMSE on what was held out, before, with own numbers refitted, and after.
Json errors_json(const Search& search, const HoldOut& holdout, const JointFit& given) {
  const Case& study = search.study();
  const JointFit& fit = search.fit();
  Json json{{"holdout_rmse_before", holdout.rmse({}, given.base)},
            {"holdout_rmse_parameters", nullptr},
            {"holdout_rmse_after", holdout.rmse(fit.members, fit.base)}};
  if (study.own_tool || study.axis) {
    const auto own =
        given.base.size() > 0 ? given : joint_fit(search.setting(), own_parameters(study));
    json["holdout_rmse_parameters"] = holdout.rmse(own.members, own.base);
  }
  return json;
}

}  // namespace

CaseDiagnosis diagnose_case(LoadedCase loaded,
                            const std::function<void(const std::string&)>& progress) {
  std::vector<Span> held_out;
  if (loaded.holdout.logs.empty()) held_out = held_out_blocks(loaded.fit, true);
  Search search(std::move(loaded.fit), held_out, progress);
  search.run();
  if (progress) progress("judging by what was held out");
  const HoldOut holdout(search.study(), loaded.holdout);
  const Case& study = search.study();
  const JointFit &fit = search.fit(), given = joint_fit(search.setting(), {});
  const Writer writer(search, holdout);

  Diagnosis diagnosis;
  Json& report = diagnosis.report;
  report = {{"targets", study.targets},
            {"units", study.units},
            {"fit_recordings", names_of(study)},
            {"holdout_recordings", names_of(loaded.holdout)}};
  const std::vector<std::string> without = study.without.names();
  if (!without.empty()) report["without"] = without;
  report["findings"] = writer.findings(search.alternatives());
  report["verdict"] = verdict_of(!report["findings"].empty(), search.remains());
  Case as_given = study;
  if (given.base.size() > 0) set_base(as_given, given.base);
  const Signals before = difference(study, predict(as_given, {}));
  report["where"] = locate(study, before, search.floors());
  report["where"]["budget"] =
      budget(search.setting(), before, own_parameters(study), report["where"]["segments"]);
  report["unnamed"] = unnamed_part(search);
  Json floors = Json::array(), sources = Json::array();
  for (const Floor& floor : search.floors()) {
    floors.push_back(floor.deviation());
    sources.push_back(floor.source);
  }
  report["posterior"] = evidence::posterior_json(search.posterior());
  report["structures"] = evidence::structures_json(search.posterior());
  report["fit"] = errors_json(search, holdout, given);
  report["fit"]["noise_floor"] = floors;
  report["fit"]["noise_floor_source"] = sources;
  report["fit"]["oracle"] = nullptr;
  if (study.lowpass_hz > 0.0) {
    report["fit"]["unfiltered"] = errors_json(search, holdout.unfiltered(), given);
  }
  writer.add_limits(report);
  report["next_motion"] = next_motion(report["findings"]);
  report["smoother_hz"] = study.is_static() ? Json() : Json(study.derivative.cutoff_hz);
  diagnosis.corrected = study.simulator;
  if (!study.is_static()) diagnosis.corrected.derivative = study.derivative;
  for (const auto& effect : specs_of(fit.members)) diagnosis.corrected.effects.push_back(effect);
  diagnosis.model = to_json(diagnosis.corrected);
  diagnosis.holdout = holdout.records(given, fit);
  diagnosis.portraits = portraits(search);
  return {std::move(diagnosis), fit.base};
}

Diagnosis diagnose(const DiagnosisRequest& request,
                   const std::function<void(const std::string&)>& progress) {
  fix_blocking();
  if (request.system) return diagnose_axes(request, progress);
  return diagnose_case(load_wrist(request), progress).diagnosis;
}

}  // namespace dcnn
