// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/exchanges.h"

#include <gtest/gtest.h>

namespace dcnn {
namespace {

std::vector<Member> one(const char* effect) {
  Member member;
  member.kind = find_effect(effect);
  member.axis = "base_x";
  return {member};
}

Alternative other(const char* effect, double log_odds) {
  Alternative alternative;
  alternative.name = effect;
  alternative.members = one(effect);
  alternative.log_odds = log_odds;
  return alternative;
}

// By the noise that each leaves the other seems to be likelier: what was said for both is weighed
// once, and neither is exchanged for the other for ever.
TEST(Exchanges, CountTheSameFromEitherSide) {
  Exchanges exchanges;
  exchanges.made(one("coulomb_friction"), other("lugre_friction", 400.0));
  std::vector<std::vector<Alternative>> back{
      {other("coulomb_friction", 160.0), other("hysteresis", 3.0)}};
  exchanges.make_symmetric(one("lugre_friction"), back);
  EXPECT_DOUBLE_EQ(back[0][0].log_odds, -120.0);
  EXPECT_DOUBLE_EQ(back[0][1].log_odds, 3.0);  // never stood in its place
  exchanges.made(one("lugre_friction"), other("coulomb_friction", 160.0));
  std::vector<std::vector<Alternative>> again{{other("lugre_friction", 400.0)}};
  exchanges.make_symmetric(one("coulomb_friction"), again);
  EXPECT_DOUBLE_EQ(again[0][0].log_odds, 120.0);
}

}  // namespace
}  // namespace dcnn
