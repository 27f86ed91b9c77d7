// SPDX-License-Identifier: Apache-2.0
// What runs online predicts what Model::predict() does, row by row and without the heap.
#include "dcnn/models/predictor.h"

#include <gtest/gtest.h>

#include "models/support.h"
#include "support/no_allocation.h"

namespace dcnn {
namespace {

/// A kind with some of its options.
struct Case {
  std::string name, kind;
  Json model = Json::object();
  double tolerance = 1e-5;  // relative; 1e-9 for what is double throughout
  Precision precision = Precision::kSingle;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  for (const ModelKind* kind : model_kinds()) {
    const std::string name = kind->name;
    const bool single = name == "mlp" || name.starts_with("lstm") || name.starts_with("dcnn") ||
                        name.starts_with("ffnn");
    all.push_back({name, name, Json::object(), single ? 1e-5 : 1e-9});
  }
  all.push_back({"cf_fourier", "cf", {{"form", "fourier"}}, 1e-9});
  all.push_back({"rigid_filtered", "rigid", {{"filter_s", 0.05}}, 1e-9});
  all.push_back({"dcnn_valid", "dcnn", {{"padding", "valid"}}});
  all.push_back({"dcnn_int16", "dcnn", {{"padding", "valid"}}, 1e-3, Precision::kInt16});
  all.push_back({"dcnn_other", "dcnn", {{"filters", {3, 20}}, {"padding", "valid"}}});
  all.push_back({"dcnn_t_linear", "dcnn-t", {{"body", "none"}}});
  all.push_back({"dcnn_t_fixed", "dcnn-t", {{"input", {{"kind", "lines"}, {"adaptive", false}}}}});
  all.push_back({"frame_tcn_dense", "frame-tcn", {{"front", "dense"}}, 1e-9});
  all.push_back({"dcnn_plus_hidden", "dcnn-plus", {{"body", "hidden"}}});
  all.push_back({"ffnn_s_angles", "ffnn-s", {{"inputs", "angles"}}});
  all.push_back({"ffnn_m_lines", "ffnn-m", {{"input", {{"kind", "lines"}}}}});
  return all;
}

class EveryPredictor : public testing::TestWithParam<Case> {
 protected:
  EveryPredictor() {
    const ToolModel tool = test::swinging_tool();
    task_ = test::task_of(GetParam().kind, test::exact_recording(tool, "multisine", kTraining, 3),
                          "pose", {{"model", GetParam().model}});
    Json& training = task_.problem.configuration["training"];
    if (training.contains("epochs")) training["epochs"] = 2;
    if (training.contains("batch")) training["batch"] = 50;
    model_ = test::fitted(GetParam().kind, task_);
    if (GetParam().precision != Precision::kSingle) model_->set_precision(GetParam().precision);
    // Two segments, the second long enough for the longest filter.
    const Samples other =
        test::samples_of(test::exact_recording(tool, "multisine", kRows, 4), task_.problem);
    stream_.x = other.x;
    stream_.segments = {{0, kFirst}, {kFirst, kRows}};
  }

  static constexpr Index kTraining = 700, kFirst = 90, kRows = 700;
  test::Task task_;
  std::unique_ptr<Model> model_;
  Stream stream_;
};

TEST_P(EveryPredictor, GivesWhatTheModelPredicts) {
  const Eigen::MatrixXd wanted = model_->predict(stream_);
  const double unit = std::max(1.0, wanted.cwiseAbs().maxCoeff());
  const auto predictor = model_->predictor();
  model_.reset();  // it holds all it needs
  Eigen::VectorXd x(stream_.x.cols());
  double most = 0.0;
  for (Index i = 0; i < stream_.rows(); ++i) {
    if (i == kFirst) predictor->reset();
    x = stream_.x.row(i).transpose();
    const Eigen::VectorXd& y = predictor->push(x);
    ASSERT_EQ(y.size(), wanted.cols());
    ASSERT_TRUE(y.allFinite()) << "row " << i;
    most = std::max(most, (y.transpose() - wanted.row(i)).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(most, GetParam().tolerance * unit);
}

TEST_P(EveryPredictor, ResetForgetsToTheLastBit) {
  const auto predictor = model_->predictor(), fresh = model_->predictor();
  for (Index i = 0; i < 600; ++i) predictor->push(stream_.x.row(i).transpose());
  predictor->reset();
  for (Index i = 0; i < 40; ++i) {
    const Eigen::VectorXd x = stream_.x.row(i).transpose();
    ASSERT_EQ(predictor->push(x), fresh->push(x)) << "row " << i;
  }
}

TEST_P(EveryPredictor, NeitherAllocatesNorLocks) {
  if (!test::HeapCounter::works()) GTEST_SKIP() << "the heap has other functions here";
  const auto predictor = model_->predictor();
  const Eigen::MatrixXd rows = stream_.x.transpose();
  Eigen::VectorXd x = rows.col(0);
  const test::HeapCounter counter;
  for (Index i = 0; i < rows.cols(); ++i) {
    if (i == kFirst) predictor->reset();
    x = rows.col(i);
    predictor->push(x);
  }
  EXPECT_EQ(test::HeapCounter::allocations(), 0);
  EXPECT_EQ(test::HeapCounter::locks(), 0);
}

INSTANTIATE_TEST_SUITE_P(Models, EveryPredictor, testing::ValuesIn(cases()), [](const auto& entry) {
  std::string name = entry.param.name;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

}  // namespace
}  // namespace dcnn
