// SPDX-License-Identifier: Apache-2.0
// Laws of the fit as findings, and what held-out data say of them.
#include <algorithm>
#include <cmath>

#include "core/tails.h"
#include "dcnn/core/number.h"
#include "diagnosis/confidence.h"
#include "diagnosis/discovered.h"
#include "diagnosis/laws.h"

namespace dcnn {

using discovery::Discovered;

namespace {

Json law_numbers(const Discovered& found, const law::Terms& terms) {
  const auto numbers = law::numbers_of(found.law.structure, terms);
  Json json = Json::object();
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto at = static_cast<Index>(k);
    const double value = found.law.numbers(at), half = kNormal95 * found.deviation(at);
    json[numbers[k].name] = {
        {"value", value}, {"ci95", {value - half, value + half}}, {"unit", numbers[k].unit}};
  }
  return json;
}

/// The law that a member of the fit is: others may have gone from the fit since they were found.
std::vector<Discovered>::const_iterator law_of(const Member& member,
                                               const std::vector<Discovered>& laws) {
  const auto found = std::find_if(laws.begin(), laws.end(), [&](const Discovered& law) {
    return member.law_parameters == law::parameters_json(law.law) &&
           member.law["expression"] == law::to_json(law.law, law::tool_terms())["expression"];
  });
  require(found != laws.end(), Exit::kFailure, "a law of the fit is not among those found");
  return found;
}

/// As it is told of a tool, or of an axis: what adds to its reading.
Json law_finding(Discovered found, const AxisPlan* plan) {
  law::Terms terms = law::tool_terms();
  if (plan != nullptr) {
    const Axis& axis = plan->axis();
    terms = law::axis_terms(axis.name, axis.unit, axis.position_unit, plan->sense);
    found.law.numbers(0) *= -plan->sense;
  }
  const Json law = law_json(found, terms);
  const auto words = law["words"].get<std::string>();
  Json entry{
      {"effect", "discovered"},
      {"kind", "structural"},
      {"axis", nullptr},
      {"interval_s", nullptr},
      {"law", law},
      {"parameters", law_numbers(found, terms)},
      {"words",
       found.established ? words : "approximate formula, its form not established: " + words}};
  if (!plan && law::is_axis(found.law.structure.direction) && !found.law.structure.oblique) {
    entry["axis"] = law["axis"];
  }
  entry.update({{"confidence", nullptr},
                {"p_value", nullptr},
                {"alternatives", Json::array()},
                {"holdout_gain", nullptr}});
  return entry;
}

}  // namespace

Json leave_refuted_laws(Search& search, const HoldOut& holdout, std::vector<Discovered>& laws) {
  constexpr double kEven = 0.5;
  Json refuted = Json::array();
  while (!laws.empty()) {
    const std::vector<Member> members = search.fit().members;
    const Signals with = holdout.prediction(members, search.fit().base);
    const double error = holdout.empty() ? 0.0 : holdout.mean_rmse(members, search.fit().base);
    struct Refuted {
      std::size_t member;
      double likely;
    };
    std::optional<Refuted> worst;
    for (std::size_t m = 0; m < members.size(); ++m) {
      if (members[m].law.is_null()) continue;
      const JointFit& rest = search.without(m);
      const double likely = supported(kEven, search, holdout, with, m);
      const bool rises = !holdout.empty() && error > holdout.mean_rmse(rest.members, rest.base);
      if ((rises || likely < kEven) && (!worst || likely < worst->likely)) {
        worst = Refuted{m, likely};
      }
    }
    if (!worst) break;
    const auto law = law_of(members[worst->member], laws);
    refuted.push_back({{"effect", "discovered"},
                       {"axis", law_finding(*law, nullptr)["axis"]},
                       {"confidence", worst->likely}});
    laws.erase(law);
    search.hold(search.members_without(worst->member));
  }
  return refuted;
}

Json law_findings(const Search& search, const std::vector<Discovered>& laws,
                  const HoldOut& holdout) {
  const JointFit& fit = search.fit();
  const double error = holdout.empty() ? 0.0 : holdout.mean_rmse(fit.members, fit.base);
  std::vector<std::vector<Estimate>> levers(fit.members.size());
  if (!laws.empty() && search.study().has_torque()) levers = estimates(search.setting(), fit);
  Json list = Json::array();
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    if (fit.members[m].law.is_null()) continue;
    Discovered law = *law_of(fit.members[m], laws);
    law.law.numbers(0) *= fit.members[m].amplitudes(0);
    law.deviation(0) *= std::abs(fit.members[m].amplitudes(0));
    Json entry = law_finding(std::move(law), search.study().axis.get());
    for (const Estimate& lever : levers[m]) {
      entry["parameters"][lever.name] = {
          {"value", lever.value}, {"ci95", {lever.low, lever.high}}, {"unit", lever.unit}};
    }
    if (!holdout.empty()) {
      std::vector<Member> others = fit.members;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(m));
      entry["holdout_gain"] = 1.0 - error / std::max(1e-300, holdout.mean_rmse(others, fit.base));
    }
    list.push_back(entry);
  }
  return list;
}

Json unnamed_part(const Search& search, const std::vector<BandTest>& bands, const Json& laws,
                  const std::optional<HoldOut::Excess>& refuted, bool held_out) {
  const Case& study = search.study();
  const Signals left = difference(study, predict(study, search.names()));
  Json excess = Json::array();
  for (Index j = 0; j < study.channel_count(); ++j) {
    const double square = mean_square(study, left, j);
    const double s = search.floors()[static_cast<std::size_t>(j)].deviation();
    excess.push_back(search.remains() ? std::sqrt(std::max(0.0, square - s * s)) : 0.0);
  }
  Json part{{"excess_rms", excess}, {"formula", nullptr}, {"words", nullptr}};
  if (!search.remains() && refuted) {
    part["words"] = "a held-out error of " + study.targets[refuted->channel] + " of " +
                    brief(refuted->ratio) + " times " +
                    (refuted->of_fit ? "that of the fitted recordings" : "its noise");
  }
  const auto remains = [&](bool does) { return Json(std::vector<bool>(excess.size(), does)); };
  part["remains"] = remains(search.remains());
  if (!search.remains()) return part;
  const auto most =
      std::max_element(bands.begin(), bands.end(),
                       [](const BandTest& a, const BandTest& b) { return a.excess < b.excess; });
  std::string something = "something that no effect of the catalogue explains";
  if (!study.is_static()) {  // rows of poses have no frequency
    something += ", mostly between " + brief(most->from_hz) + " and " + brief(most->to_hz) + " Hz";
  }
  part["words"] = something;
  const bool holds = std::all_of(laws.begin(), laws.end(),
                                 [](const Json& law) { return law["law"]["established"] == true; });
  part["suffices"] = held_out && !refuted && !laws.empty() && holds;
  if (part["suffices"] == true) {
    part["remains"] = remains(false);
    part["words"] = "no effect of the catalogue has this form, and held-out data show nothing else";
  }
  std::string formula;
  for (const Json& finding : laws) {
    formula += (formula.empty() ? "" : " + ") + finding["law"]["expression"].get<std::string>();
  }
  if (!formula.empty()) part["formula"] = formula;
  return part;
}

}  // namespace dcnn
