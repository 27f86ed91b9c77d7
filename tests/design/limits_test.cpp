// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "design/path.h"
#include "design/proposals.h"
#include "support/design.h"

namespace dcnn::design {
namespace {

double greatest(const Spline& spline, const Limits& limits, double rate_hz) {
  double most = 0.0;
  for (const Usage& one : usage(play(spline, limits, ToolModel(), rate_hz, 0.0), limits))
    most = std::max(most, one.share);
  return most;
}

/// Limits of any tool: ranges of nothing to metres, speeds over three decades, some without jerk or
/// work space.
Json random_limits(Rng& rng) {
  const auto logarithmic = [&](double low, double high) {
    return low * std::pow(high / low, rng.uniform());
  };
  Json json{{"rate_hz", rng.uniform() < 0.5 ? 100.0 : 250.0}};
  Json position = Json::object(), angle = Json::object(), at = Json::array(),
       turned = Json::array();
  const auto add = [&](Json& group, Json& start, const char* name, double most, double half) {
    const double middle = rng.uniform(-most + half, most - half);
    const double size = rng.uniform() < 0.2 ? 0.0 : half;
    group[name] = {middle - size, middle + size};
    start.push_back(middle + size * rng.uniform(-0.9, 0.9));
  };
  for (const char* name : {"x", "y", "z"}) add(position, at, name, 2.0, logarithmic(0.01, 0.5));
  for (const char* name : {"alpha", "beta", "gamma"})
    add(angle, turned, name, 1.4, logarithmic(0.02, 1.0));
  json["position_m"] = position;
  json["angle_rad"] = angle;
  json["start"] = {{"position_m", at}, {"angle_rad", turned}};
  json["speed_mps"] = logarithmic(0.01, 2.0);
  json["acceleration_mps2"] = logarithmic(0.05, 20.0);
  json["rate_radps"] = logarithmic(0.01, 5.0);
  json["acceleration_radps2"] = logarithmic(0.05, 50.0);
  if (rng.uniform() < 0.7) json["jerk_mps3"] = logarithmic(0.5, 500.0);
  if (rng.uniform() < 0.7) json["jerk_radps3"] = logarithmic(0.5, 1000.0);
  if (rng.uniform() < 0.3) {
    const double distance =
        Eigen::Vector3d(at[0].get<double>(), at[1].get<double>(), at[2].get<double>()).norm();
    json["work_space"] = {{"center_m", {0.0, 0.0, 0.0}},
                          {"radius_m", {0.9 * distance, 1.1 * distance + 0.01}}};
  }
  return json;
}

TEST(DesignLimits, AreNeverBrokenByMotionsUnderRandomLimits) {
  const char* const more = std::getenv("DCNN_DESIGNS");  // docs/develop/building.md
  const int designs = more ? std::atoi(more) : 60;
  Rng rng({7});
  int used = 0;
  for (int k = 0; k < designs; ++k) {
    const Json json = random_limits(rng);
    const Limits limits = parse_limits(json, "limits.json", ".");
    const Spline spline = within(draw_spline(limits, 6.0, rng), limits, limits.rate_hz);
    // At the rate at which it is played, and between those samples.
    for (const double rate : {limits.rate_hz, 7.3 * limits.rate_hz}) {
      if (rate > limits.rate_hz && k % 10 != 0) continue;
      const double most = greatest(spline, limits, rate);
      ASSERT_LE(most, 1.0) << json.dump();
      used += most > 0.9 ? 1 : 0;
    }
  }
  EXPECT_GT(used, designs / 2);  // and not by motions that hardly move
}

TEST(DesignLimits, OfJointsHoldForAnArm) {
  Json json = test::tool_limits_json();
  for (const char* key : {"position_m", "angle_rad", "start", "jerk_mps3", "jerk_radps3"})
    json.erase(key);
  json["joints"] = {{"dh",
                     {{0.0, 0.0, 0.3, 0.0},
                      {0.0, -1.5707963, 0.0, 0.0},
                      {0.4, 0.0, 0.0, 0.0},
                      {0.0, -1.5707963, 0.35, 0.0}}},
                    {"range", {{-1.0, 1.0}, {-1.2, -0.4}, {0.3, 1.2}, {-1.0, 1.0}}},
                    {"speed", {1.0, 1.0, 1.0, 2.0}},
                    {"acceleration", {4.0, 4.0, 4.0, 8.0}},
                    {"jerk", {60.0, 60.0, 60.0, 90.0}}};
  const Limits limits = parse_limits(json, "limits.json", ".");
  Rng rng({8});
  double used = 0.0;
  for (int k = 0; k < 20; ++k) {
    const Spline spline = within(draw_spline(limits, 6.0, rng), limits, limits.rate_hz);
    const double most = greatest(spline, limits, limits.rate_hz);
    ASSERT_LE(most, 1.0);
    used = std::max(used, most);
  }
  EXPECT_GT(used, 0.9);
  // The pose's exact derivatives are those of its differences.
  const Played p = play(draw_spline(limits, 6.0, rng), limits, ToolModel(), 5000.0, 0.0);
  const Index n = p.pose.rows();
  const Eigen::MatrixXd x = p.motion.p_B;
  const Eigen::MatrixXd v = (x.bottomRows(n - 2) - x.topRows(n - 2)) * 2500.0;
  EXPECT_LT((v - p.motion.v_B.middleRows(1, n - 2)).cwiseAbs().maxCoeff(),
            1e-4 * v.cwiseAbs().maxCoeff());
  const Eigen::MatrixXd a = (p.motion.v_B.bottomRows(n - 2) - p.motion.v_B.topRows(n - 2)) * 2500.0;
  EXPECT_LT((a - p.motion.a_B.middleRows(1, n - 2)).cwiseAbs().maxCoeff(),
            1e-3 * a.cwiseAbs().maxCoeff());
  Eigen::MatrixXd w(n - 2, 3);
  for (Index k = 1; k + 1 < n; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const Eigen::Matrix3d S =
        p.motion.R_BS[at].transpose() * (p.motion.R_BS[at + 1] - p.motion.R_BS[at - 1]) * 2500.0;
    w.row(k - 1) << S(2, 1), S(0, 2), S(1, 0);
  }
  EXPECT_LT((w - p.motion.w_S.middleRows(1, n - 2)).cwiseAbs().maxCoeff(),
            1e-3 * w.cwiseAbs().maxCoeff());
  const Eigen::MatrixXd dw =
      (p.motion.w_S.bottomRows(n - 2) - p.motion.w_S.topRows(n - 2)) * 2500.0;
  EXPECT_LT((dw - p.motion.dw_S.middleRows(1, n - 2)).cwiseAbs().maxCoeff(),
            1e-3 * dw.cwiseAbs().maxCoeff());
}

struct BadLimits {
  const char* name;
  void (*spoil)(Json&);
  const char* says;
};
const BadLimits kBad[] = {
    {"NoSpeed", [](Json& j) { j.erase("speed_mps"); }, "'speed_mps' is missing"},
    {"NoRanges", [](Json& j) { j.erase("position_m"); }, "'position_m' is missing"},
    {"UnknownKey", [](Json& j) { j["sped_mps"] = 1.0; }, "sped_mps"},
    {"RangeTheWrongWayRound",
     [](Json& j) {
       j["position_m"]["x"] = {0.1, -0.1};
     },
     "must be [low, high]"},
    {"RangeOfThree",
     [](Json& j) {
       j["position_m"]["y"] = {0.1, 0.2, 0.3};
     },
     "must be [low, high]"},
    {"NegativeSpeed", [](Json& j) { j["speed_mps"] = -1.0; }, "must be above 0"},
    {"Words", [](Json& j) { j["speed_mps"] = "fast"; }, "must be a number"},
    {"StartOutside",
     [](Json& j) {
       j["start"]["position_m"] = {0.5, 0, 0};
     },
     "outside of its range"},
    {"GimbalLock",
     [](Json& j) {
       j["angle_rad"]["beta"] = {-2.0, 2.0};
     },
     "must be [low, high]"},
    {"StartOutsideOfTheWorkSpace",
     [](Json& j) {
       j["work_space"] = {{"center_m", {1, 0, 0}}, {"radius_m", {0.1, 0.2}}};
     },
     "does not hold the start"},
    {"NoObject", [](Json& j) { j = Json::array(); }, "must hold an object"},
    {"JointsWithoutArm", [](Json& j) { j["joints"] = Json::object(); }, "must say what the arm is"},
};

class DesignBadLimits : public testing::TestWithParam<BadLimits> {};

TEST_P(DesignBadLimits, AreOneLine) {
  Json json = test::tool_limits_json();
  GetParam().spoil(json);
  try {
    parse_limits(json, "limits.json", ".");
    FAIL() << "accepted";
  } catch (const Error& e) {
    const std::string text = e.what();
    EXPECT_EQ(e.exit(), Exit::kUsage);
    EXPECT_NE(text.find(GetParam().says), text.npos) << text;
    EXPECT_EQ(text.find('\n'), text.npos);
    EXPECT_EQ(text.rfind("limits.json", 0), 0U) << text;
  }
}

INSTANTIATE_TEST_SUITE_P(Of, DesignBadLimits, testing::ValuesIn(kBad),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace dcnn::design
