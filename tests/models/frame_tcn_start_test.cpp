// SPDX-License-Identifier: Apache-2.0
// The first rows of a segment where derivatives look back alone: their window holds the first
// sample many times.
#include <gtest/gtest.h>

#include <cmath>

#include "models/frame_tcn/model.h"
#include "models/tensor_io.h"

namespace dcnn::frame_tcn {
namespace {

constexpr Index kPiece = 120, kFirst = 60;  // rows of a test segment, of them the first window's
constexpr double kDt = 0.002;

/// Position and angles of a made-up motion.
Eigen::MatrixXd draw_pose(Index rows, std::uint64_t seed) {
  Rng rng(seed);
  Eigen::MatrixXd pose = Eigen::MatrixXd::Zero(rows, 6);
  for (Index j = 0; j < 6; ++j) {
    for (int k = 0; k < 6; ++k) {
      const double w = 6.283 * (0.2 + 0.16 * k) * rng.uniform(0.9, 1.1);
      const double phase = rng.uniform(0.0, 6.283), size = 0.3 / (1.0 + k);
      for (Index i = 0; i < rows; ++i) {
        pose(i, j) += size * std::sin(w * kDt * static_cast<double>(i) + phase);
      }
    }
  }
  return pose;
}

/// The 15 rows as the causal estimator makes them.
Eigen::MatrixXd features(const Eigen::MatrixXd& pose, const std::vector<Segment>& segments) {
  Recording recording;
  recording.dt = kDt;
  recording.segments = segments;
  const Derivatives rates = differentiate(pose, recording, causal_derivative());
  Eigen::MatrixXd x(pose.rows(), kChannels);
  x << pose.rightCols<3>(), rates.first, rates.second;
  return x;
}

Eigen::MatrixXd white(Index rows, Index columns, std::uint64_t seed) {
  Rng rng(seed);
  Eigen::MatrixXd noise(rows, columns);
  for (double& value : noise.reshaped()) value = rng.normal();
  return noise;
}

Eigen::VectorXd deviation(const Eigen::MatrixXd& x) {
  const Eigen::MatrixXd centred = x.rowwise() - x.colwise().mean();
  return (centred.colwise().squaredNorm() / static_cast<double>(x.rows())).cwiseSqrt().transpose();
}

/// Force of a tool for features of rows in the middle of a motion.
Eigen::MatrixXd force(const Eigen::MatrixXd& x) {
  Eigen::MatrixXd y(x.rows(), 3);
  for (Index i = 0; i < x.rows(); ++i) {
    const Frame f(x.row(i).transpose(), Eigen::Matrix3d::Identity());
    const Eigen::Vector3d world =
        Eigen::Vector3d(0, 0, -5.0) - 0.6 * x.row(i).segment<3>(9).transpose();
    y.row(i) = (f.to_sensor * world).transpose();
  }
  return y;
}

struct Trained {
  explicit Trained(const std::string& on) {
    const Eigen::MatrixXd pose = draw_pose(8000, 1);
    spread = deviation(pose);
    Samples training;
    training.segments = {{0, pose.rows()}};
    training.x = features(pose, training.segments);
    training.y = force(training.x);
    for (std::uint64_t k = 0; on == "pose" && k < 3; ++k) {
      const Eigen::MatrixXd draw = white(pose.rows(), 6, 10 + k) * spread.asDiagonal();
      training.pose_noise.push_back(features(draw, training.segments));
    }
    Problem problem;
    for (Index j = 0; j < kChannels; ++j) problem.layout.names.push_back("x" + std::to_string(j));
    problem.layout.units.assign(kChannels, "");
    problem.layout.dt = kDt;
    problem.layout.spec.derivative = causal_derivative();
    problem.layout.pose_deviation = spread;
    problem.targets = {{"fx", "fy", "fz"}, {"N", "N", "N"}};
    problem.configuration = {{"model", {{"name", "frame-tcn"}, {"time_scales", {1.0}}}},
                             {"noise", {{"on", on}}},
                             {"training", {{"epochs", 6}, {"steps", 20}}}};
    problem.where = "test";
    model = std::make_unique<FrameTcn>(problem);
    FitSession session;
    model->fit(training, {}, session);
    x_spread = deviation(training.x);
  }

