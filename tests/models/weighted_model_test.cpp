// SPDX-License-Identifier: Apache-2.0
// What is added to a simulator is weighted by what validation rows show of it.
#include "models/weighted_model.h"

#include <gtest/gtest.h>

#include "dcnn/core/random.h"
#include "models/support.h"
#include "support/no_allocation.h"

namespace dcnn {
namespace {

constexpr Index kRows = 4000, kBlock = 200;

Eigen::VectorXd wave(double hz) {
  return (2.0 * std::numbers::pi * hz * 0.002 * Eigen::ArrayXd::LinSpaced(kRows, 0.0, kRows - 1.0))
      .sin();
}

Eigen::VectorXd noise(std::uint64_t seed) {
  Rng rng(seed);
  Eigen::VectorXd x(kRows);
  for (double& value : x) value = rng.normal();
  return x;
}

/// Trust in the prediction of one target.
double trust_in(const Eigen::VectorXd& left, const Eigen::VectorXd& predicted) {
  Samples validation;
  validation.x = Eigen::MatrixXd::Zero(kRows, 1);
  validation.y = left;
  return trust(validation, predicted, kBlock)(0);
}

TEST(Trust, IsNearOneInWhatIsThere) {
  EXPECT_GT(trust_in(wave(0.7) + 0.5 * noise(1), wave(0.7)), 0.97);
}

TEST(Trust, IsTheShareThatIsThere) {
  EXPECT_NEAR(trust_in(0.4 * wave(0.7) + 0.1 * noise(2), wave(0.7)), 0.4, 0.02);
}

TEST(Trust, IsAtMostOne) { EXPECT_EQ(trust_in(3.0 * wave(0.7), wave(0.7)), 1.0); }

TEST(Trust, IsZeroInTheOppositeAndInNothing) {
  EXPECT_EQ(trust_in(-wave(0.7), wave(0.7)), 0.0);
  EXPECT_EQ(trust_in(wave(0.7), Eigen::VectorXd::Zero(kRows)), 0.0);
}

TEST(Trust, OfWhatIsUnrelatedIsNextToNothing) {
  double most = 0.0, sum = 0.0;
  for (std::uint64_t k = 0; k < 40; ++k) {
    const double found = trust_in(noise(100 + k), wave(0.7) + 0.3 * noise(200 + k));
    most = std::max(most, found);
    sum += found;
  }
  EXPECT_LT(most, 0.1);
  EXPECT_LT(sum / 40.0, 0.01) << "where blocks disagree nothing is left of it";
}

TEST(Trust, NeedsValidationRows) {
  EXPECT_EQ(trust({}, Eigen::MatrixXd::Zero(0, 2), kBlock), Eigen::Vector2d::Ones());
}

class Weighted : public testing::Test {
 protected:
  Weighted() {
    const Recording recording = test::exact_recording(test::swinging_tool(), "multisine", 400, 3);
    const test::Task task = test::task_of("rigid", recording, "pose");
    stream_.x = task.samples.x;
    plain_ = test::fitted("rigid", task)->predict(stream_);
    model_ = weighted(test::fitted("rigid", task), weights_);
  }
  const Eigen::Vector3d weights_{0.25, 0.0, 1.0};
  Stream stream_;
  Eigen::MatrixXd plain_;
  std::unique_ptr<Model> model_;
};

TEST_F(Weighted, MultipliesEveryPrediction) {
  const Eigen::MatrixXd wanted = plain_ * weights_.asDiagonal();
  EXPECT_EQ(model_->predict(stream_), wanted);
  const auto predictor = model_->predictor();
  Eigen::VectorXd x = stream_.x.row(0).transpose();
  const test::HeapCounter counter;
  double most = 0.0;
  for (Index i = 0; i < stream_.rows(); ++i) {
    x = stream_.x.row(i).transpose();
    most = std::max(most, (predictor->push(x).transpose() - wanted.row(i)).cwiseAbs().maxCoeff());
  }
  EXPECT_LT(most, 1e-9);
  EXPECT_TRUE(!test::HeapCounter::works() || test::HeapCounter::allocations() == 0);
}

TEST_F(Weighted, IsKeptInTheFile) {
  const Container file = test::saved(*model_);
  auto inner = model_kind("rigid", Exit::kModel).load(file, "m.dcnn");
  EXPECT_EQ(with_stored_weights(std::move(inner), 3, file, "m.dcnn")->predict(stream_),
            model_->predict(stream_));
}

TEST_F(Weighted, MalformedWeightsAreAnError) {
  for (const char* text : {"[0.5, 0.5]", "[0.5, 2, 0]", "[-0.1, 0, 0]", "\"one\"", "[", "[null]"}) {
    Container file = test::saved(*model_);
    file.metadata["weights"] = text;
    auto inner = model_kind("rigid", Exit::kModel).load(file, "m.dcnn");
    try {
      with_stored_weights(std::move(inner), 3, file, "m.dcnn");
      ADD_FAILURE() << "accepted: " << text;
    } catch (const Error& error) {
      EXPECT_EQ(error.exit(), Exit::kModel) << text;
      EXPECT_TRUE(std::string(error.what()).starts_with("m.dcnn: ")) << error.what();
    }
  }
}

}  // namespace
}  // namespace dcnn
