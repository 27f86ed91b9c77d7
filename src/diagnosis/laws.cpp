// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/laws.h"

#include <algorithm>

#include "diagnosis/evidence/priors.h"
#include "diagnosis/law_search.h"
#include "discovery/priors.h"

namespace dcnn {

using discovery::Discovered;

namespace {

Member member_of(const Case& study, const law::Law& law, const Json& told) {
  static const EffectFit form{.parameters = [](const Eigen::VectorXd&, const Eigen::VectorXd&) {
    return Json::object();  // its numbers stand in law_parameters
  }};
  Member member;
  member.kind = find_effect("discovered");
  member.form = &form;
  member.fixed = true;
  member.amplitudes = Eigen::VectorXd::Ones(1);
  member.law = told;
  member.law_parameters = law::parameters_json(law);
  if (study.has_torque()) add_lever(member);
  return member;
}

}  // namespace

Json law_json(const Discovered& found, const law::Terms& terms) {
  Json json = law::to_json(found.law, terms);
  json["established"] = found.established;
  json["rivals"] = found.rivals;
  return json;
}

int fitted_numbers(const Discovered& law) { return (law.deviation.array() > 0.0).count(); }

double least_gain_of_law(const Setting& setting) {
  return discovery::prior::kAccepted * setting.price / kNumberPrice;
}

namespace {

Laws worthy(const Setting& setting, std::vector<Discovered> list) {
  Laws laws{std::move(list), {}};
  const double price_ratio = setting.price / kNumberPrice;
  std::erase_if(laws.found, [&](const Discovered& law) {
    const double paid = price_ratio * discovery::prior::kNumber * fitted_numbers(law);
    return law.gain < least_gain_of_law(setting) + paid || (price_ratio > 1.0 && !law.established);
  });
  for (const Discovered& found : laws.found) {
    laws.members.push_back(member_of(setting.study, found.law, law_json(found)));
  }
  return laws;
}

Laws borne(const Setting& setting, const JointFit& names, Laws laws) {
  double promised = 0.0;
  for (const Discovered& found : laws.found) promised += found.gain;
  std::vector<Member> all = names.members;
  all.insert(all.end(), laws.members.begin(), laws.members.end());
  if (names.chi2 - joint_fit(setting, all).chi2 < prior::kRemains * promised) return {};
  return laws;
}

}  // namespace

Laws worthy_laws(const Setting& setting, const JointFit& fit) {
  return worthy(setting, laws_in(setting, fit));
}

Laws borne_out(const Setting& setting, const JointFit& names) {
  return borne(setting, names, worthy_laws(setting, names));
}

Laws borne_out_again(const Setting& setting, const JointFit& names, const Laws& laws) {
  return borne(setting, names, worthy(setting, laws_fitted_to(setting, names, laws.found)));
}

bool are_established(const Laws& laws) {
  return std::all_of(laws.found.begin(), laws.found.end(),
                     [](const Discovered& law) { return law.established; });
}

int numbers_of(const Laws& laws, const std::vector<Member>& members) {
  int sum = 0;
  for (const Discovered& law : laws.found) sum += fitted_numbers(law);
  for (const Member& member : laws.members) sum += static_cast<int>(member.levers());
  for (const Member& member : members) {
    if (member.law.is_null()) sum += member.parameters();
  }
  return sum;
}

Laws without(Laws laws, std::size_t k) {
  laws.found.erase(laws.found.begin() + static_cast<std::ptrdiff_t>(k));
  laws.members.erase(laws.members.begin() + static_cast<std::ptrdiff_t>(k));
  return laws;
}

Laws those_in(const std::vector<Member>& members, Laws laws) {
  for (std::size_t k = laws.found.size(); k-- > 0;) {
    const Member& law = laws.members[k];
    const bool stands = std::any_of(members.begin(), members.end(), [&](const Member& member) {
      return member.law == law.law && member.law_parameters == law.law_parameters;
    });
    if (!stands) laws = without(std::move(laws), k);
  }
  return laws;
}

}  // namespace dcnn
