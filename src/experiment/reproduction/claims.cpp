// SPDX-License-Identifier: Apache-2.0
#include "experiment/reproduction/claims.h"

#include <algorithm>
#include <optional>

#include "experiment/markup.h"

namespace dcnn {
namespace {

using Verdict = Claim::Verdict;

const std::vector<std::string> kShallow{"ffnn-s", "cfnn-s", "ffnn-m", "cfnn-m"};
const std::vector<std::string> kNetworks{"ffnn-s", "cfnn-s", "ffnn-m", "cfnn-m", "lstm", "dcnn"};
const std::vector<std::string> kIdentifiers{"cf",     "ffnn-s", "cfnn-s", "ffnn-m",
                                            "cfnn-m", "lstm",   "dcnn"};

struct NamedModel {
  std::string name;
  double value;
};

using Values = std::optional<std::vector<NamedModel>>;

/// Mean over the noisy levels of a number of each model; nothing where a model or a level lacks it.
template <class Pick>
Values averages(const Scores& scores, const std::vector<std::string>& names, Pick pick) {
  std::vector<NamedModel> result;
  for (const auto& name : names) {
    const ModelScores* model = scores.find(name);
    if (model == nullptr) return std::nullopt;
    double sum = 0;
    int count = 0;
    for (const LevelScore& level : model->levels) {
      if (!level.snr_db) continue;
      const std::optional<double> value = pick(level);
      if (!value) return std::nullopt;
      sum += *value;
      ++count;
    }
    if (count == 0) return std::nullopt;
    result.push_back({name, sum / count});
  }
  return result;
}

Values axis_averages(const Scores& scores, const std::vector<std::string>& names,
                     const std::string& target) {
  const int j = scores.target(target);
  if (j < 0) return std::nullopt;
  return averages(scores, names, [j](const LevelScore& level) {
    return std::optional<double>(level.rmse[static_cast<std::size_t>(j)].mean);
  });
}

Values overall_averages(const Scores& scores, const std::vector<std::string>& names) {
  return averages(scores, names, [](const LevelScore& level) {
    return level.overall ? std::optional<double>(level.overall->mean) : std::nullopt;
  });
}

Values deviation_averages(const Scores& scores, const std::vector<std::string>& names) {
  return averages(scores, names, [](const LevelScore& level) {
    return level.overall && level.runs > 1 ? std::optional<double>(level.overall->deviation)
                                           : std::nullopt;
  });
}

Values call_times(const std::vector<Timing>& timings, const std::vector<std::string>& names,
                  int length) {
  std::vector<NamedModel> result;
  for (const auto& name : names) {
    const auto row = std::find_if(timings.begin(), timings.end(), [&](const Timing& t) {
      return t.entry == name && t.length == length && !t.from_pose;
    });
    if (row == timings.end()) return std::nullopt;
    result.push_back({name, row->mean_s});
  }
  return result;
}

/// "ffnn-s 0.267, cfnn-s 0.270"
std::string listed(const std::vector<NamedModel>& values, double scale = 1) {
  std::string text;
  for (const auto& [name, value] : values)
    text += (text.empty() ? "" : ", ") + name + " " + significant(value * scale, 4);
  return text;
}

double value_of(const std::vector<NamedModel>& values, const std::string& name) {
  return std::find_if(values.begin(), values.end(),
                      [&](const NamedModel& v) { return v.name == name; })
      ->value;
}

/// `name` is below all the others.
bool is_least(const std::vector<NamedModel>& values, const std::string& name) {
  const double own = value_of(values, name);
  return std::all_of(values.begin(), values.end(),
                     [&](const NamedModel& v) { return v.name == name || own < v.value; });
}

Verdict verdict(bool holds) { return holds ? Verdict::kHolds : Verdict::kFails; }

Claim claim_1(const Scores& scores) {
  Claim claim{"C1",
              "DCNN and LSTM are below all four shallow networks on Fy and on Fz on average",
              Verdict::kNotTested,
              {}};
  const auto y = axis_averages(scores, kNetworks, "fy"), z = axis_averages(scores, kNetworks, "fz");
  if (!y || !z) return claim;
  bool holds = true;
  for (const auto* axis : {&*y, &*z}) {
    for (const auto& shallow : kShallow) {
      for (const char* deep : {"dcnn", "lstm"})
        holds = holds && value_of(*axis, deep) < value_of(*axis, shallow);
    }
  }
  claim.verdict = verdict(holds);
  claim.numbers = "Fy: " + listed(*y) + " N; Fz: " + listed(*z) + " N";
  return claim;
}

Claim claim_2(const Scores& scores) {
  Claim claim{"C2", "DCNN has the lowest mean RMSE on Fx", Verdict::kNotTested, {}};
  const auto x = axis_averages(scores, kIdentifiers, "fx");
  if (!x) return claim;
  claim.verdict = verdict(is_least(*x, "dcnn"));
  claim.numbers = "Fx: " + listed(*x) + " N";
  return claim;
}

Claim claim_3(const Scores& scores) {
  Claim claim{"C3",
              "DCNN has the smallest standard deviation over the noise draws (without NS, whose is "
              "zero by definition)",
              Verdict::kNotTested,
              {}};
  const auto deviations = deviation_averages(scores, kIdentifiers);
  if (!deviations) return claim;
  claim.verdict = verdict(is_least(*deviations, "dcnn"));
  claim.numbers = "SD of the overall RMSE over draws on " + std::to_string(scores.samples) +
                  " test samples: " + listed(*deviations, 1e3) + " mN";
  return claim;
}

Claim claim_4(const Scores& scores, const std::vector<Timing>& timings) {
  Claim claim{
      "C4",
      "Every identifier is below NS; CF is the fastest, but less accurate than every network",
      Verdict::kNotTested,
      {}};
  std::vector<std::string> names{kNoIdentification};
  names.insert(names.end(), kIdentifiers.begin(), kIdentifiers.end());
  const auto overall = overall_averages(scores, names);
  const auto times = call_times(timings, kIdentifiers, 1);
  if (!overall || !times) return claim;
  const double none = value_of(*overall, kNoIdentification), cf = value_of(*overall, "cf");
  const bool below = std::all_of(overall->begin(), overall->end(), [&](const NamedModel& v) {
    return v.name == kNoIdentification || v.value < none;
  });
  const bool fastest = is_least(*times, "cf");
  const auto better = std::count_if(kNetworks.begin(), kNetworks.end(), [&](const auto& name) {
    return value_of(*overall, name) < cf;
  });
  const bool less_accurate = better == static_cast<long>(kNetworks.size());
  claim.verdict = verdict(below && fastest && less_accurate);
  claim.numbers = std::string("below NS: ") + (below ? "all" : "not all") + "; CF " +
                  (fastest ? "is" : "is not") + " the fastest; " + std::to_string(better) + " of " +
                  std::to_string(kNetworks.size()) +
                  " networks are more accurate than CF. Overall: " + listed(*overall) + " N";
  return claim;
}

Claim claim_5(const std::vector<Timing>& timings) {
  Claim claim{"C5",
              "DCNN's time per call is below LSTM's and those of the multi-layer networks, one "
              "sample a call",
              Verdict::kNotTested,
              {}};
  const auto times = call_times(timings, {"ffnn-m", "cfnn-m", "lstm", "dcnn"}, 1);
  if (!times) return claim;
  claim.verdict = verdict(is_least(*times, "dcnn"));
  claim.numbers = listed(*times, 1e6) + " µs";
  return claim;
}

}  // namespace

std::vector<Claim> judge_claims(const Scores& scores, const std::vector<Timing>& timings) {
  return {claim_1(scores), claim_2(scores), claim_3(scores), claim_4(scores, timings),
          claim_5(timings)};
}

std::string verdict_word(Claim::Verdict verdict) {
  switch (verdict) {
    case Verdict::kHolds:
      return "true";
    case Verdict::kFails:
      return "false";
    case Verdict::kNotTested:
      return "not tested";
  }
  return {};
}

}  // namespace dcnn
