// SPDX-License-Identifier: Apache-2.0
// What every kind of model in models.def must do, on one small problem.
#include <gtest/gtest.h>

#include "support.h"

namespace dcnn {
namespace {

constexpr Index kTraining = 500, kValidation = 100;

class EveryModel : public testing::TestWithParam<const ModelKind*> {
 protected:
  EveryModel() : kind_(*GetParam()) {
    const ToolModel tool = test::swinging_tool();
    task_ =
        test::task_of(kind_.name, test::exact_recording(tool, "multisine", kTraining, 3), "pose");
    Json& json = task_.problem.configuration;
    json["noise"] = {{"levels_db", {nullptr, 20}}};
    if (json["training"].contains("epochs")) json["training"]["epochs"] = 2;
    if (json["training"].contains("batch")) json["training"]["batch"] = 50;
    validation_ =
        test::samples_of(test::exact_recording(tool, "multisine", kValidation, 4), task_.problem);
  }

  std::unique_ptr<Model> fitted(FitSession session = {}) const {
    auto model = kind_.make(task_.problem);
    EXPECT_TRUE(model->fit(task_.samples, validation_, session));
    return model;
  }

  std::unique_ptr<Model> loaded(const Container& file) const {
    return kind_.load(decode(encode(file), "m.dcnn"), "m.dcnn");
  }

  /// The changed file is refused as a model, or was changed to no effect.
  void expect_refused(const Container& file, const std::string& change) const {
    try {
      loaded(file);
      ADD_FAILURE() << "accepted: " << change;
    } catch (const Error& error) {
      EXPECT_EQ(error.exit(), Exit::kModel) << change << ": " << error.what();
      EXPECT_EQ(std::string(error.what()).find("m.dcnn: "), 0u) << change << ": " << error.what();
    } catch (const std::exception& error) {
      ADD_FAILURE() << change << ": not an error for the user: " << error.what();
    }
  }

  const ModelKind& kind_;
  test::Task task_;
  Samples validation_;
};

TEST_P(EveryModel, LoadedModelPredictsTheSameBits) {
  const auto model = fitted();
  const Eigen::MatrixXd predicted = model->predict(validation_);
  EXPECT_EQ(predicted.rows(), kValidation);
  EXPECT_EQ(predicted.cols(), 3);
  EXPECT_TRUE(predicted.allFinite());
  const Container file = test::saved(*model);
  EXPECT_EQ(file.metadata.at("model"), kind_.name);
  const auto copy = loaded(file);
  EXPECT_EQ(copy->predict(validation_), predicted);
  EXPECT_EQ(copy->parameter_count(), model->parameter_count());
  EXPECT_EQ(copy->map().mean(), model->map().mean());
  EXPECT_EQ(encode(test::saved(*copy)), encode(file)) << "saved again";
}

TEST_P(EveryModel, SameSeedGivesTheSameBytes) {
  EXPECT_EQ(encode(test::saved(*fitted())), encode(test::saved(*fitted())));
}

TEST_P(EveryModel, StatisticsAreThoseOfTheCleanTrainingRows) {
  const auto model = fitted();
  ASSERT_EQ(model->map().features(), task_.problem.features());
  EXPECT_TRUE(model->map().mean().isApprox(task_.samples.x.colwise().mean().transpose(), 1e-12));
}

TEST_P(EveryModel, ReportsItsValidationErrorInTheUnitsOfTheTargets) {
  Index epochs = 0, best = 0;
  FitSession session;
  session.epoch_done = [&](const EpochRecord& record) {
    EXPECT_EQ(record.epoch, ++epochs);
    EXPECT_TRUE(std::isfinite(record.loss));
    ASSERT_EQ(record.validation_rmse.size(), 3u);
    for (const double value : record.validation_rmse) EXPECT_TRUE(std::isfinite(value));
    best += record.best ? 1 : 0;
  };
  fitted(session);
  EXPECT_GE(epochs, 1);
  EXPECT_GE(best, 1);
}

TEST_P(EveryModel, StopsWhenAsked) {
  FitSession session;
  session.stop_wanted = [] { return true; };
  EXPECT_FALSE(kind_.make(task_.problem)->fit(task_.samples, validation_, session));
}

TEST_P(EveryModel, RefusesKeysThatItDoesNotKnow) {
  for (const char* section : {"model", "training", "noise", "map"}) {
    test::Task wrong = task_;
    wrong.problem.configuration[section]["dropuot"] = 1;
    try {
      kind_.make(wrong.problem);
      ADD_FAILURE() << section;
    } catch (const Error& error) {
      EXPECT_EQ(error.exit(), Exit::kUsage) << error.what();
    }
  }
}

TEST_P(EveryModel, RefusesFilesOfWhichAPartIsMissingOrAnother) {
  const Container whole = test::saved(*fitted());
  for (std::size_t k = 0; k < whole.tensors.size(); ++k) {
    const std::string name = whole.tensors[k].name;
    Container file = whole;
    file.tensors.erase(file.tensors.begin() + static_cast<std::ptrdiff_t>(k));
    expect_refused(file, "without " + name);
    file = whole;
    StoredTensor& longer = file.tensors[k];
    Index size = 0;
    std::visit(
        [&](auto& values) {
          values.push_back(1);
          size = static_cast<Index>(values.size());
        },
        longer.values);
    longer.shape = {size};
    expect_refused(file, "one number more in " + name);
    file = whole;
    file.tensors[k].shape = {0};
    std::visit([](auto& values) { values.clear(); }, file.tensors[k].values);
    expect_refused(file, "no number in " + name);
  }
  for (const auto& [key, text] : whole.metadata) {
    if (key == "model") continue;  // by which the kind was found
    Container file = whole;
    file.metadata.erase(key);
    expect_refused(file, "without " + key);
    for (const char* nonsense : {"", "{}", "[]", "null", "1e999", "words"}) {
      if (text == nonsense) continue;
      file.metadata[key] = nonsense;
      expect_refused(file, key + " = " + nonsense);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, EveryModel, testing::ValuesIn(model_kinds()),
                         [](const auto& entry) {
                           std::string name = entry.param->name;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace dcnn
