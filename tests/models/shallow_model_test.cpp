// SPDX-License-Identifier: Apache-2.0
// The four networks of Levenberg and Marquardt as identifiers.
#include <gtest/gtest.h>

#include "dcnn/core/random.h"
#include "dcnn/models/model.h"
#include "models/support.h"

namespace dcnn {
namespace {

const std::vector<std::pair<std::string, Index>> kShallowKinds{
    {"ffnn-s", 383}, {"ffnn-m", 225}, {"cfnn-s", 428}, {"cfnn-m", 387}};

Samples shallow_samples(Index rows, std::uint64_t seed) {
  Rng rng(seed);
  Samples samples;
  samples.x.resize(rows, 15);
  samples.y.resize(rows, 3);
  for (double& value : samples.x.reshaped()) value = rng.uniform(-2.0, 3.0);
  samples.x.row(0).setConstant(-2.0);  // the least and greatest values are in every part
  samples.x.row(1).setConstant(3.0);
  samples.y.col(0) = 2.0 * samples.x.col(0).array() + 5.0;
  samples.y.col(1) = samples.x.col(3).array().sin();
  samples.y.col(2) = samples.x.col(7).array() * samples.x.col(8).array() / 3.0;
  samples.y.row(0).setConstant(-9.0);
  samples.y.row(1).setConstant(12.0);
  return samples;
}

Problem shallow_problem(const std::string& kind, const Json& patch) {
  Problem result;
  result.layout.names = {"alpha", "beta", "gamma"};
  for (int j = 3; j < 15; ++j) result.layout.names.push_back("rate" + std::to_string(j));
  result.layout.units.assign(15, "");
  result.targets = {{"fx", "fy", "fz"}, {"N", "N", "N"}};
  result.configuration = model_kind(kind, Exit::kUsage).preset("quick", false);
  result.configuration["training"].update({{"epochs", 12}, {"stride", 1}});
  result.configuration["noise"] = {{"levels_db", Json::array({nullptr})}};
  for (const auto& [section, keys] : patch.items()) result.configuration[section].update(keys);
  result.where = "test.json";
  result.seed = 3;
  return result;
}

std::unique_ptr<Model> make_shallow(const std::string& kind, const Json& patch = Json::object()) {
  return model_kind(kind, Exit::kUsage).make(shallow_problem(kind, patch));
}

std::unique_ptr<Model> fitted(const std::string& kind, const Samples& training,
                              const Json& patch = Json::object()) {
  auto model = make_shallow(kind, patch);
  FitSession session;
  EXPECT_TRUE(model->fit(training, {}, session));
  return model;
}

std::string bytes_of(const Model& model) { return encode(test::saved(model)); }

/// The message of the Error with this exit that `act` ends with.
template <class Act>
std::string error_of(Exit exit, const Act& act) {
  try {
    act();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), exit) << error.what();
    return error.what();
  }
  ADD_FAILURE() << "no error";
  return "";
}

TEST(ShallowModel, HasTheParameterCountsOfThePaper) {
  for (const auto& [kind, count] : kShallowKinds)
    EXPECT_EQ(make_shallow(kind)->parameter_count(), count) << kind;
}

TEST(ShallowModel, LearnsASmoothFunctionOfItsInputs) {
  const Samples training = shallow_samples(1000, 1), test = shallow_samples(500, 2);
  for (const auto& [kind, count] : kShallowKinds) {
    const auto model = fitted(kind, training, {{"training", {{"epochs", 25}}}});
    const Eigen::MatrixXd error = (model->predict(test) - test.y).bottomRows(498);
    const Eigen::MatrixXd centred = test.y.bottomRows(498).rowwise() - test.y.colwise().mean();
    EXPECT_LT(error.norm(), 0.3 * centred.norm()) << kind;
  }
}

/// Spec 11: where the target is linear, the cascade's direct path is the least-squares optimum.
TEST(ShallowModel, ReachesTheLeastSquaresOptimumOfALinearTarget) {
  Samples training = shallow_samples(500, 1);
  training.y = training.x * Eigen::MatrixXd::Random(15, 3);
  for (const char* kind : {"cfnn-s", "cfnn-m"}) {
    const auto model = fitted(kind, training, {{"training", {{"epochs", 60}}}});
    EXPECT_LT((model->predict(training) - training.y).cwiseAbs().maxCoeff(), 1e-4) << kind;
  }
}

