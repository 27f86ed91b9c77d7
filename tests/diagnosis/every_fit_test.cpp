// SPDX-License-Identifier: Apache-2.0
// Every effect that the diagnosis looks for is named when it is hidden alone.
#include <gtest/gtest.h>

#include "diagnosis/support.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

using test::Bench;
using test::configuration;
using test::names;

/// Every effect that the diagnosis looks for, hidden alone with the numbers of its example.
class EveryFit : public testing::TestWithParam<const EffectKind*> {};

std::vector<const EffectKind*> fitted_kinds() {
  std::vector<const EffectKind*> kinds;
  for (const auto* kind : effect_kinds()) {
    // What shows in torques alone: wrench_test
    if (!kind->fits.empty() && kind->subject < EffectKind::Subject::kMachines &&
        kind->force != Shown::kNever)
      kinds.push_back(kind);
  }
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryFit, testing::ValuesIn(fitted_kinds()),
                         [](const auto& test) { return std::string(test.param->name); });

TEST_P(EveryFit, IsNamedWhenHiddenAlone) {
  const EffectKind& kind = *GetParam();
  if (test::kSanitized && kind.stage != Stage::kDynamics) {
    GTEST_SKIP() << "optimised builds run all";
  }
  Json entry{{"effect", kind.name}, {"axis", nullptr}, {"parameters", Json::parse(kind.example)}};
  const auto axes = admitted_axes(kind.axis);
  if (!axes.empty()) entry["axis"] = axes.front();
  if (kind.interval == IntervalRule::kRequired) entry["interval_s"] = {6.3, 11.8};
  if (kind.interval == IntervalRule::kOnset) entry["interval_s"] = {8.4, 45.0};
  Json config = configuration(Json::array({entry}));
  // A controller that subtracts a weight, whose forces are columns: it knows no inertia.
  const bool by_columns = std::string(kind.name) == "weightless_mass";
  if (by_columns || std::string(kind.name) == "inertial_terms") {
    config["simulator"]["model"] = {{"inertial", "none"}};
  }
  // At 12 Hz the tool would ring by less than the log can show: nothing moves that fast here.
  if (std::string(kind.name) == "flexible_resonance") {
    config["hidden"][0]["parameters"]["freq_hz"] = 3.0;
  }
  if (std::string(kind.name) == "saturation") config["hidden"][0]["parameters"]["limit_n"] = 1.5;
  const Bench bench(config);
  const Json report = (by_columns ? bench.diagnose_columns() : bench.diagnose()).report;
  const auto found = names(report);
  ASSERT_EQ(found, std::vector<std::string>{kind.name}) << report["findings"].dump(1);
  const Json& finding = report["findings"][0];
  if (!axes.empty()) {
    EXPECT_EQ(finding["axis"], axes.front());
  }
  for (const auto& [name, p] : finding["parameters"].items()) {
    EXPECT_EQ(p["unit"], unit_of_parameter(name));
    // What is read off the raw values is known to their last digit, not better.
    EXPECT_LT(p["ci95"][0].get<double>(), p["ci95"][1].get<double>()) << name;
  }
}

}  // namespace
}  // namespace dcnn
