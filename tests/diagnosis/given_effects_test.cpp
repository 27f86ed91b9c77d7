// SPDX-License-Identifier: Apache-2.0
// A simulator that has effects already, as model.json of an earlier diagnosis.
#include <gtest/gtest.h>

#include "diagnosis/support.h"

namespace dcnn {
namespace {

Json delay_and_friction() {
  return {test::hidden("time_delay", nullptr, {{"delay_s", 0.02}}),
          test::hidden("coulomb_friction", "base_x", {{"fc_n", 0.4}, {"v0_mps", 0.01}}),
          test::hidden("mass", nullptr, {{"delta_mass_kg", 0.1}})};
}

Diagnosis beside(const Json& given) {
  const test::Bench bench(test::configuration(delay_and_friction()));
  Json simulator = read_json(bench / "sim.json", Exit::kData);
  simulator["effects"] = given;
  write_file(bench / "sim.json", simulator.dump());
  return bench.diagnose();
}

TEST(GivenEffects, AreNotMissing) {
  const Diagnosis all = beside(delay_and_friction());
  EXPECT_EQ(all.report["verdict"], "consistent") << all.report["findings"].dump(1);
}

TEST(GivenEffects, StayInTheCorrectedSimulatorBesideWhatWasFound) {
  Json given = delay_and_friction();
  given.erase(1);
  const Diagnosis part = beside(given);
  EXPECT_EQ(test::names(part.report), std::vector<std::string>{"coulomb_friction"});
  EXPECT_EQ(part.report["verdict"], "explained");
  ASSERT_EQ(part.model["effects"].size(), 2u) << part.model.dump(1);
  EXPECT_EQ(part.model["effects"][0]["effect"], "time_delay");
  EXPECT_NEAR(part.model["tool"]["mass_kg"], 0.85, 1e-12);
}

}  // namespace
}  // namespace dcnn
