// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/system.h"

#include <gtest/gtest.h>

namespace dcnn {
namespace {

// The weight of a load off an axis is looked for where its position is an angle.
TEST(SystemOfAxes, APositionIsAnAngleByTheUnitOfItsReadingOrByItsName) {
  const auto unit_of = [](const char* unit, const char* position, const char* said = nullptr) {
    Json axis{{"name", "a"}, {"measured", "y"}, {"unit", unit}, {"position", position}};
    if (said != nullptr) axis["position_unit"] = said;
    const Json system{{"kind", "axes"}, {"axes", {axis}}};
    return parse_system(system, "system.json").axes[0].position_unit;
  };
  EXPECT_EQ(unit_of("N*m", "x"), "rad");
  EXPECT_EQ(unit_of("N", "angle"), "m");
  EXPECT_EQ(unit_of("1/s^2", "Angle"), "rad");
  EXPECT_EQ(unit_of("rad/s", "q_axle"), "rad");
  EXPECT_EQ(unit_of("V", "motor_rad"), "rad");
  EXPECT_EQ(unit_of("V", "radius"), "");
  EXPECT_EQ(unit_of("V", "q_1", "mm"), "mm");
}

}  // namespace
}  // namespace dcnn
