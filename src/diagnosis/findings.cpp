// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/findings.h"

#include <algorithm>

#include "core/elementary.h"
#include "diagnosis/candidates.h"
#include "diagnosis/confidence.h"
#include "diagnosis/evidence/priors.h"
#include "diagnosis/plain_findings.h"
#include "diagnosis/words.h"

namespace dcnn {
namespace {

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

  Json findings(const std::vector<std::vector<Alternative>>& alternatives,
                const std::vector<Floor>& noise, bool open) const {
    const JointFit& fit = search_.fit();
    const auto numbers = estimates(search_.setting(), fit);
    const bool held = !holdout_.empty();
    const auto likely = confidences(search_, holdout_);
    const auto against = contradicted(search_, holdout_);
    const auto shares = open && held
                            ? shares_of_missing(holdout_.prediction(fit.members, fit.base), noise)
                            : std::vector<double>();
    const double elsewhere = open                   ? prior::kElsewhereBesideUnknown
                             : search_.study().axis ? prior::kElsewhereOnMachine
                                                    : 0.0;
    const double after = held ? holdout_.mean_rmse(fit.members, fit.base) : 0.0;
    Json list = Json::array();
    for (std::size_t m = 0; m < fit.members.size(); ++m) {
      const Member& member = fit.members[m];
      if (!member.law.is_null()) continue;  // law_findings()
      Json entry = base_entry(member, numbers[m]);
      JointFit rest = member.fixed ? fit : search_.without(m);
      std::vector<Member>& others = rest.members;
      if (member.fixed) others.erase(others.begin() + static_cast<std::ptrdiff_t>(m));
      entry["confidence"] = nullptr;
      entry["p_value"] = nullptr;
      entry["alternatives"] = Json::array();
      for (const Alternative& other : alternatives[m]) {
        if (other.name != member.name()) entry["alternatives"].push_back(other.name);
      }
      if (!member.fixed) {
        entry["p_value"] = flip_p_value(search_.setting(), fit, m);
        double alone = std::min(*likely[m], against[m].probability);
        if (!shares.empty()) {
          alone *= shares[m];
          entry["share_of_missing"] = shares[m];
        }
        share(evidence::with_elsewhere(alone, elsewhere), alternatives[m], entry);
      }
      for (const std::size_t j : against[m].channels) {
        entry["against"].push_back(search_.study().targets[j]);
      }
      entry["holdout_gain"] = nullptr;
      if (held) {
        entry["holdout_gain"] =
            1.0 - after / std::max(1e-300, holdout_.mean_rmse(others, rest.base));
      }
      list.push_back(entry);
    }
    for (const auto* apart : {&search_.rounding(), &search_.loose_load()}) {
      if (*apart) list.push_back(found_apart(**apart));
    }
    return list;
  }

  /// What would have been named from which size on, and what these recordings cannot show.
  void add_limits(Json& report) const {
    const Case& study = search_.study();
    const Scan scan(search_.setting(), search_.fit());
    // One after the other: a new key moves the values of the others.
    report["not_detected"] = Json::array();
    report["not_testable"] = Json::array();
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
    const Json numbered = parameters_json(numbers);
    Json entry{{"effect", member.name()}, {"kind", member.kind->kind},
               {"axis", nullptr},         {"interval_s", nullptr},
               {"parameters", numbered},  {"words", in_words(member, numbered)}};
    if (!member.axis.empty()) entry["axis"] = member.axis;
    if (member.driver) {
      const auto& [signal, low, high] = *member.driver;
      Json& parameters = entry["parameters"];
      parameters["driven_by"] = {{"value", signal}, {"ci95", {nullptr, nullptr}}, {"unit", ""}};
      parameters["slope"]["unit"] =
          per_signal(unit_of_parameter(member.kind->strength), parameters["driven_by"]);
      entry["driven_over"] = {low, high};
    }
    if (is_constant(entry)) entry["words"] = constant_words(entry);
    if (member.interval_s) {
      entry["interval_s"] = {member.interval_s->first, member.interval_s->second};
    }
    if (!member.recording.empty()) entry["recording"] = member.recording;
    return entry;
  }

  /// Frictions along one line are one curve, whatever its forms are called.
  static bool are_one_curve(const Member& a, const Member& b) {
    return !a.fixed && !b.fixed && a.kind->axis == AxisRule::kLine && same_family(a, b);
  }

