#include "diagnosis/discovered.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/confidence.h"
#include "diagnosis/law_search.h"
#include "discovery/priors.h"

namespace dcnn {
namespace {

using discovery::Discovered;
using Eigen::VectorXd;

constexpr double kLawInterval = 1.96;  // of a standard deviation: 95 %
constexpr int kFewestNumbers = 2;      // of a law: its size, and a scale or a power
constexpr double kStillGained = 0.5;   // of a law's gain, once all are fitted through the chain

bool can_hold_laws(const Case& study) {
  if (study.is_static() || !study.axis_moves) return false;
  return std::all_of(study.logs.begin(), study.logs.end(), [](const Log& log) {
    return log.motion.v_B.rows() == log.motion.samples() &&
           log.motion.a_B.rows() == log.motion.samples();
  });
}

Member member_of(const law::Law& law, const Json& told) {
  static const EffectFit form{.parameters = [](const VectorXd&, const VectorXd&) {
    return Json::object();  // its numbers stand in law_parameters
  }};
  Member member;
  member.kind = find_effect("discovered");
  member.form = &form;
  member.fixed = true;
  member.law = told;
  member.law_parameters = law::parameters_json(law);
  return member;
}

Json law_json(const Discovered& found, const law::Terms& terms = law::tool_terms()) {
  Json json = law::to_json(found.law, terms);
  json["established"] = found.established;
  json["rivals"] = found.rivals;
  return json;
}

Json law_numbers(const Discovered& found, const law::Terms& terms) {
  const auto numbers = law::numbers_of(found.law.structure, terms);
  Json json = Json::object();
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto at = static_cast<Index>(k);
    const double value = found.law.numbers(at), half = kLawInterval * found.deviation(at);
    json[numbers[k].name] = {
        {"value", value}, {"ci95", {value - half, value + half}}, {"unit", numbers[k].unit}};
  }
  return json;
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

int fitted_numbers(const Discovered& law) { return (law.deviation.array() > 0.0).count(); }

/// The laws of a residual. Where a number costs more, for laws err by more than the noise (a
/// machine), so does all that a law must gain, and a form that is not established may be that
/// error.
std::vector<Discovered> worthy_laws(const Setting& setting, const JointFit& fit) {
  auto laws = laws_in(setting, fit);
  const double dearer = setting.price / kNumberPrice;
  std::erase_if(laws, [&](const Discovered& law) {
    const double paid = discovery::prior::kNumber * fitted_numbers(law);
    return law.gain < dearer * (discovery::prior::kAccepted + paid) ||
           (dearer > 1.0 && !law.established);
  });
  return laws;
}

/// Laws and the members that they are, where the chain bears out what each promised; else none.
struct Laws {
  std::vector<Discovered> found;
  std::vector<Member> members;
};
Laws borne_out(const Setting& setting, const JointFit& names) {
  Laws laws{worthy_laws(setting, names), {}};
  double promised = 0.0;
  std::vector<Member> all = names.members;
  for (const Discovered& found : laws.found) {
    laws.members.push_back(member_of(found.law, law_json(found)));
    all.push_back(laws.members.back());
    promised += found.gain;
  }
  if (names.chi2 - joint_fit(setting, all).chi2 < kStillGained * promised) return {};
  return laws;
}

/// Looks for names beside laws; those that are found stand where both, fitted again, leave nothing.
void name_beside(Search& search, Laws& laws) {
  const std::vector<Member> before = search.fit().members;
  if (!search.name_beside_laws()) return;
  Laws again = borne_out(search.setting(), joint_fit(search.setting(), search.names()));
  if (!again.found.empty()) search.put_beside(again.members);
  if (!search.confirms_names()) {
    search.hold(before);
  } else if (!again.found.empty()) {
    laws = std::move(again);
  }
}

/// Numbers that were fitted, of laws and of names.
int numbers_of(const Laws& laws, const std::vector<Member>& members) {
  int sum = 0;
  for (const Discovered& law : laws.found) sum += fitted_numbers(law);
  for (const Member& member : members) {
    if (member.law.is_null()) sum += member.parameters();
  }
  return sum;
}

/// Leaves out names without which laws, looked for again, explain as much for their numbers: what
/// had no name may have been taken for one in part.
void leave_needless_names(Search& search, Laws& laws) {
  for (std::size_t m = search.names().size(); m-- > 0;) {
    std::vector<Member> rest = search.names();
    if (rest[m].fixed) continue;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(m));
    const Setting& setting = search.setting();  // another one after each change
    const Laws again = borne_out(setting, joint_fit(setting, rest));
    if (again.found.empty() || again.found.size() > laws.found.size()) continue;
    rest.insert(rest.end(), again.members.begin(), again.members.end());
    const std::vector<Member>& all = search.fit().members;
    const double lost = joint_fit(setting, rest).chi2 - search.fit().chi2;
    if (lost > setting.price * (numbers_of(laws, all) - numbers_of(again, rest))) continue;
    search.hold(rest);
    laws = again;
  }
}

/// A law may be an effect that has a name, which what is unknown hid: whether a name in its place
/// explains as much, but for what any law must gain to be accepted in the place of names. It then
/// stands, and laws are looked for beside it.
bool name_in_place_of_one(Search& search, Laws& laws) {
  const std::vector<Member> before = search.fit().members;
  for (std::size_t k = 0; k < laws.found.size(); ++k) {
    Laws others = laws;
    others.found.erase(others.found.begin() + static_cast<std::ptrdiff_t>(k));
    others.members.erase(others.members.begin() + static_cast<std::ptrdiff_t>(k));
    search.put_beside(others.members);
    const auto trials = search.additions(/*events=*/false);
    if (!trials.empty()) {
      std::vector<Member> named = search.fit().members;
      named.push_back(trials.front().member);
      search.settle(named);
      const double lost = search.fit().chi2 - joint_fit(search.setting(), before).chi2,
                   saved = search.setting().price *
                           (numbers_of(laws, before) - numbers_of(others, named));
      if (lost < saved + discovery::prior::kAccepted) {
        const Setting& setting = search.setting();
        Laws again = borne_out(setting, joint_fit(setting, search.names()));
        if (!again.found.empty()) {
          search.put_beside(again.members);
          others = std::move(again);
        }
        search.confirms_names();
        laws = std::move(others);
        return true;
      }
    }
    search.hold(before);
  }
  return false;
}

/// Several names along one axis may be one law that no catalogue has: where it explains more than
/// they, for its further numbers and for what any law must gain, and held-out data do not speak
/// against it, it stands in their place.
Laws in_place_of_names(Search& search, const HoldOut& holdout) {
  const Setting& setting = search.setting();
  const JointFit& fit = search.fit();
  std::map<std::string, std::vector<std::size_t>> along;  // names by axis
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    const Member& member = fit.members[m];
    if (!member.fixed && !member.interval_s && member.kind->stage == Stage::kForce) {
      along[member.axis].push_back(m);
    }
  }
  for (const auto& [axis, names] : along) {
    std::vector<Member> rest = fit.members;
    int numbers = 0;
    for (auto m = names.rbegin(); m != names.rend(); ++m) {
      numbers += rest[*m].parameters();
      rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(*m));
    }
    if (numbers <= kFewestNumbers) continue;
    Laws laws{worthy_laws(setting, joint_fit(setting, rest)), {}};
    if (laws.found.size() != 1 || !laws.found.front().established) continue;
    laws.members.push_back(member_of(laws.found.front().law, law_json(laws.found.front())));
    std::vector<Member> other = rest;
    other.push_back(laws.members.front());
    const int more = std::max(0, fitted_numbers(laws.found.front()) - numbers);
    const JointFit with = joint_fit(setting, other);
    if (fit.chi2 - with.chi2 - setting.price * more < discovery::prior::kAccepted) continue;
    const double support =
        holdout.log_support(holdout.prediction(with.members, with.base),
                            holdout.prediction(fit.members, fit.base), search.floors());
    if (support < 0.0) continue;
    search.leave_out(names);
    return laws;
  }
  return {};
}

}  // namespace

