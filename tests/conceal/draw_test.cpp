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

}  // namespace
}  // namespace dcnn::conceal