  std::unique_ptr<FrameTcn> model;
  Eigen::VectorXd spread, x_spread;  // of the pose, of the features
};

/// Rms error of the first rows of a segment and of the others.
struct Errors {
  double first = 0.0, rest = 0.0;
};

Stream pieces(const Trained& trained, double pose_noise, double feature_noise) {
  const Eigen::MatrixXd pose = draw_pose(60 * kPiece, 2);
  Stream stream;
  for (Index i = 0; i < pose.rows(); i += kPiece) stream.segments.push_back({i, i + kPiece});
  stream.x = features(pose + pose_noise * white(pose.rows(), 6, 3) * trained.spread.asDiagonal(),
                      stream.segments);
  stream.x += feature_noise * white(pose.rows(), kChannels, 4) * trained.x_spread.asDiagonal();
  return stream;
}

Errors score(const Trained& trained, const Stream& stream) {
  const Eigen::MatrixXd y = force(features(draw_pose(stream.rows(), 2), {{0, stream.rows()}}));
  const Eigen::MatrixXd error = trained.model->predict(stream) - y;
  Errors sum;
  for (Index i = kPiece; i < error.rows(); ++i) {  // in the first piece y rises from rest, too
    (i % kPiece < kFirst ? sum.first : sum.rest) += error.row(i).squaredNorm();
  }
  const auto count = 3.0 * static_cast<double>(error.rows() - kPiece) / 2.0;
  return {std::sqrt(sum.first / count), std::sqrt(sum.rest / count)};
}

const Trained& of_noisy_poses() {
  static const Trained trained("pose");
  return trained;
}

TEST(FrameTcnStart, NoNoiseOfTheFirstWindowIsAmplified) {
  const Errors error = score(of_noisy_poses(), pieces(of_noisy_poses(), 0.316, 0.0));
  EXPECT_LT(error.first, 4.0 * error.rest);
}

TEST(FrameTcnStart, RatesThatRiseFromRestAreTakenForWhatTheyRiseTo) {
  const Errors error = score(of_noisy_poses(), pieces(of_noisy_poses(), 0.0, 0.0));
  EXPECT_LT(error.first, 2.0 * error.rest);
}

/// Gates never leave an expert nothing: one that is made for hardly any noise must not multiply
/// what little the first rows tell.
TEST(FrameTcnStart, NoiseOnRatesThatOnlyBeginToRiseIsNotAmplified) {
  static const Trained trained("features");
  const Errors error = score(trained, pieces(trained, 0.0, 0.316));
  EXPECT_LT(error.first, 5.0 * error.rest);
  Container file;
  trained.model->save(file);
  double gain = 0.0;
  for (const char* history : {"1", "2", "4", "8", "16"}) {
    for (int group = 0; group < kGroups; ++group) {
      const auto name = "convolution." + std::to_string(group) + "." + history;
      const auto& weights = stored_values<double>(file, name, "test");
      const auto row = static_cast<std::size_t>(file.find(name)->shape[1]);
      for (std::size_t i = 0; i < weights.size(); i += row) {
        gain = std::max(
            gain, Eigen::Map<const Eigen::VectorXd>(&weights[i], static_cast<Index>(row)).norm());
      }
    }
  }
  EXPECT_LT(gain, 100.0);
}

TEST(FrameTcnStart, SampleBySampleASegmentStartsAsInARecording) {
  const Stream stream = pieces(of_noisy_poses(), 0.1, 0.0);
  const Eigen::MatrixXd whole = of_noisy_poses().model->predict(stream);
  const auto predictor = of_noisy_poses().model->predictor();
  for (Index i = 0; i < 3 * kPiece; ++i) {
    if (i % kPiece == 0) predictor->reset();
    const Eigen::VectorXd y = predictor->push(stream.x.row(i).transpose());
    EXPECT_LT((y.transpose() - whole.row(i)).cwiseAbs().maxCoeff(), 1e-6) << i;
  }
}

}  // namespace
}  // namespace dcnn::frame_tcn