TEST(ShallowModel, LoadedModelPredictsTheSameBits) {
  const Samples training = shallow_samples(300, 1);
  for (const auto& [kind, count] : kShallowKinds) {
    const auto model = fitted(kind, training);
    const auto loaded =
        model_kind(kind, Exit::kModel).load(decode(bytes_of(*model), "memory"), "memory");
    EXPECT_EQ(loaded->predict(training), model->predict(training));
    EXPECT_EQ(loaded->parameter_count(), count);
    EXPECT_TRUE(bytes_of(*loaded) == bytes_of(*model));
  }
}

TEST(ShallowModel, OneRowPredictsWhatItPredictsAmongOthers) {
  const Samples training = shallow_samples(300, 1);
  const auto model = fitted("cfnn-m", training);
  const Eigen::MatrixXd all = model->predict(training);
  for (const Index row : {0, 12, 13, 150, 299}) {
    EXPECT_EQ(model->predict({training.x.row(row), {}}), all.row(row)) << row;
  }
}

TEST(ShallowModel, KeepsTheEpochWithTheLeastLossOnItsValidationRows) {
  Samples training = shallow_samples(260, 1);
  Rng rng(9);
  for (double& value : training.y.reshaped()) value += rng.normal();  // to be overfitted
  const auto model = make_shallow("ffnn-s", {{"training", {{"epochs", 30}}}});
  FitSession session;
  Eigen::MatrixXd of_best;
  Index best = 0, last = 0;
  session.epoch_done = [&](const EpochRecord& record) {
    last = record.epoch;
    if (!record.best) return;
    best = record.epoch;
    of_best = model->predict(training);
  };
  ASSERT_TRUE(model->fit(training, {}, session));
  EXPECT_EQ(last, best + 6) << "six epochs without a better one";
  EXPECT_EQ(model->predict(training), of_best);
}

TEST(ShallowModel, GoesOnFromAnyEpochToTheSameWeights) {
  const Samples training = shallow_samples(400, 1), validation = shallow_samples(100, 2);
  const Json patch = {{"noise", {{"levels_db", {nullptr, 20.0}}}}};
  const auto whole = make_shallow("ffnn-m", patch);
  FitSession session;
  std::vector<EpochRecord> records;
  session.epoch_done = [&](const EpochRecord& record) { records.push_back(record); };
  ASSERT_TRUE(whole->fit(training, validation, session));
  for (const std::size_t stop_at : {std::size_t{0}, std::size_t{1}, records.size() - 1}) {
    Container checkpoint;
    std::size_t steps = 0;
    FitSession first;
    first.stop_wanted = [&] { return steps == stop_at; };
    first.step_done = [&](Index, Index, Index, double) { ++steps; };
    first.save_checkpoint = [&](const Container& file) { checkpoint = file; };
    ASSERT_FALSE(make_shallow("ffnn-m", patch)->fit(training, validation, first));

    const auto resumed = make_shallow("ffnn-m", patch);
    FitSession second;
    second.checkpoint = decode(encode(checkpoint), "memory");
    second.epoch_done = [&](const EpochRecord& record) {
      const EpochRecord& expected = records.at(static_cast<std::size_t>(record.epoch) - 1);
      EXPECT_EQ(record.loss, expected.loss);
      EXPECT_EQ(record.validation_rmse, expected.validation_rmse);
      EXPECT_EQ(record.best, expected.best);
    };
    ASSERT_TRUE(resumed->fit(training, validation, second));
    EXPECT_TRUE(bytes_of(*resumed) == bytes_of(*whole)) << "stopped after " << stop_at;
  }
}

TEST(ShallowModel, ConstantInputsAreLeftOut) {
  Samples training = shallow_samples(300, 1);
  training.x.col(4).setConstant(0.7);
  training.x.col(9).setConstant(1e-9);
  const auto model = fitted("ffnn-s", training);
  EXPECT_EQ(model->parameter_count(), 383 - 2 * 20);
  const auto loaded = model_kind("ffnn-s", Exit::kModel).load(test::saved(*model), "memory");
  Samples moved = training;
  moved.x.col(4).array() += 1.0;
  EXPECT_EQ(loaded->predict(moved), model->predict(training));

  training.x.setOnes();
  EXPECT_NE(error_of(Exit::kData, [&] { fitted("ffnn-s", training); }).find("constant"),
            std::string::npos);
}

