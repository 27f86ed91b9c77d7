#include "diagnosis/discovered.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "dcnn/discovery/discover.h"
#include "discovery/priors.h"

namespace dcnn {
namespace {

using discovery::Discovered;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLawInterval = 1.96;  // of a standard deviation: 95 %
constexpr int kFewestNumbers = 2;      // of a law: its size, and a scale or a power
constexpr double kStillGained = 0.5;   // of a law's gain, once all are fitted through the chain

/// The force on the tool to which a law is added.
MatrixXd load_of(const Simulator& simulator, const std::vector<EffectSpec>& effects,
                 const Log& log) {
  ToolModel model = changed_tool(simulator.model, effects);
  model.bias.setZero();
  model.bias_torque.setZero();
  Wrench wrench = rigid_wrench(model, log.motion);
  if (log.base.force.rows() > 0) wrench.force += log.base.force;
  for (const EffectSpec& effect : effects) {
    if (find_effect(effect.effect)->stage == Stage::kForce) {
      apply_effect(effect, log.motion, model, wrench);
    }
  }
  return wrench.force;
}

/// Forces as the channels that a case measures.
Signals channels_of(const Case& study, const std::vector<MatrixXd>& forces) {
  Signals signals;
  for (const MatrixXd& force : forces) {
    signals.push_back(measured_part(study, {force, MatrixXd::Zero(force.rows(), 3)}));
  }
  return signals;
}

/// Channels as forces.
std::vector<MatrixXd> forces_of(const Case& study, const Signals& signals) {
  std::vector<MatrixXd> forces;
  for (const MatrixXd& signal : signals) {
    forces.emplace_back(MatrixXd::Zero(signal.rows(), 3));
    for (Index j = 0; j < signal.cols(); ++j) {
      const int channel = study.channels[static_cast<std::size_t>(j)];
      if (channel < 3) forces.back().col(channel) = signal.col(j);
    }
  }
  return forces;
}

/// What the effects behind the forces on the tool, up to the sensor's offsets, make of forces.
class Passage {
 public:
  Passage(const Case& study, const std::vector<EffectSpec>& effects)
      : study_(study), model_(changed_tool(study.simulator.model, effects)) {
    for (const EffectSpec& effect : effects) {
      const Stage stage = find_effect(effect.effect)->stage;
      if (stage > Stage::kForce && stage < Stage::kOffset) behind_.push_back(effect);
    }
    model_.bias.setZero();
    model_.bias_torque.setZero();
  }
  Signals operator()(const std::vector<MatrixXd>& forces) const {
    if (behind_.empty()) return channels_of(study_, forces);
    std::vector<MatrixXd> passed;
    for (std::size_t k = 0; k < forces.size(); ++k) {
      Wrench wrench{forces[k], MatrixXd::Zero(forces[k].rows(), 3)};
      pass_on(behind_, Stage::kResonance, study_.logs[k].motion, model_, wrench);
      passed.push_back(std::move(wrench.force));
    }
    return channels_of(study_, passed);
  }

