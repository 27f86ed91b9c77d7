// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "dcnn/core/random.h"
#include "dcnn/models/network_model.h"

namespace dcnn {
namespace {

/// A wrist that turns and moves slowly, with a force that is linear in its channels and has a knee.
Samples draw_samples(Index rows, std::uint64_t seed) {
  Rng rng(seed);
  Samples samples;
  samples.x.resize(rows, 15);
  samples.y.resize(rows, 3);
  Eigen::ArrayXd phase(15), rate(15);
  for (Index j = 0; j < 15; ++j) {
    phase[j] = rng.uniform(0.0, 6.0);
    rate[j] = rng.uniform(0.005, 0.02);
  }
  for (Index i = 0; i < rows; ++i) {
    samples.x.row(i) = (phase + rate * static_cast<double>(i)).sin().matrix().transpose();
    const auto x = samples.x.row(i);
    samples.y.row(i) << x[3] + std::tanh(8.0 * x[4]), 2.0 * x[10] - x[0], x[11] * x[7];
  }
  samples.segments = {{0, rows / 3}, {rows / 3, rows}};
  return samples;
}

Problem problem(const std::string& kind, const Json& patch, bool body_set = true) {
  Json configuration = model_kind(kind, Exit::kUsage).preset("quick", false);
  configuration["training"]["batch"] = 50;
  for (const auto& [section, keys] : patch.items()) configuration[section].update(keys);
  Problem result;
  result.layout.names = {"alpha",  "beta", "gamma", "vx", "vy",      "vz",     "dalpha", "dbeta",
                         "dgamma", "ax",   "ay",    "az", "ddalpha", "ddbeta", "ddgamma"};
  result.layout.spec.set = body_set ? FeatureSpec::Set::kBody : FeatureSpec::Set::kPose;
  result.layout.units.assign(15, "");
  result.layout.dt = 0.002;
  result.targets = {{"fx", "fy", "fz"}, {"N", "N", "N"}};
  result.configuration = configuration;
  result.where = "test";
  result.seed = 1;
  return result;
}

std::unique_ptr<Model> make(const std::string& kind, const Json& patch = Json::object(),
                            bool body_set = true) {
  return model_kind(kind, Exit::kUsage).make(problem(kind, patch, body_set));
}

std::unique_ptr<Model> trained(const std::string& kind, const Samples& training,
                               const Json& patch = Json::object(), bool body_set = true) {
  auto model = make(kind, patch, body_set);
  FitSession session;
  EXPECT_TRUE(model->fit(training, {}, session));
  return model;
}

std::string bytes(const Model& model) {
  Container file;
  model.save(file);
  return encode(file);
}

double rmse(const Model& model, const Samples& samples) {
  return std::sqrt((model.predict(samples) - samples.y).array().square().mean());
}

const char* const kKinds[] = {"dcnn-plus", "dcnn-t"};
const Json kClean = {{"noise", {{"levels_db", Json::array({nullptr})}}}};

TEST(DcnnPlus, LinearPartIsRidgeRegressionOnTheEntries) {
  const Samples training = draw_samples(900, 1);
  const Json patch = {{"noise", {{"levels_db", Json::array({nullptr})}}},
                      {"model", {{"body", "none"}}}};
  const auto model = trained("dcnn-plus", training, patch);
  // The same entries from their definition, without the shared code.
  const Index n = training.rows();
  Eigen::MatrixXd a(n, 76);
  a.col(0).setOnes();
  for (Index j = 0; j < 15; ++j) {
    const Eigen::ArrayXd x = training.x.col(j);
    const double sd = std::sqrt((x - x.mean()).square().sum() / static_cast<double>(n - 1));
    const Eigen::ArrayXd entries[] = {x, x, x, (x / (0.08 * sd)).tanh(), x.square()};
    for (Index c = 0; c < 5; ++c) {
      const Eigen::ArrayXd& e = entries[c];
      double own = std::sqrt((e - e.mean()).square().sum() / static_cast<double>(n - 1));
      if (c == 3) own = std::max(own, 0.3);
      a.col(1 + 5 * j + c) = ((e - e.mean()) / own).cwiseMax(-5.0).cwiseMin(5.0);
    }
  }
  Eigen::MatrixXd normal = a.transpose() * a;
  normal.diagonal().tail(75).array() += 1e-4 * static_cast<double>(n);
  const Eigen::MatrixXd expected = a * normal.ldlt().solve(a.transpose() * training.y);
  EXPECT_LT((model->predict(training) - expected).cwiseAbs().maxCoeff(), 1e-4);
  EXPECT_EQ(model->parameter_count(), 76 * 3);
}

TEST(DcnnPlus, LearnsWhatTheLinearPartLeaves) {
  const Samples training = draw_samples(3000, 1);
  Json patch = kClean;
  patch["training"] = {{"epochs", 6}};
  patch["model"] = {{"dropout", 0.0}};
  const auto whole = trained("dcnn-plus", training, patch);
  patch["model"] = {{"body", "none"}};
  EXPECT_LT(rmse(*whole, training), 0.8 * rmse(*trained("dcnn-plus", training, patch), training));
}

TEST(DcnnPlus, TrainedWithNoiseOnThePoseHalfOfWhatTheConvolutionsSayCounts) {
  Samples training = draw_samples(600, 1);
  training.pose_noise = {draw_samples(600, 2).x};
  const auto predicted = [&](const char* body, const Json& more) {
    Json patch = {{"noise", {{"on", "pose"}}}, {"model", {{"body", body}}}};
    patch.update(more);
    return trained("dcnn-t", training, patch)->predict(training);
  };
  const Eigen::MatrixXd linear = predicted("none", Json::object());
  const Eigen::MatrixXd own = predicted("convolutions", Json::object()) - linear;
  const Eigen::MatrixXd whole =
      predicted("convolutions", {{"training", {{"shrink", 1.0}}}}) - linear;
  EXPECT_GT(own.norm(), 0.0);
  EXPECT_LT((own - 0.5 * whole).norm(), 1e-5 * whole.norm());
}

TEST(DcnnPlus, LoadedModelPredictsTheSameBits) {
  const Samples training = draw_samples(600, 1);
  for (const char* kind : kKinds) {
    for (const char* body : {"convolutions", "hidden", "none"}) {
      const auto model = trained(kind, training, {{"model", {{"body", body}}}}, false);
      const auto loaded =
          model_kind(kind, Exit::kModel).load(decode(bytes(*model), "memory"), "memory");
      EXPECT_EQ(loaded->predict(training), model->predict(training)) << kind << " " << body;
    }
  }
}

TEST(DcnnPlus, NoRowKnowsItsFutureOrAnotherSegment) {
  const Samples training = draw_samples(600, 1);
  for (const char* kind : kKinds) {
    const auto model = trained(kind, training, Json::object(), false);
    const Eigen::MatrixXd all = model->predict(training);
    const Stream prefix{training.x.topRows(150), {{0, 150}}};
    EXPECT_EQ(model->predict(prefix), all.topRows(150)) << kind;
    const Stream second{training.x.bottomRows(400), {{0, 400}}};
    EXPECT_EQ(model->predict(second), all.bottomRows(400)) << kind;
  }
}

TEST(DcnnPlus, OnlyLinesLookBack) {
  const Samples training = draw_samples(600, 1);
  const Stream alone{training.x.row(100), {}};
  const auto plus = trained("dcnn-plus", training), t = trained("dcnn-t", training);
  EXPECT_EQ(plus->predict(alone), plus->predict(training).row(100));
  EXPECT_NE(t->predict(alone), t->predict(training).row(100));
}

TEST(DcnnPlus, GoesOnFromAnyStepToTheSameBytes) {
  const Samples training = draw_samples(600, 1);
  const std::string whole = bytes(*trained("dcnn-t", training));
  for (const int stop_at : {0, 7, 12, 20}) {
    Container checkpoint;
    int steps = 0;
    FitSession first;
    first.stop_wanted = [&] { return steps == stop_at; };
    first.step_done = [&](Index, Index, Index, double) { ++steps; };
    first.save_checkpoint = [&](const Container& file) { checkpoint = file; };
    ASSERT_FALSE(make("dcnn-t")->fit(training, {}, first));
    const auto resumed = make("dcnn-t");
    FitSession second;
    second.checkpoint = decode(encode(checkpoint), "memory");
    ASSERT_TRUE(resumed->fit(training, {}, second));
    EXPECT_EQ(bytes(*resumed), whole) << "stopped at step " << stop_at;
  }
}

TEST(DcnnPlus, ExtremeInputsStayBounded) {
  const Samples training = draw_samples(600, 1);
  for (const char* kind : kKinds) {
    const auto model = trained(kind, training);
    const double usual = model->predict(training).cwiseAbs().maxCoeff();
    EXPECT_LT(model->predict({1e6 * training.x, training.segments}).cwiseAbs().maxCoeff(),
              100.0 * usual);
  }
}

/// The features hold still while the angles carry noise: fitted after the turn, the mean of the
/// turned vertical would be short by half the noise's variance at any window.
TEST(DcnnPlus, LinesAreFittedBeforeTheTurn) {
  const Samples training = draw_samples(900, 1);
  Json patch = kClean;
  patch["model"] = {{"body", "none"},
                    {"input", {{"kind", "lines"}, {"windows_s", {0.6, 0.8, 1.0}}}}};
  const auto model = trained("dcnn-t", training, patch, false);
  EXPECT_EQ(model->parameter_count(), (1 + 15 * 5) * 3);
  Stream still{training.x.row(200).replicate(800, 1), {{0, 800}}};
  const Eigen::RowVectorXd wanted = model->predict(still).row(799);
  for (Index i = 0; i < 800; ++i) still.x(i, 0) += i % 2 == 0 ? 0.8 : -0.8;
  still.x(0, 0) -= 0.8;  // its row stands for those before the segment
  EXPECT_LT((model->predict(still).row(799) - wanted).cwiseAbs().maxCoeff(), 0.1);
}

TEST(DcnnPlus, WindowsAreThreeToTwelve) {
  for (const std::size_t count : {2, 13}) {
    const std::vector<double> windows(count, 0.1);
    const Json input = {{"kind", "lines"}, {"windows_s", windows}};
    EXPECT_THROW(make("dcnn-t", {{"model", {{"input", input}}}}), Error) << count;
  }
}

/// Of two levels the clean one is to be fitted nearly as well as if it stood alone.
TEST(DcnnPlus, QuietLevelsWeighMore) {
  const Samples training = draw_samples(2000, 1);
  Json patch = {{"noise", {{"levels_db", {nullptr, 0.0}}}}, {"model", {{"body", "none"}}}};
  const double mixed = rmse(*trained("dcnn-t", training, patch), training);
  patch["noise"]["levels_db"] = Json::array({nullptr});
  const double clean = rmse(*trained("dcnn-t", training, patch), training);
  patch["noise"]["levels_db"] = {0.0};
  const double loud = rmse(*trained("dcnn-t", training, patch), training);
  EXPECT_LT(mixed, 0.5 * (clean + loud));
}

TEST(DcnnPlus, LinesNeedAClock) {
  Problem p = problem("dcnn-t", Json::object());
  p.layout.dt = 0.0;
  EXPECT_THROW(model_kind("dcnn-t", Exit::kUsage).make(p), Error);
}

TEST(NoisyBlocks, EveryBlockHasOneLevelOfItsOwn) {
  Samples samples = draw_samples(1200, 1);
  samples.segments = {{0, 450}, {450, 1200}};
  NoiseSpec spec;
  spec.levels = {std::nullopt, 0.0};
  spec.block_rows = 100;
  const InputMap map(samples.x, {});
  const Eigen::MatrixXd added = noisy_blocks(samples, spec, map, 5).x - samples.x;
  int noisy_rows = 0;
  for (const Index begin : {0, 100, 200, 300, 450, 550, 650, 750, 850, 950, 1050}) {
    const bool loud = !added.row(begin).isZero(0.0);
    for (Index i = begin; i < begin + 100; ++i) {
      EXPECT_EQ(!added.row(i).isZero(0.0), loud) << i;
    }
    noisy_rows += loud ? 1 : 0;
  }
  EXPECT_GT(noisy_rows, 0);
  EXPECT_LT(noisy_rows, 11);
}

}  // namespace
}  // namespace dcnn