  /// Of what is missing on held-out data beside the other members, the share that each member
  /// explains: HoldOut::share_explained(). The forms of one curve have the share of the curve.
  std::vector<double> shares_of_missing(const Signals& with,
                                        const std::vector<Floor>& noise) const {
    const Whitener& whitener = search_.setting().whitener;
    Eigen::VectorXd variance = whitener.block_deviation().cwiseAbs2();
    for (std::size_t j = 0; j < noise.size(); ++j) {  // of the held-out recordings
      const double ratio = noise[j].whole_deviation() / search_.floors()[j].whole_deviation();
      variance(static_cast<Index>(j)) *= ratio * ratio;
    }
    const auto share_without = [&](const JointFit& rest) {
      return holdout_.share_explained(with, holdout_.prediction(rest.members, rest.base), variance,
                                      whitener.block());
    };
    const std::vector<Member>& members = search_.fit().members;
    std::vector<double> shares;
    for (std::size_t m = 0; m < members.size(); ++m) {
      const auto is_of_curve = [&](const Member& other) {
        return are_one_curve(other, members[m]);
      };
      const auto first = static_cast<std::size_t>(
          std::find_if(members.begin(), members.end(), is_of_curve) - members.begin());
      if (first < m) {
        shares.push_back(shares[first]);
      } else if (members[m].fixed || !members[m].law.is_null()) {
        shares.push_back(1.0);
      } else if (std::count_if(members.begin(), members.end(), is_of_curve) > 1) {
        std::vector<Member> rest = members;
        std::erase_if(rest, is_of_curve);
        shares.push_back(share_without(joint_fit(search_.setting(), rest)));
      } else {
        shares.push_back(share_without(search_.without(m)));
      }
    }
    return shares;
  }

  /// Divides a probability among a name, in any of its forms, and the effects that may stand in its
  /// place.
  void share(double probability, const std::vector<Alternative>& others, Json& entry) const {
    const auto masses = masses_of(search_, others);
    double own = masses[0];
    Json shared = Json::object();
    for (std::size_t k = 0; k < others.size(); ++k) {
      if (entry["effect"] == others[k].name) {
        own += masses[k + 1];
      } else {
        shared[others[k].name] = probability * masses[k + 1];
      }
    }
    entry["confidence"] = probability * own;
    if (!shared.empty()) entry["shared_with"] = shared;
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
    const auto &rounding = search_.rounding(), &loose_load = search_.loose_load();
    return std::any_of(members.begin(), members.end(), same) || (rounding && same(*rounding)) ||
           (loose_load && same(*loose_load));
  }

  /// The largest of the least detectable sizes over axes; 0 for what a test of its own looks for.
  std::optional<double> worst_axis(const Scan& scan, const EffectKind& kind) const {
    const EffectFit& form = first_form(search_.study(), kind);
    const bool seeded = std::all_of(form.shapes.begin(), form.shapes.end(),
                                    [](const ShapeParameter& s) { return !s.seeds.empty(); });
    if (!seeded || kind.interval == IntervalRule::kRequired ||
        kind.interval == IntervalRule::kOnset) {
      return 0.0;
    }
    Eigen::VectorXd shapes(static_cast<Index>(form.shapes.size()));
    for (std::size_t k = 0; k < form.shapes.size(); ++k) {
      shapes(static_cast<Index>(k)) = unit_of(search_.study(), form.shapes[k]) *
                                      form.shapes[k].seeds[form.shapes[k].seeds.size() / 2];
    }
    std::optional<double> most;
    for (const auto& axis : axes_of(search_.study(), kind)) {
      const auto least = scan.least_detectable(
          make_member(search_.study(), kind, form, axis, seed_scale(axis) * shapes));
      if (least && (!most || *least > *most)) most = least;
    }
    return most;
  }

  const Search& search_;
  const HoldOut& holdout_;
};

}  // namespace

Json findings_json(const Search& search, const HoldOut& holdout,
                   const std::vector<std::vector<Alternative>>& alternatives,
                   const std::vector<Floor>& noise, bool open) {
  return Writer(search, holdout).findings(alternatives, noise, open);
}

Json rivals_json(const Search& search, const std::vector<std::vector<Alternative>>& alternatives) {
  const auto numbers = [](const std::vector<Member>& members) {
    int sum = 0;
    for (const Member& m : members) sum += m.parameters();
    return sum;
  };
  const std::vector<Member>& chosen = search.fit().members;
  Json list = Json::array();
  const auto add = [&](const std::vector<Member>& members, double log_odds, double chi2_above) {
    list.push_back({{"effects", to_json(specs_of(members))},
                    {"log_odds", log_odds},
                    {"chi2_above", chi2_above},
                    {"more_numbers", numbers(members) - numbers(chosen)}});
  };
  for (const auto& of_member : alternatives) {
    for (const Alternative& other : of_member) add(other.members, other.log_odds, other.chi2_above);
  }
  const evidence::Posterior& p = search.posterior();
  const double least = elementary::exp(-0.5 * kAsLikely);
  if (p.structures.empty() || p.without_unknown[p.most_probable()] < least) return list;
  const std::size_t best = p.most_probable();
  for (std::size_t k = 0; k < p.structures.size(); ++k) {
    const evidence::Structure& s = p.structures[k];
    const double odds = p.without_unknown[k] / p.without_unknown[best];
    if (k == best || s.members.size() == chosen.size() || !(odds > least)) continue;
    add(s.members, elementary::log(odds), s.chi2 - p.structures[best].chi2);
  }
  return list;
}

void add_limits(const Search& search, const HoldOut& holdout, Json& report) {
  Writer(search, holdout).add_limits(report);
}

}  // namespace dcnn
