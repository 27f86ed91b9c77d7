// SPDX-License-Identifier: Apache-2.0
#include "dcnn/models/network_model.h"

#include <gtest/gtest.h>

#include "dcnn/core/random.h"
#include "models/support.h"

namespace dcnn {
namespace {

Samples network_samples(Index rows, std::uint64_t seed) {
  Rng rng(seed);
  Samples samples;
  samples.x.resize(rows, 15);
  samples.y.resize(rows, 3);
  for (Index i = 0; i < rows; ++i) {
    for (Index j = 0; j < 15; ++j) samples.x(i, j) = rng.normal();
    samples.y(i, 0) = 2.0 * samples.x(i, 0) + 5.0;
    samples.y(i, 1) = samples.x(i, 3) * samples.x(i, 3);
    samples.y(i, 2) = -samples.x(i, 7) + 0.5 * samples.x(i, 8);
  }
  return samples;
}

Problem network_problem(const Json& configuration, std::uint64_t seed) {
  Problem result;
  for (int j = 0; j < 15; ++j) result.layout.names.push_back("x" + std::to_string(j));
  result.layout.units.assign(15, "");
  result.targets = {{"fx", "fy", "fz"}, {"N", "N", "N"}};
  result.configuration = configuration;
  result.where = "test";
  result.seed = seed;
  return result;
}

std::unique_ptr<Model> make_network(const Json& patch = Json::object(), std::uint64_t seed = 1) {
  Json configuration = model_kind("dcnn", Exit::kUsage).preset("quick", false);
  configuration["training"]["epochs"] = 6;
  configuration["model"]["dropout"] = 0.1;
  configuration["model"]["padding"] = "valid";
  configuration["noise"] = {{"levels_db", Json::array({nullptr})}};
  for (const auto& [section, keys] : patch.items()) configuration[section].update(keys);
  return model_kind("dcnn", Exit::kUsage).make(network_problem(configuration, seed));
}

Eigen::VectorXd rmse_of_targets(const Model& model, const Samples& samples) {
  return (model.predict(samples) - samples.y).array().square().colwise().mean().sqrt().transpose();
}

TEST(NetworkModel, LearnsASmoothFunctionOfItsInputs) {
  const Samples training = network_samples(3000, 1), test = network_samples(500, 2);
  const auto model = make_network();
  FitSession session;
  ASSERT_TRUE(model->fit(training, {}, session));
  const Eigen::VectorXd error = rmse_of_targets(*model, test);
  for (Index j = 0; j < 3; ++j) {
    const double spread = std::sqrt((test.y.col(j).array() - test.y.col(j).mean()).square().mean());
    EXPECT_LT(error[j], 0.5 * spread) << "target " << j;
  }
}

TEST(NetworkModel, HasTheParameterCountsOfThePaper) {
  EXPECT_EQ(make_network({{"model", {{"padding", "same"}}}})->parameter_count(), 14155);
  EXPECT_EQ(make_network({{"model", {{"padding", "valid"}}}})->parameter_count(), 8011);
}

TEST(NetworkModel, LoadedModelPredictsTheSameBits) {
  const Samples training = network_samples(500, 1);
  for (const char* statistics : {"full", "running"}) {
    const auto model = make_network({{"training", {{"statistics", statistics}, {"ema", 0.9}}}});
    FitSession session;
    model->fit(training, {}, session);
    const Container file = decode(encode(test::saved(*model)), "memory");
    const auto loaded = model_kind("dcnn", Exit::kModel).load(file, "memory");
    EXPECT_EQ(loaded->predict(training), model->predict(training));
  }
}

TEST(NetworkModel, OneRowPredictsWhatItPredictsAmongOthers) {
  const Samples training = network_samples(700, 1);
  const auto model = make_network();
  FitSession session;
  model->fit(training, {}, session);
  const Eigen::MatrixXd all = model->predict(training);
  for (const Index row : {0, 13, 519, 520, 699}) {
    EXPECT_EQ(model->predict({training.x.row(row), {}}), all.row(row)) << row;
  }
}

/// The leak of the paper's possible reading: five copies of a feature, each with noise of its own.
TEST(NetworkModel, NoiseOnEveryEntryOfTheMapAveragesOut) {
  const Samples training = network_samples(3000, 1), test = network_samples(500, 2);
  const auto model = make_network();
  FitSession session;
  model->fit(training, {}, session);
  const auto& network = dynamic_cast<const NetworkModel&>(*model);
  const Eigen::MatrixXd clean = model->predict(test);
  const auto moved = [&](double snr) {
    return (network.predict_with_noisy_entries(test, snr, 5) - clean).norm();
  };
  const Eigen::VectorXd deviation = noise_deviation({}, model->map(), test.x, 10.0);
  const Eigen::MatrixXd on_features = model->predict({with_noise(test.x, deviation, 5), {}});
  EXPECT_LT(moved(10.0), 0.95 * (on_features - clean).norm());
  EXPECT_GT(moved(10.0), 2.0 * moved(20.0));
  EXPECT_LT(moved(200.0), 1e-4);
}

/// Stops a training in the middle of an epoch and goes on in a new object from the checkpoint
/// alone.
TEST(NetworkModel, GoesOnFromAnyStepToTheSameWeights) {
  const Samples training = network_samples(600, 1), validation = network_samples(200, 2);
  const Json patch = {{"training", {{"ema", 0.99}}}, {"noise", {{"levels_db", {nullptr, 20.0}}}}};
  const auto whole = make_network(patch);
  FitSession session;
  ASSERT_TRUE(whole->fit(training, validation, session));

  for (const int stop_at : {0, 1, 12, 17, 30, 71}) {
    Container checkpoint;
    int steps = 0;
    FitSession first;
    first.stop_wanted = [&] { return steps == stop_at; };
    first.step_done = [&](Index, Index, Index, double) { ++steps; };
    first.save_checkpoint = [&](const Container& file) { checkpoint = file; };
    ASSERT_FALSE(make_network(patch)->fit(training, validation, first));

    const auto resumed = make_network(patch);
    FitSession second;
    second.checkpoint = decode(encode(checkpoint), "memory");
    ASSERT_TRUE(resumed->fit(training, validation, second));
    EXPECT_EQ(encode(test::saved(*resumed)), encode(test::saved(*whole)))
        << "stopped at step " << stop_at;
  }
}

TEST(NetworkModel, KeepsTheEpochWithTheLeastValidationError) {
  const Samples training = network_samples(600, 1), validation = network_samples(200, 2);
  const auto model = make_network();
  FitSession session;
  double least = 1e9;
  Eigen::VectorXd of_best;
  session.epoch_done = [&](const EpochRecord& record) {
    if (record.best) of_best = rmse_of_targets(*model, validation);
    double sum = 0.0;
    for (const double value : record.validation_rmse) sum += value;
    least = std::min(least, sum);
  };
  model->fit(training, validation, session);
  EXPECT_EQ(rmse_of_targets(*model, validation), of_best);
}

TEST(NetworkModel, StatisticsComeFromTheTrainingRowsAlone) {
  const Samples training = network_samples(600, 1);
  Samples validation = network_samples(200, 2);
  const auto first = make_network(), second = make_network();
  FitSession session;
  first->fit(training, validation, session);
  validation.x *= 3.0;
  second->fit(training, validation, session);
  EXPECT_EQ(test::saved(*first).metadata["map"], test::saved(*second).metadata["map"]);
  EXPECT_EQ(test::saved(*first).metadata["target_scale"],
            test::saved(*second).metadata["target_scale"]);
}

TEST(NetworkModel, ValidPaddingNeedsRoomAndSaysSo) {
  Json configuration = model_kind("dcnn", Exit::kUsage).preset("quick", false);
  configuration["model"]["padding"] = "valid";
  Problem small = network_problem(configuration, 1);
  small.layout.names.resize(4);
  try {
    model_kind("dcnn", Exit::kUsage).make(small);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kUsage);
    EXPECT_NE(std::string(error.what()).find("'same'"), std::string::npos);
  }
}

TEST(NetworkModel, DivergenceIsAnErrorNotANaN) {
  Samples training = network_samples(200, 1);
  training.y *= 1e30;
  const auto model = make_network({{"training", {{"lr", 1e3}, {"standardise_targets", false}}}});
  FitSession session;
  EXPECT_THROW(model->fit(training, {}, session), Error);
}

TEST(Presets, AreThoseOfTheSpecification) {
  const ModelKind& kind = model_kind("dcnn", Exit::kUsage);
  EXPECT_EQ(kind.preset("quick", false)["training"]["epochs"], 5);
  EXPECT_EQ(kind.preset("standard", false)["training"]["epochs"], 30);
  EXPECT_EQ(kind.preset("fair", false)["training"]["drop_period"], 40);
  const Json paper = kind.preset("paper", true);
  EXPECT_EQ(paper["training"]["epochs"], 500);
  EXPECT_EQ(paper["training"]["drop_factor"], 0.001);
  EXPECT_EQ(paper["training"]["standardise_targets"], false);
  EXPECT_EQ(paper["model"]["init"], "narrow");
  EXPECT_EQ(paper["model"]["dropout"], 0.5);
  EXPECT_EQ(kind.preset("standard", true)["model"]["dropout"], 0.0);
  EXPECT_EQ(kind.preset("standard", true)["training"]["batch"], 200);
}

}  // namespace
}  // namespace dcnn