 private:
  const Case& study_;
  ToolModel model_;
  std::vector<EffectSpec> behind_;
};

/// The residual of a fit as a problem at the rate of `study`, whose rows `whitener` gives; both
/// must outlive it.
discovery::Problem problem_of(const Setting& setting, const JointFit& fit, const Case& study,
                              const Whitener& whitener) {
  discovery::Problem problem;
  const auto effects = specs_of(fit.members);
  std::vector<Index> sizes;
  for (const Log& log : study.logs) {
    problem.records.push_back({&log.motion, load_of(setting.study.simulator, effects, log)});
    sizes.push_back(log.motion.samples());
  }
  problem.whiten = [passage = Passage(study, effects), &whitener,
                    &setting](const std::vector<MatrixXd>& forces) {
    return VectorXd(whitener(passage(forces)).cwiseProduct(setting.mask));
  };
  problem.transposed = [&study, &whitener, &setting, sizes](const VectorXd& rows) {
    return forces_of(study, whitener.transposed(rows.cwiseProduct(setting.mask), sizes));
  };
  for (const Whitener::Row& row : whitener.row_info()) {
    problem.rows.push_back({row.log, row.channel, row.t});
  }
  problem.known = orthonormal(fit.tangent);
  problem.residual = fit.residual - problem.known * (problem.known.transpose() * fit.residual);
  problem.residual = problem.residual.cwiseProduct(setting.mask);
  return problem;
}

bool can_hold_laws(const Case& study) {
  if (study.is_static() || study.axis) return false;
  return std::all_of(study.logs.begin(), study.logs.end(), [](const Log& log) {
    return log.motion.v_B.rows() == log.motion.samples() &&
           log.motion.a_B.rows() == log.motion.samples();
  });
}

/// Looked for in block means, then fitted again at the log's rate.
std::vector<Discovered> laws_in(const Setting& setting, const JointFit& fit) {
  const Index block = setting.whitener.block();
  const Case thin = thinned(setting.study, block);
  const Whitener coarse = setting.whitener.at_stride(block);
  const auto laws = discovery::discover(problem_of(setting, fit, thin, coarse));
  if (laws.empty()) return laws;
  return discovery::refitted(problem_of(setting, fit, setting.study, setting.whitener), laws);
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

Json law_json(const Discovered& found) {
  Json json = law::to_json(found.law);
  json["established"] = found.established;
  json["rivals"] = found.rivals;
  return json;
}

Json law_numbers(const Discovered& found) {
  const auto numbers = law::numbers_of(found.law.structure);
  Json json = Json::object();
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto at = static_cast<Index>(k);
    const double value = found.law.numbers(at), half = kLawInterval * found.deviation(at);
    json[numbers[k].name] = {
        {"value", value}, {"ci95", {value - half, value + half}}, {"unit", numbers[k].unit}};
  }
  return json;
}

Json law_finding(const Discovered& found, const Json& law) {
  const auto words = law["words"].get<std::string>();
  Json entry{
      {"effect", "discovered"},
      {"kind", "structural"},
      {"axis", nullptr},
      {"interval_s", nullptr},
      {"law", law},
      {"parameters", law_numbers(found)},
      {"words",
       found.established ? words : "approximate formula, its form not established: " + words}};
  if (law::is_axis(found.law.structure.direction)) entry["axis"] = law["axis"];
  entry.update({{"confidence", nullptr},
                {"p_value", nullptr},
                {"alternatives", Json::array()},
                {"holdout_gain", nullptr}});
  return entry;
}

/// Laws and the members that they are, where the chain bears out what each promised; else none.
struct Laws {
  std::vector<Discovered> found;
  std::vector<Member> members;
};
Laws borne_out(const Setting& setting, const JointFit& names) {
  Laws laws{laws_in(setting, names), {}};
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

}  // namespace

bool prefer_one_law(Search& search) {
  const Setting& setting = search.setting();
  if (!can_hold_laws(search.study())) return false;
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
    const auto laws = laws_in(setting, joint_fit(setting, rest));
    if (laws.size() != 1 || !laws.front().established) continue;
    std::vector<Member> other = rest;
    other.push_back(member_of(laws.front().law, law_json(laws.front())));
    const auto own = static_cast<int>((laws.front().deviation.array() > 0.0).count());
    const double better =
        fit.chi2 - joint_fit(setting, other).chi2 - setting.price * std::max(0, own - numbers);
    if (better < discovery::prior::kAccepted) continue;
    search.leave_out(names);
    return true;
  }
  return false;
}

std::vector<Discovered> add_discovered(Search& search) {
  if (!search.remains() || !can_hold_laws(search.study())) return {};
  Laws laws = borne_out(search.setting(), search.fit());
  if (laws.found.empty()) return {};
  search.put_beside(laws.members);
  const std::vector<Member> before = search.fit().members;
  if (!search.name_beside_laws()) return laws.found;
  // Names that were found beside a formula stand where both, fitted again, leave nothing.
  Laws again = borne_out(search.setting(), joint_fit(search.setting(), search.names()));
  if (!again.found.empty()) search.put_beside(again.members);
  if (search.confirms_names()) return again.found.empty() ? laws.found : again.found;
  search.hold(before);
  return laws.found;
}

Json law_findings(const Search& search, const std::vector<Discovered>& laws,
                  const HoldOut& holdout) {
  const JointFit& fit = search.fit();
  const double error = holdout.empty() ? 0.0 : holdout.mean_rmse(fit.members, fit.base);
  Json list = Json::array();
  std::size_t next = 0;
  for (std::size_t m = 0; m < fit.members.size(); ++m) {
    if (fit.members[m].law.is_null()) continue;
    Json entry = law_finding(laws[next++], fit.members[m].law);
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
