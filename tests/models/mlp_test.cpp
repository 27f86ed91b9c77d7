// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "dcnn/core/random.h"
#include "dcnn/models/model.h"

namespace dcnn {
namespace {

Samples mlp_samples(Index rows, std::uint64_t seed) {
  Rng rng(seed);
  Samples samples;
  samples.x.resize(rows, 15);
  samples.y.resize(rows, 3);
  for (double& value : samples.x.reshaped()) value = 4.0 + 2.0 * rng.normal();
  samples.y.col(0) = 2.0 * samples.x.col(0).array() + 5.0;
  samples.y.col(1) = 3.0 * (0.4 * samples.x.col(3).array()).sin();
  samples.y.col(2) = 0.5 * samples.x.col(8) - samples.x.col(7);
  return samples;
}

std::unique_ptr<Model> make_mlp(const Json& model, Index epochs = 20) {
  Problem problem;
  problem.layout.names.assign(15, "x");
  problem.layout.units.assign(15, "");
  problem.targets = {{"fx", "fy", "fz"}, {"N", "N", "N"}};
  problem.configuration = model_kind("mlp", Exit::kUsage).preset("quick", false);
  problem.configuration["training"]["epochs"] = epochs;
  problem.configuration["noise"] = {{"levels_db", Json::array({nullptr})}};
  problem.configuration["model"].update(model);
  problem.where = "test.json";
  return model_kind("mlp", Exit::kUsage).make(problem);
}

TEST(Mlp, HasSixtyFourUnitsOnTheInputsItIsGiven) {
  EXPECT_EQ(make_mlp(Json::object())->parameter_count(), 16 * 64 + 65 * 3);
  EXPECT_EQ(make_mlp({{"input", {{"kind", "window"}, {"length", 3}}}})->parameter_count(),
            46 * 64 + 65 * 3);
  EXPECT_EQ(make_mlp({{"input", {{"kind", "map"}}}})->parameter_count(), 76 * 64 + 65 * 3);
  EXPECT_THROW(make_mlp({{"activation", "sine"}}), Error);
  EXPECT_THROW(make_mlp({{"hiden", 3}}), Error);
}

TEST(Mlp, LearnsASmoothFunctionAndLoadsTheSameBits) {
  const Samples training = mlp_samples(2000, 1), test = mlp_samples(300, 2);
  for (const char* activation : {"tanh", "relu"}) {
    const auto model = make_mlp({{"activation", activation}});
    FitSession session;
    ASSERT_TRUE(model->fit(training, {}, session));
    const Eigen::MatrixXd predicted = model->predict(test);
    const Eigen::MatrixXd centred = test.y.rowwise() - test.y.colwise().mean();
    EXPECT_LT((predicted - test.y).norm(), 0.3 * centred.norm()) << activation;
    Container file;
    model->save(file);
    const auto loaded = model_kind("mlp", Exit::kModel).load(decode(encode(file), "memory"), "m");
    EXPECT_EQ(loaded->predict(test), predicted);
  }
}

TEST(Mlp, PresetsAreThoseOfTheSpecification) {
  const ModelKind& kind = model_kind("mlp", Exit::kUsage);
  EXPECT_EQ(kind.preset("quick", false)["training"]["epochs"], 5);
  EXPECT_EQ(kind.preset("standard", false)["training"]["epochs"], 30);
  EXPECT_EQ(kind.preset("fair", false)["training"]["epochs"], 60);
  EXPECT_EQ(kind.preset("paper", false), kind.preset("fair", false));
}

}  // namespace
}  // namespace dcnn