/// Spec 2.3: 15 % of the rows are neither trained on nor looked at; in blocks they are the last.
TEST(ShallowModel, UnusedRowsAreNotLookedAt) {
  const Samples training = shallow_samples(200, 1);
  Samples changed = training;
  changed.y.bottomRows(30).setZero();
  const Json blocks = {{"training", {{"division", "blocks"}}}};
  EXPECT_TRUE(bytes_of(*fitted("ffnn-m", training, blocks)) ==
              bytes_of(*fitted("ffnn-m", changed, blocks)));
  EXPECT_FALSE(bytes_of(*fitted("ffnn-m", training)) == bytes_of(*fitted("ffnn-m", changed)));
  changed.y.row(139).setZero();  // the last one trained on
  EXPECT_FALSE(bytes_of(*fitted("ffnn-m", training, blocks)) ==
               bytes_of(*fitted("ffnn-m", changed, blocks)));
}

/// As the networks of Adam: all training rows, and the run's own validation rows to stop by.
TEST(ShallowModel, HeldOutRowsMayDecideTheStop) {
  Samples training = shallow_samples(200, 1), validation = shallow_samples(60, 2);
  const Json held_out = {{"training", {{"division", "held-out"}, {"epochs", 40}}}};
  const auto trained = [&](const Samples& rows) {
    const auto model = make_shallow("ffnn-m", held_out);
    FitSession session;
    std::vector<double> least;
    session.epoch_done = [&](const EpochRecord& record) {
      const auto mean_square = [](const std::vector<double>& rmse) {
        double sum = 0.0;
        for (const double value : rmse) sum += value * value;
        return sum;
      };
      if (least.empty() || mean_square(record.validation_rmse) < mean_square(least)) {
        least = record.validation_rmse;
        EXPECT_TRUE(record.best) << record.epoch;
      }
    };
    EXPECT_TRUE(model->fit(rows, validation, session));
    return bytes_of(*model);
  };
  const std::string before = trained(training);
  training.y.row(199).setZero();
  EXPECT_FALSE(before == trained(training)) << "the last row is trained on";
  EXPECT_NE(error_of(Exit::kUsage, [&] { fitted("ffnn-m", training, held_out); })
                .find("training.validation"),
            std::string::npos);
}

TEST(ShallowModel, StrideTakesEverySoManythRow) {
  const Samples training = shallow_samples(400, 1);
  Samples changed = training;
  for (Index row = 2; row < 400; ++row) {
    if (row % 4 != 0) changed.y.row(row).setZero();
  }
  const Json stride = {{"training", {{"stride", 4}}}};
  EXPECT_TRUE(bytes_of(*fitted("ffnn-m", training, stride)) ==
              bytes_of(*fitted("ffnn-m", changed, stride)));
  EXPECT_NE(error_of(Exit::kData,
                     [&] {
                       fitted("ffnn-m", training, {{"training", {{"stride", 40}}}});
                     })
                .find("training.stride"),
            std::string::npos);
}

TEST(ShallowModel, InputsAreChosenByNameOrByNetworkInput) {
  const auto count = [](const Json& model) {
    return make_shallow("ffnn-s", {{"model", model}})->parameter_count();
  };
  EXPECT_EQ(count({{"inputs", "angles"}}), 4 * 20 + 63);
  EXPECT_EQ(count({{"inputs", {"gamma", "rate5"}}}), 3 * 20 + 63);
  EXPECT_EQ(count({{"input", {{"kind", "window"}, {"length", 2}}}}), 31 * 20 + 63);
  EXPECT_NE(error_of(Exit::kUsage,
                     [&] {
                       count({{"inputs", Json::array({"gama"})}});
                     })
                .find("'gamma'"),
            std::string::npos);
  error_of(Exit::kUsage, [&] { count({{"inputs", "angle"}}); });
  error_of(Exit::kUsage, [&] { count({{"inputs", Json::array()}}); });
  error_of(Exit::kUsage, [&] { count({{"inputs", {"gamma", "gamma"}}}); });
  error_of(Exit::kUsage, [&] { count({{"hidden", Json::array()}}); });
  error_of(Exit::kUsage, [&] { count({{"hidden", Json::array({0})}}); });
  error_of(Exit::kUsage, [&] { count({{"hidden", Json::array({900})}}); });
  error_of(Exit::kUsage, [&] { count({{"hiden", Json::array({9})}}); });

  Samples training = shallow_samples(300, 1), moved = training;
  moved.x.rightCols(12).array() += 1.0;
  const auto angles = fitted("ffnn-s", training, {{"model", {{"inputs", "angles"}}}});
  EXPECT_EQ(angles->predict(moved), angles->predict(training));
  const auto window =
      fitted("ffnn-s", training, {{"model", {{"input", {{"kind", "window"}, {"length", 2}}}}}});
  const auto loaded = model_kind("ffnn-s", Exit::kModel).load(test::saved(*window), "memory");
  EXPECT_EQ(loaded->predict(training), window->predict(training));
}

