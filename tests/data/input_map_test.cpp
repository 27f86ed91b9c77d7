// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/input_map.h"

#include <gtest/gtest.h>

#include "data/testing.h"
#include "dcnn/core/json.h"
#include "dcnn/core/random.h"

namespace dcnn {
namespace {

Eigen::MatrixXd random_features(Index rows, Index columns) {
  Rng rng(3);
  Eigen::MatrixXd x(rows, columns);
  for (double& value : x.reshaped()) value = 2.0 + 3.0 * rng.normal();
  return x;
}

TEST(InputMap, HasTheFiveColumnsOfEq7) {
  Eigen::MatrixXd x(3, 1);
  x << -1.0, 2.0, 5.0;  // mean 2, standard deviation 3
  const double sample = -4.0;
  double map[5];
  InputMap(x, {false, false}).write(&sample, map);
  const double wanted[] = {-4.0, -6.0, -2.0, 4.0, 16.0};
  for (int k = 0; k < 5; ++k) EXPECT_DOUBLE_EQ(map[k], wanted[k]) << k;
  InputMap(x, {true, false}).write(&sample, map);
  EXPECT_DOUBLE_EQ(map[2], -6.0 / 9.0);
}

TEST(InputMap, ZerocenterMakesTheTrainingMeanOfEveryCellZero) {
  const Eigen::MatrixXd x = random_features(500, 4);
  const InputMap input_map(x, {});
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(20), cells(20);
  for (Index i = 0; i < x.rows(); ++i) {
    const Eigen::VectorXd row = x.row(i).transpose();
    input_map.write(row.data(), cells.data());
    sum += cells;
  }
  EXPECT_LT(sum.cwiseAbs().maxCoeff() / 500.0, 1e-11);
}

TEST(InputMap, AConstantFeatureHasScaleOne) {
  const InputMap input_map(Eigen::MatrixXd::Constant(10, 1, 4.0), {false, false});
  const double sample = 6.0;
  float map[5];
  input_map.write(&sample, map);
  EXPECT_EQ(map[2], 2.0f);
}

TEST(InputMap, FloorsTheScaleOfAComponentThatHardlyMovedBesideItsSisters) {
  Eigen::MatrixXd x = random_features(500, 3);
  x.col(1) *= 1e-9;
  const InputMap literal(x, {false, false}, {"rad/s", "rad/s", "m"});
  const InputMap floored(x, {false, false, 0.01}, {"rad/s", "rad/s", "m"});
  const InputMap alone(x, {false, false, 0.01}, {"", "", ""});
  const double sample[] = {0.0, 0.1, 0.0};
  double one[15], two[15], three[15];
  literal.write(sample, one);
  floored.write(sample, two);
  alone.write(sample, three);
  EXPECT_GT(std::abs(one[7]), 1e7);
  EXPECT_NEAR(two[7], (0.1 - floored.mean()[1]) / (0.01 * floored.deviation()[0]), 1e-9);
  EXPECT_EQ(three[7], one[7]) << "features of unknown unit are no sisters";
  EXPECT_EQ(two[12], one[12]) << "another unit is left alone";
}

TEST(InputMap, ClipHoldsEveryColumnWithinReachOfTheTraining) {
  const Eigen::MatrixXd x = random_features(500, 1);
  const InputMap input_map(x, {false, false, 0.0, 3.0});
  const double far = 1e6, near = input_map.mean()[0] + 3.0 * input_map.deviation()[0];
  double one[5], two[5];
  input_map.write(&far, one);
  input_map.write(&near, two);
  for (int k = 0; k < 5; ++k) EXPECT_EQ(one[k], two[k]);
}

TEST(InputMap, ComesBackExactlyFromJson) {
  for (const bool flag : {false, true}) {
    const InputMap input_map(random_features(50, 3),
                             {flag, !flag, flag ? 0.0 : 0.3, flag ? 2.0 : 0.0}, {"m", "m", "m"});
    const Json json = parse_json(input_map.to_json().dump(), "m", Exit::kModel);
    const InputMap back = InputMap::parse(json, "m", Exit::kModel);
    EXPECT_EQ(back.mean(), input_map.mean());
    EXPECT_EQ(back.deviation(), input_map.deviation());
    EXPECT_EQ(back.mean_square(), input_map.mean_square());
    const double sample[] = {0.1, -7.0, 3.0};
    double one[15], two[15];
    input_map.write(sample, one);
    back.write(sample, two);
    for (int k = 0; k < 15; ++k) EXPECT_EQ(one[k], two[k]);
  }
}

TEST(InputMap, RejectsBrokenStatistics) {
  const Json good = InputMap(random_features(50, 3), {}).to_json();
  const auto rejected = [&](const char* key, const Json& value) {
    Json json = good;
    json[key] = value;
    testing::error_of([&] { InputMap::parse(json, "m", Exit::kModel); }, Exit::kModel);
  };
  rejected("mean", {1.0, 2.0});
  rejected("deviation", {1.0, -2.0, 3.0});
  rejected("centre", Json::array({1.0}));
  rejected("mean", {1.0, 2.0, nullptr});
  rejected("mean_square", {1.0, 2.0, std::numeric_limits<double>::infinity()});
  rejected("unknown", 1);
}

TEST(InputMap, AgreesWithTheReference) {
  const auto path = testing::shared("reference/xmap.json");
  if (path.empty()) GTEST_SKIP() << "../shared/reference is absent";
  const Json json = read_json(path, Exit::kData);
  const InputMap input_map = InputMap::parse({{"variance", false},
                                              {"zerocenter", false},
                                              {"mean", json["mean"]},
                                              {"deviation", json["sd"]},
                                              {"scale", json["sd"]},
                                              {"mean_square", std::vector<double>(15)},
                                              {"centre", std::vector<double>(75)}},
                                             "xmap.json", Exit::kData);
  for (std::size_t i = 0; i < json["X"].size(); ++i) {
    const auto x = json["X"][i].get<std::vector<double>>();
    double map[75];
    input_map.write(x.data(), map);
    for (std::size_t cell = 0; cell < 75; ++cell) {
      EXPECT_NEAR(map[cell], json["Xstar"][i][cell / 5][cell % 5].get<double>(), 1e-14);
    }
  }
}

}  // namespace
}  // namespace dcnn