std::vector<Discovered> add_discovered(Search& search, const HoldOut& holdout) {
  if (!can_hold_laws(search.study())) return {};
  Laws laws = in_place_of_names(search, holdout);
  if (laws.found.empty() && search.remains()) laws = borne_out(search.setting(), search.fit());
  if (laws.found.empty()) return {};
  search.put_beside(laws.members);
  leave_needless_names(search, laws);
  name_beside(search, laws);
  constexpr int kMostRounds = 5;  // a limit of computation: each round searches all places again
  for (int round = 0; round < kMostRounds && name_in_place_of_one(search, laws); ++round) {
  }
  return laws.found;
}

Json leave_refuted_laws(Search& search, const HoldOut& holdout, double unnamed,
                        std::vector<Discovered>& laws) {
  Json refuted = Json::array();
  while (!laws.empty()) {
    const std::vector<Member> members = search.fit().members;
    const Signals with = holdout.prediction(members, search.fit().base);
    std::vector<std::size_t> places;  // of the laws among the members
    std::vector<std::optional<double>> likely;
    for (std::size_t m = 0; m < members.size(); ++m) {
      if (members[m].law.is_null()) continue;
      places.push_back(m);
      likely.emplace_back(supported(unnamed, search, holdout, with, m));
    }
    const auto worst = refuted_of(likely);
    if (!worst) break;
    const std::size_t place = places[*worst];
    refuted.push_back({{"effect", "discovered"},
                       {"axis", law_finding(laws[*worst], nullptr)["axis"]},
                       {"confidence", *likely[*worst]}});
    laws.erase(laws.begin() + static_cast<std::ptrdiff_t>(*worst));
    search.hold(search.members_without(place));
  }
  return refuted;
}

Json law_findings(const Search& search, const std::vector<Discovered>& laws,
                  const HoldOut& holdout) {
  const JointFit& fit = search.fit();
  const double error = holdout.empty() ? 0.0 : holdout.mean_rmse(fit.members, fit.base);
  Json list = Json::array();
  std::size_t next = 0;
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    if (fit.members[m].law.is_null()) continue;
    Json entry = law_finding(laws[next++], search.study().axis.get());
    if (!holdout.empty()) {
      std::vector<Member> others = fit.members;
      others.erase(others.begin() + static_cast<std::ptrdiff_t>(m));
      entry["holdout_gain"] = 1.0 - error / std::max(1e-300, holdout.mean_rmse(others, fit.base));
    }
    list.push_back(entry);
  }
  return list;
}

}  // namespace dcnn