TEST(ShallowModel, StatisticsComeFromTheTrainingRowsAlone) {
  const Samples training = shallow_samples(300, 1);
  Samples validation = shallow_samples(100, 2);
  const auto first = make_shallow("cfnn-s"), second = make_shallow("cfnn-s");
  FitSession session;
  first->fit(training, validation, session);
  validation.x *= 3.0;
  second->fit(training, validation, session);
  EXPECT_TRUE(bytes_of(*first) == bytes_of(*second));
}

/// With errors in the targets' own units one in millinewtons among newtons is not learned.
TEST(ShallowModel, TargetsMayBeWeighedByTheirSpread) {
  Samples training = shallow_samples(600, 1);
  training.y.col(1) *= 1e-4;
  const auto relative_error = [&](bool standardise) {
    const auto model =
        fitted("ffnn-m", training, {{"training", {{"standardise_targets", standardise}}}});
    return (model->predict(training) - training.y).col(1).norm() / training.y.col(1).norm();
  };
  EXPECT_LT(relative_error(true), 0.5 * relative_error(false));
}

TEST(ShallowModel, BrokenFilesAreRefused) {
  const auto model = fitted("cfnn-m", shallow_samples(100, 1));
  const Container good = test::saved(*model);
  const auto load = [](const Container& file) {
    model_kind("cfnn-m", Exit::kModel).load(file, "broken.dcnn");
  };
  load(good);
  for (std::size_t i = 0; i < good.tensors.size(); ++i) {
    SCOPED_TRACE(good.tensors[i].name);
    Container file = good;
    file.tensors.erase(file.tensors.begin() + static_cast<std::ptrdiff_t>(i));
    error_of(Exit::kModel, [&] { load(file); });
    file = good;
    std::visit([](auto& values) { values.pop_back(); }, file.tensors[i].values);
    file.tensors[i].shape = {static_cast<Index>(
        std::visit([](const auto& values) { return values.size(); }, file.tensors[i].values))};
    error_of(Exit::kModel, [&] { load(file); });
    file = good;
    file.tensors[i].values = std::vector<float>{1.0F};
    error_of(Exit::kModel, [&] { load(file); });
  }
  for (const char* key : {"map", "input", "architecture"}) {
    for (const char* text : {"", "3", "[{}]", "{\"hidden\":[1000,1000],\"cascade\":true}"}) {
      Container file = good;
      file.metadata[key] = text;
      error_of(Exit::kModel, [&] { load(file); });
    }
    Container file = good;
    file.metadata.erase(key);
    error_of(Exit::kModel, [&] { load(file); });
  }
  for (const auto& columns : {std::vector<std::int64_t>{-1, 1}, {1, 1}, {0, 15}, {}}) {
    Container file = good;
    for (StoredTensor& tensor : file.tensors) {
      if (tensor.name == "input_columns") tensor.values = columns;
    }
    error_of(Exit::kModel, [&] { load(file); });
  }
}

TEST(ShallowModel, PresetsAreThoseOfTheSpecification) {
  for (const auto& [name, count] : kShallowKinds) {
    const ModelKind& kind = model_kind(name, Exit::kUsage);
    EXPECT_EQ(kind.preset("quick", false)["training"]["epochs"], 30);
    EXPECT_EQ(kind.preset("quick", false)["training"]["stride"], 8);
    EXPECT_EQ(kind.preset("standard", false)["training"]["epochs"], 200);
    EXPECT_EQ(kind.preset("standard", false)["training"]["division"], "random");
    EXPECT_EQ(kind.preset("fair", false)["training"]["epochs"], 1000);
    EXPECT_EQ(kind.preset("fair", false)["training"]["division"], "held-out");
    EXPECT_EQ(kind.preset("paper", false)["training"]["division"], "random");
    EXPECT_EQ(kind.preset("paper", false)["training"]["validation"], 0.0);
    EXPECT_EQ(kind.preset("standard", true)["training"]["standardise_targets"], true);
  }
}

}  // namespace
}  // namespace dcnn
