// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "dcnn/conceal/scenario.h"
#include "dcnn/core/error.h"

namespace dcnn::conceal {
namespace {

TEST(Draw, AScenarioWithoutAnAmplitudeIsRefusedInWords) {
  for (const char* value : {"much", "nan", "0.5x", "-1", "0", "1e400", ""}) {
    const std::string id = std::string("single:") + value + "/coulomb_friction/7";
    EXPECT_THROW(draw(id, 1), Error) << id;
  }
}

TEST(Draw, WrenchesHaveTorquesAndLevers) {
  const Scenario s = draw("wrench+single:1/cable_spring/3", 1);
  ASSERT_EQ(s.hidden.size(), 1u);
  const auto& numbers = s.hidden.front().parameters;
  const std::string along = std::string("lever_") + s.hidden.front().axis.back() + "_m";
  double lever = 0.0;
  for (const char* name : {"lever_x_m", "lever_y_m", "lever_z_m"})
    lever += std::abs(numbers.at(name));
  EXPECT_GT(lever, 0.01);
  EXPECT_EQ(numbers.at(along), 0.0);  // makes no torque
  for (const Recorded& r : s.recordings) EXPECT_EQ(r.measured.cols(), 6);
  EXPECT_EQ(truth(s)["oracle_rmse"].size(), 6u);
  const Scenario plain = draw("single:1/cable_spring/3", 1);
  EXPECT_EQ(plain.recordings.front().measured.cols(), 3);
  EXPECT_EQ(plain.hidden.front().parameters.count("lever_x_m"), 0u);
}

}  // namespace
}  // namespace dcnn::conceal
