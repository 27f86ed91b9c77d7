// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "dcnn/core/random.h"
#include "dcnn/models/network_model.h"
#include "models/support.h"

namespace dcnn {
namespace {

/// White noise on every feature, in one segment; the target is the mean of the first feature over
/// its last eight rows.
Samples moving_average(Index rows, Index features, std::uint64_t seed) {
  constexpr Index kLength = 8;
  Rng rng(seed);
  Samples samples;
  samples.x = Eigen::MatrixXd::NullaryExpr(rows, features, [&] { return rng.normal(); });
  samples.y.resize(rows, 1);
  for (Index i = 0; i < rows; ++i) {
    const Index n = std::min(kLength, i + 1);
    samples.y(i, 0) = samples.x.col(0).segment(i - n + 1, n).mean();
  }
  samples.segments = {{0, rows}};
  return samples;
}

std::unique_ptr<Model> make(const std::string& kind, Index features, Index targets,
                            const Json& patch = Json::object()) {
  const ModelKind& row = model_kind(kind, Exit::kUsage);
  Problem problem;
  problem.layout.names.assign(static_cast<std::size_t>(features), "x");
  problem.layout.units.assign(static_cast<std::size_t>(features), "");
  problem.targets.names.assign(static_cast<std::size_t>(targets), "f");
  problem.targets.units.assign(static_cast<std::size_t>(targets), "N");
  problem.configuration = row.preset("standard", false);
  problem.configuration["noise"] = {{"levels_db", Json::array({nullptr})}};
  for (const auto& [section, keys] : patch.items()) problem.configuration[section].update(keys);
  problem.where = "test";
  problem.seed = 1;
  return row.make(problem);
}

/// Small and quick, with everything that a resumed training must get right.
std::unique_ptr<Model> make_small(const Json& training = Json::object()) {
  Json all = {{"epochs", 4}, {"batch", 50}, {"lr", 0.01}, {"clip", 0.2}, {"stride", 3}};
  all.update(training);
  return make("lstm-25", 3, 1,
              {{"model", {{"units", 10}, {"length", 6}, {"dropout", 0.2}}},
               {"training", all},
               {"noise", {{"levels_db", {nullptr, 20.0}}}}});
}

double relative_error(const Model& model, const Samples& samples) {
  const Eigen::ArrayXd y = samples.y.col(0).array();
  const double error = (model.predict(samples).col(0).array() - y).square().mean();
  return std::sqrt(error / (y - y.mean()).square().mean());
}

TEST(LstmModel, HasTheParameterCountOfThePaper) {
  EXPECT_EQ(make("lstm", 15, 3)->parameter_count(), 100053);
  EXPECT_EQ(make("lstm-25", 15, 3)->parameter_count(), 100053);
}

TEST(LstmModel, LearnsWhatNeedsMemoryAndOnlyWithMemory) {
  const Samples training = moving_average(3000, 2, 1), test = moving_average(600, 2, 2);
  const auto error = [&](Index length) {
    const auto model =
        make("lstm-25", 2, 1,
             {{"model", {{"units", 16}, {"length", length}, {"dropout", 0.0}}},
              {"training", {{"epochs", 12}, {"batch", 50}, {"lr", 0.01}, {"stride", 1}}}});
    FitSession session;
    EXPECT_TRUE(model->fit(training, {}, session));
    return relative_error(*model, test);
  };
  EXPECT_LT(error(10), 0.3);
  EXPECT_GT(error(1), 0.9);  // sqrt(1 - 1/8) = 0.935 of the target is in the past
}

TEST(LstmModel, LoadedModelPredictsTheSameBits) {
  const Samples training = moving_average(600, 3, 1);
  const auto model = make_small();
  FitSession session;
  ASSERT_TRUE(model->fit(training, {}, session));
  const Container file = decode(encode(test::saved(*model)), "memory");
  const auto loaded = model_kind("lstm-25", Exit::kModel).load(file, "memory");
  EXPECT_EQ(file.metadata.at("model"), "lstm-25");
  EXPECT_EQ(loaded->predict(training), model->predict(training));
}

TEST(LstmModel, ARowPredictsWhatItPredictsAmongOthers) {
  const Samples training = moving_average(1100, 3, 1);
  const auto model = make_small();
  FitSession session;
  ASSERT_TRUE(model->fit(training, {}, session));
  const Eigen::MatrixXd all = model->predict(training);
  for (const Index row : {5, 13, 519, 520, 525, 1099}) {
    const Eigen::MatrixXd window = training.x.middleRows(row - 5, 6);
    EXPECT_EQ(model->predict({window, {{0, 6}}}).row(5), all.row(row)) << row;
  }
}

TEST(LstmModel, WindowsStopAtSegmentsAndRepeatTheFirstRow) {
  const Samples training = moving_average(600, 3, 1);
  const auto model = make_small();
  FitSession session;
  ASSERT_TRUE(model->fit(training, {}, session));
  const Eigen::MatrixXd first = training.x.topRows(20), second = training.x.middleRows(300, 20);
  Stream both;
  both.x.resize(40, 3);
  both.x << first, second;
  both.segments = {{0, 20}, {20, 40}};
  const Eigen::MatrixXd joined = model->predict(both);
  EXPECT_EQ(joined.topRows(20), model->predict({first, {{0, 20}}}));
  EXPECT_EQ(joined.bottomRows(20), model->predict({second, {{0, 20}}}));

  Stream filled;
  filled.x.resize(25, 3);
  filled.x << second.row(0).replicate(5, 1), second;
  filled.segments = {{0, 25}};
  EXPECT_EQ(joined.bottomRows(20), model->predict(filled).bottomRows(20));
}

/// Stops a training in the middle of an epoch and goes on in a new object from the checkpoint
/// alone.
TEST(LstmModel, GoesOnFromAnyStepToTheSameWeights) {
  const Samples training = moving_average(600, 3, 1), validation = moving_average(100, 3, 2);
  const auto whole = make_small();
  FitSession session;
  ASSERT_TRUE(whole->fit(training, validation, session));
  for (const int stop_at : {0, 3, 4, 9}) {
    Container checkpoint;
    int steps = 0;
    FitSession first;
    first.stop_wanted = [&] { return steps == stop_at; };
    first.step_done = [&](Index, Index, Index, double) { ++steps; };
    first.save_checkpoint = [&](const Container& file) { checkpoint = file; };
    ASSERT_FALSE(make_small()->fit(training, validation, first));
    const auto resumed = make_small();
    FitSession second;
    second.checkpoint = decode(encode(checkpoint), "memory");
    ASSERT_TRUE(resumed->fit(training, validation, second));
    EXPECT_EQ(encode(test::saved(*resumed)), encode(test::saved(*whole)))
        << "stopped at step " << stop_at;
  }
}

/// Odd rows have a target nobody can learn: the loss tells which rows an epoch saw.
TEST(Stride, TakesEveryKthRowAndMovesOnWithTheEpochs) {
  Samples training = moving_average(600, 3, 1);
  Rng rng(5);
  for (Index i = 1; i < 600; i += 2) training.y(i, 0) = rng.uniform() < 0.5 ? -10.0 : 10.0;
  const auto model = make_small({{"stride", 2}, {"standardise_targets", false}});
  FitSession session;
  std::vector<double> losses;
  Index steps_per_epoch = 0;
  session.epoch_done = [&](const EpochRecord& record) { losses.push_back(record.loss); };
  session.step_done = [&](Index, Index, Index steps, double) { steps_per_epoch = steps; };
  ASSERT_TRUE(model->fit(training, {}, session));
  EXPECT_EQ(steps_per_epoch, 6);  // 300 rows in batches of 50
  ASSERT_EQ(losses.size(), 4U);
  for (std::size_t k = 0; k < 4; ++k) {
    const bool even = k % 2 == 0;
    EXPECT_EQ(losses[k] < 5.0, even) << k << ": " << losses[k];
    EXPECT_EQ(losses[k] > 30.0, !even) << k << ": " << losses[k];
  }
}

TEST(Stride, TooLongForTheRecordingIsAnErrorThatSaysSo) {
  const Samples training = moving_average(600, 3, 1);
  FitSession session;
  try {
    make_small({{"stride", 13}})->fit(training, {}, session);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kData);
    EXPECT_NE(std::string(error.what()).find("training.stride"), std::string::npos);
  }
  EXPECT_THROW(make_small({{"stride", 0}}), Error);
  EXPECT_THROW(make_small({{"clip", -1}}), Error);
}

TEST(Clip, ChangesTheTrainingOnlyWhereItActs) {
  const Samples training = moving_average(600, 3, 1);
  const auto weights = [&](double clip) {
    const auto model = make_small({{"clip", clip}, {"epochs", 1}});
    FitSession session;
    model->fit(training, {}, session);
    return encode(test::saved(*model));
  };
  EXPECT_EQ(weights(0.0), weights(1e5));
  EXPECT_NE(weights(0.0), weights(1e-3));
}

TEST(LstmPresets, AreThoseOfTheSpecification) {
  const ModelKind &lstm = model_kind("lstm", Exit::kUsage),
                  &longer = model_kind("lstm-25", Exit::kUsage);
  struct Row {
    const char* preset;
    Index epochs, length, epochs_25;
  };
  for (const Row& row : {Row{"quick", 5, 1, 1}, Row{"standard", 30, 1, 10}, Row{"fair", 60, 25, 60},
                         Row{"paper", 300, 1, 300}}) {
    const Json one = lstm.preset(row.preset, false), many = longer.preset(row.preset, false);
    const bool paper = row.preset == std::string("paper");
    EXPECT_EQ(one["training"]["epochs"], row.epochs) << row.preset;
    EXPECT_EQ(one["model"]["length"], row.length) << row.preset;
    EXPECT_EQ(many["training"]["epochs"], row.epochs_25) << row.preset;
    EXPECT_EQ(many["model"]["length"], 25) << row.preset;
    for (const Json& json : {one, many}) {
      EXPECT_EQ(json["training"]["lr"], paper ? 0.2 : 0.005);
      EXPECT_EQ(json["model"]["init"], paper ? "narrow" : "glorot");
      EXPECT_EQ(json["training"]["standardise_targets"], !paper);
      EXPECT_EQ(json["training"]["clip"], 1.0);
      EXPECT_EQ(json["training"]["batch"], 200);
      EXPECT_EQ(json["model"]["dropout"], 0.5);
    }
  }
  EXPECT_EQ(lstm.preset("paper", true)["training"]["drop_period"], 100);
  EXPECT_EQ(longer.preset("standard", false)["training"]["stride"], 5);
  EXPECT_EQ(lstm.preset("standard", true)["model"]["dropout"], 0.0);
}

}  // namespace
}  // namespace dcnn
