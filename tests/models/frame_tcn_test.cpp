// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "models/frame_tcn/material.h"
#include "models/frame_tcn/model.h"

namespace dcnn::frame_tcn {
namespace {

struct Tone {
  double hz, size;
};

/// Sines of several frequencies per coordinate, with their exact rates, and a made-up tool's force.
Samples draw_tones(Index rows, int tones, std::uint64_t seed,
                   const std::function<Tone(int, Rng&)>& tone) {
  Rng rng(seed);
  Samples s;
  s.x = Eigen::MatrixXd::Zero(rows, kChannels);
  s.segments = {{0, rows / 2}, {rows / 2, rows}};
  for (Index j = 0; j < 6; ++j) {
    const Index value = j < 3 ? j : -1, rate = j < 3 ? 6 + j : j, second = j < 3 ? 12 + j : 6 + j;
    for (int k = 0; k < tones; ++k) {
      const auto [hz, size] = tone(k, rng);
      const double w = 6.283 * hz, phase = rng.uniform(0.0, 6.283);
      for (Index i = 0; i < rows; ++i) {
        const double angle = w * 0.002 * static_cast<double>(i) + phase;
        if (value >= 0) s.x(i, value) += size * std::sin(angle);
        s.x(i, rate) += size * w * std::cos(angle);
        s.x(i, second) -= size * w * w * std::sin(angle);
      }
    }
  }
  s.y.resize(rows, 3);
  for (Index i = 0; i < rows; ++i) {
    const Frame f(s.x.row(i).transpose(), Eigen::Matrix3d::Identity());
    const Eigen::Vector3d world =
        Eigen::Vector3d(0, 0, -5.0) - 0.6 * s.x.row(i).segment<3>(9).transpose();
    s.y.row(i) =
        (f.to_sensor * world - f.alpha.cross(Eigen::Vector3d(0.01, -0.02, 0.1))).transpose();
  }
  return s;
}

Samples draw_motion(Index rows, double hz, std::uint64_t seed) {
  return draw_tones(rows, 6, seed, [=](int k, Rng& rng) {
    return Tone{hz * (0.2 + 0.16 * k) * rng.uniform(0.9, 1.1), 0.3 / (1.0 + k)};
  });
}

/// Tones from 0.05 to 1.3 Hz, the slow ones wide: what a second of it is like, hardly says how fast
/// it is.
Samples draw_wide_band(Index rows, double pace, std::uint64_t seed) {
  return draw_tones(rows, 9, seed, [=](int k, Rng& rng) {
    const double hz = 0.05 * std::pow(26.0, (k + rng.uniform()) / 9.0);
    return Tone{pace * hz, 0.02 * std::pow(hz, -0.9) * rng.uniform(0.8, 1.25)};
  });
}

Problem problem(const Json& patch = Json::object()) {
  Problem result;
  for (int j = 0; j < 15; ++j) result.layout.names.push_back("x" + std::to_string(j));
  result.layout.units.assign(15, "");
  result.targets = {{"fx", "fy", "fz"}, {"N", "N", "N"}};
  result.configuration = {
      {"model",
       {{"name", "frame-tcn"}, {"time_scales", {0.8, 1.0, 1.25}}, {"experts_x_db", {10, 25, 60}}}},
      {"training", {{"epochs", 4}, {"steps", 20}}}};
  for (const auto& [section, keys] : patch.items()) result.configuration[section].update(keys);
  result.where = "test";
  result.seed = 3;
  return result;
}

const Samples& training() {
  static const Samples samples = draw_motion(5000, 2.0, 1);
  return samples;
}

const FrameTcn& trained() {
  static const auto model = [] {
    auto m = std::make_unique<FrameTcn>(problem());
    FitSession session;
    m->fit(training(), {}, session);
    return m;
  }();
  return *model;
}

std::string bytes(const FrameTcn& model) {
  Container file;
  model.save(file);
  return encode(file);
}

TEST(FrameTcn, AnUnknownLevelIsThatOfTheOthersOrTheWorst) {
  Rng rng(1);
  Net net({2, 1, true}, rng);
  net.level_noisy.setConstant(3.0);
  Eigen::MatrixXd rough = Eigen::MatrixXd::Constant(kChannels, 2, kUnknown);
  rough.col(1).head(2) << 1e-2, 1e-4;  // levels -1 and -2
  const Eigen::MatrixXd level = net.standard_levels(rough);
  EXPECT_TRUE(level.col(0).isConstant(3.0));
  EXPECT_TRUE(level.col(1).tail(13).isConstant(-1.5));
}

/// Gradients of all parameters by hand against differences, every `stride`-th.
void expect_gradients(const Net::Plan& plan, double spread, Index stride) {
  Rng rng(5);
  Net net(plan, rng);
  for (double& p : net.parameters) p += spread * rng.normal();
  net.mean.setConstant(0.2);
  net.scale.setConstant(0.7);
  Pass pass;
  pass.levels.resize(kChannels, 3);
  pass.experts.resize(plan.experts * kChannels, 3);
  for (double& v : pass.levels.reshaped()) v = rng.normal();
  for (double& v : pass.experts.reshaped()) v = 0.5 * rng.normal();
  const auto loss = [&] {
    net.denoise(pass);
    net.features(pass);
    net.product(pass);
    return 0.5 * pass.out.squaredNorm();
  };
  loss();
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(net.parameters.size());
  const Eigen::MatrixXd d_clean = net.pull_back_head(pass, pass.out, gradient);
  net.pull_back_denoise(pass, d_clean, gradient);
  for (Index i = 0; i < net.parameters.size(); i += stride) {
    const double step = 1e-6, kept = net.parameters[i];
    net.parameters[i] = kept + step;
    const double above = loss();
    net.parameters[i] = kept - step;
    const double below = loss();
    net.parameters[i] = kept;
    const double wanted = (above - below) / (2.0 * step);
    EXPECT_NEAR(gradient[i], wanted, 1e-5 * std::max(1.0, std::abs(wanted))) << "parameter " << i;
  }
}

TEST(FrameTcn, GradientsAgreeWithDifferences) { expect_gradients({2, 2, true}, 0.3, 7); }

TEST(FrameTcn, GradientsOfDenseLayersAgreeWithDifferences) {
  expect_gradients({kBlocks, 1, true, true}, 0.01, 997);
}

/// The control in place of convolutions and gates learns, too, and its file is the same model.
TEST(FrameTcn, DenseLayersLearnATool) {
  FrameTcn model(problem({{"model", {{"front", "dense"}, {"time_scales", {1.0}}}},
                          {"training", {{"lr_gates", 1e-3}}}}));
  FitSession session;
  ASSERT_TRUE(model.fit(training(), {}, session));
  const Samples test = draw_motion(1500, 2.0, 2);
  EXPECT_LT((model.predict(test) - test.y).norm(), 0.4 * test.y.norm());
  EXPECT_GT(model.parameter_count(), 114000);
  Container file;
  model.save(file);
  const FrameTcn copy(decode(encode(file), "m"), "m");
  EXPECT_EQ(copy.predict(test), model.predict(test));
}

TEST(FrameTcn, LearnsAToolOnAnotherMotion) {
  const Samples test = draw_motion(1500, 2.0, 2);
  const Eigen::MatrixXd error = trained().predict(test) - test.y;
  EXPECT_LT(std::sqrt(error.squaredNorm() / static_cast<double>(error.size())), 0.3);
}

TEST(FrameTcn, SeesNeitherTheFutureNorAnotherSegment) {
  Stream changed = training();
  changed.x.bottomRows(1000).array() += 1.0;
  const Eigen::MatrixXd before = trained().predict(training()), after = trained().predict(changed);
  EXPECT_LT((after - before).topRows(4000).cwiseAbs().maxCoeff(), 1e-9);
  Stream other = training();
  other.x.topRows(2500).array() += 1.0;
  EXPECT_LT((trained().predict(other) - before).bottomRows(2500).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(FrameTcn, AModelFromAFileIsTheSameModel) {
  Container file;
  trained().save(file);
  const FrameTcn copy(decode(encode(file), "m"), "m");
  EXPECT_EQ(copy.predict(training()), trained().predict(training()));
  EXPECT_EQ(bytes(copy), bytes(trained()));
  file.tensors.pop_back();
  EXPECT_THROW(FrameTcn(file, "m"), Error);
}

TEST(FrameTcn, AResumedTrainingEndsInTheSameBytes) {
  const Samples few = draw_motion(800, 2.0, 4);
  const auto fit = [&](FitSession session, FrameTcn& model) { return model.fit(few, {}, session); };
  FrameTcn whole(problem()), stopped(problem()), resumed(problem());
  ASSERT_TRUE(fit({}, whole));
  Container checkpoint;
  Index left = 50;  // stops in the head's first epoch
  FitSession first, second;
  first.stop_wanted = [&] { return left-- == 0; };
  first.save_checkpoint = [&](const Container& file) { checkpoint = file; };
  ASSERT_FALSE(fit(first, stopped));
  second.checkpoint = checkpoint;
  ASSERT_TRUE(fit(second, resumed));
  EXPECT_EQ(bytes(resumed), bytes(whole));
}

TEST(FrameTcn, NoticesMotionFasterThanItsTraining) {
  const Eigen::VectorXd own = trained().novelty(draw_motion(3000, 2.0, 7));
  EXPECT_LT((own.array() > 1.0).cast<double>().mean(), 0.01);
  const Eigen::VectorXd fast = trained().novelty(at_speed(training(), 2.0));
  EXPECT_GT((fast.array() > 1.0).cast<double>().mean(), 0.5);
}

/// With noise on it: exact rates of a faster motion would be told by their roughness alone.
TEST(FrameTcn, NoticesAFasterWideBandWithinSeconds) {
  FrameTcn model(problem());
  FitSession session;
  ASSERT_TRUE(model.fit(draw_wide_band(12000, 1.0, 1), {}, session));
  const auto told = [&](Stream stream) -> Eigen::ArrayXd {
    const auto deviation = noise_deviation({}, model.map(), stream.x, 20.0);
    stream.x = with_noise(stream.x, deviation, 5);
    return (model.novelty(stream).array() > 1.0).cast<double>();
  };
  EXPECT_LT(told(draw_wide_band(12000, 1.0, 2)).mean(), 0.01);
  const Eigen::ArrayXd fast = told(draw_wide_band(12000, 1.7, 2));
  EXPECT_GT(fast.segment(2000, 4000).mean(), 0.9);
  EXPECT_GT(fast.segment(8000, 4000).mean(), 0.9);
}

TEST(FrameTcn, ThePaceIsJudgedByTheNearestLevelOfNoise) {
  Pace pace(2);
  const Eigen::MatrixXd clean = Eigen::MatrixXd::Constant(kChannels, 200, 1.0);
  const Eigen::MatrixXd quiet = Eigen::MatrixXd::Constant(kChannels, 200, -1.0), loud = -quiet;
  pace.learn(0, Pace::signs(clean), Pace::mean_levels(quiet));
  pace.learn(1, Pace::signs(3.0 * clean), Pace::mean_levels(loud));
  EXPECT_LT(pace.score(clean, quiet).maxCoeff(), 1.0);
  EXPECT_GT(pace.score(3.0 * clean, quiet).tail(100).minCoeff(), 1.0);
  EXPECT_LT(pace.score(3.0 * clean, loud).maxCoeff(), 1.0);
}

}  // namespace
}  // namespace dcnn::frame_tcn
