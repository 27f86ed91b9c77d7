// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/derivative.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "data/sample_recording.h"
#include "data/spectral.h"
#include "data/testing.h"
#include "dcnn/core/error.h"
#include "dcnn/core/json.h"
#include "dcnn/core/random.h"

namespace dcnn {
namespace {

using Kind = DerivativeSpec::Kind;
using testing::sine_recording;

const std::vector<Kind> kAll = {Kind::kSavitzkyGolay, Kind::kCausalSavitzkyGolay, Kind::kCentral,
                                Kind::kSpline};

DerivativeSpec spec_of(Kind kind, double window_s = 0.1) {
  return {kind, window_s, kind == Kind::kCausalSavitzkyGolay ? 2 : 3};
}

/// Noise gain at sample `row`: root of the summed squares of what every single input sample adds
/// there.
Eigen::Vector2d noise_gain(Kind kind, Index row, double window_s) {
  const Recording recording = sine_recording(200);
  const Derivatives d =
      differentiate(Eigen::MatrixXd::Identity(200, 200), recording, spec_of(kind, window_s));
  return {d.first.row(row).norm(), d.second.row(row).norm()};
}

TEST(Derivative, WindowIsATime) {
  const DerivativeSpec spec;
  EXPECT_EQ(spec.window(0.002), 51);
  EXPECT_EQ(spec.window(0.001), 101);
  EXPECT_EQ(spec.window(0.01), 11);
  EXPECT_EQ(spec.window(0.1), 7);
  EXPECT_EQ(spec_of(Kind::kCausalSavitzkyGolay).window(1.0), 7);
}

TEST(Derivative, SavitzkyGolayIsExactOnCubicsUpToTheEnds) {
  const Recording recording = sine_recording(200);
  const Eigen::ArrayXd t = recording.column("t").array();
  const Eigen::ArrayXd x = 2.0 - 3.0 * t + 4.0 * t.square() - 5.0 * t.cube();
  const Derivatives d = differentiate(x.matrix(), recording, spec_of(Kind::kSavitzkyGolay));
  EXPECT_LT((d.first.col(0).array() - (-3.0 + 8.0 * t - 15.0 * t.square())).abs().maxCoeff(),
            1e-11);
  EXPECT_LT((d.second.col(0).array() - (8.0 - 30.0 * t)).abs().maxCoeff(), 1e-8);
}

TEST(Derivative, CausalIsExactOnParabolasOnceTheWindowIsFull) {
  const Recording recording = sine_recording(200);
  const Eigen::ArrayXd t = recording.column("t").array();
  const Derivatives d = differentiate((1.0 + 2.0 * t + 3.0 * t.square()).matrix(), recording,
                                      spec_of(Kind::kCausalSavitzkyGolay));
  EXPECT_LT((d.first.col(0).array() - (2.0 + 6.0 * t)).tail(150).abs().maxCoeff(), 1e-10);
  EXPECT_LT((d.second.col(0).array() - 6.0).tail(150).abs().maxCoeff(), 1e-7);
}

TEST(Derivative, CausalDoesNotSeeTheFuture) {
  const Recording recording = sine_recording(300);
  Eigen::MatrixXd x = recording.block({"x", "gamma"});
  const auto spec = spec_of(Kind::kCausalSavitzkyGolay);
  const Derivatives before = differentiate(x, recording, spec);
  for (const Index now : {0, 10, 57, 200}) {
    Eigen::MatrixXd changed = x;
    changed.bottomRows(299 - now).array() += 5.0;
    const Derivatives after = differentiate(changed, recording, spec);
    EXPECT_EQ(before.first.topRows(now + 1), after.first.topRows(now + 1)) << now;
    EXPECT_EQ(before.second.topRows(now + 1), after.second.topRows(now + 1)) << now;
    EXPECT_NE(before.first.row(now + 1), after.first.row(now + 1)) << now;
  }
}

TEST(Derivative, EveryEstimatorApproachesTheTruth) {
  const Recording recording = sine_recording(1000);
  for (const Kind kind : kAll) {
    const Derivatives d = differentiate(recording.block({"x"}), recording, spec_of(kind, 0.03));
    for (Index i = 100; i < 900; ++i) {
      const double t = 0.002 * static_cast<double>(i);
      ASSERT_NEAR(d.first(i, 0), testing::kPositions[0].at(t, 1), 2e-4) << static_cast<int>(kind);
      ASSERT_NEAR(d.second(i, 0), testing::kPositions[0].at(t, 2), 4e-2) << static_cast<int>(kind);
    }
  }
}

// Spec 1.3: what white noise of the pose becomes. A window of 31 samples is 0.06 s at 500 Hz.
TEST(Derivative, NoiseGainsAreThoseOfTheFormulas) {
  const double n = 31, dt = 0.002, dt2 = dt * dt;
  const double sg = std::sqrt(720.0 / (n * (n * n - 1) * (n * n - 4))) / dt2;
  EXPECT_NEAR(sg, 1.26e3, 5.0);
  EXPECT_NEAR(noise_gain(Kind::kSavitzkyGolay, 100, 0.06)[1], sg, 1e-9 * sg);
  const double three_points = std::sqrt(6.0) / dt2;  // (1, -2, 1)
  EXPECT_NEAR(three_points, 6.1e5, 0.05e5);
  // gradient twice is the three-point formula at twice the step
  EXPECT_NEAR(noise_gain(Kind::kCentral, 100, 0.06)[1], three_points / 4.0, 1e-6);
  EXPECT_NEAR(noise_gain(Kind::kCentral, 100, 0.06)[0], std::sqrt(0.5) / dt, 1e-9);
  // the quadratic's second derivative is constant: the causal gain is the centred one
  EXPECT_NEAR(noise_gain(Kind::kCausalSavitzkyGolay, 100, 0.06)[1], sg, 1e-9 * sg);
  // velocity of a quadratic at its end: variance 12(2N-1)(8N-11)/(N(N^2-1)(N^2-4))
  const double end =
      std::sqrt(12 * (2 * n - 1) * (8 * n - 11) / (n * (n * n - 1) * (n * n - 4))) / dt;
  EXPECT_NEAR(noise_gain(Kind::kCausalSavitzkyGolay, 100, 0.06)[0], end, 1e-9 * end);
  EXPECT_GT(noise_gain(Kind::kSpline, 100, 0.06)[1], three_points);  // a spline does not smooth
}

TEST(Derivative, DoesNotCrossAGap) {
  for (const Kind kind : kAll) {
    Recording recording = sine_recording(400);
    recording.segments = {{0, 150}, {150, 400}};
    Eigen::MatrixXd x = recording.block({"x"});
    const Derivatives before = differentiate(x, recording, spec_of(kind));
    x.topRows(150).array() *= -3.0;
    const Derivatives after = differentiate(x, recording, spec_of(kind));
    EXPECT_EQ(before.first.bottomRows(250), after.first.bottomRows(250));
    EXPECT_EQ(before.second.bottomRows(250), after.second.bottomRows(250));
  }
}

TEST(Derivative, NamesASegmentThatIsTooShort) {
  Recording recording = sine_recording(400);
  recording.segments = {{0, 370}, {370, 400}};
  const auto message =
      testing::error_of([&] { differentiate(recording.block({"x"}), recording, {}); }, Exit::kData);
  EXPECT_TRUE(testing::contains(message, "sines.csv: samples 371 to 400")) << message;
  EXPECT_TRUE(testing::contains(message, "window_s")) << message;
}

TEST(Derivative, SpecComesBackFromJson) {
  for (const Kind kind : kAll) {
    const DerivativeSpec spec = spec_of(kind, 0.0625);
    const DerivativeSpec back = parse_derivative(Options(to_json(spec), "c.json", Exit::kUsage));
    EXPECT_EQ(back.kind, spec.kind);
    EXPECT_EQ(back.window_s, spec.window_s);
    EXPECT_EQ(back.order, spec.order);
  }
}

TEST(Derivative, AgreesWithTheReference) {
  const auto path = testing::shared("reference/savgol.json");
  if (path.empty()) GTEST_SKIP() << "../shared/reference is absent";
  const Json json = read_json(path, Exit::kData);
  const auto matrix = [&](const char* key) {
    Eigen::MatrixXd m(120, 3);
    for (Index i = 0; i < 120; ++i) {
      for (Index k = 0; k < 3; ++k) {
        m(i, k) = json[key][static_cast<std::size_t>(i)][static_cast<std::size_t>(k)].get<double>();
      }
    }
    return m;
  };
  const Derivatives d = differentiate(matrix("theta"), sine_recording(120), {});
  const Eigen::MatrixXd first = matrix("d1"), second = matrix("d2");
  EXPECT_LT((d.first - first).cwiseAbs().maxCoeff(), 1e-12 * first.cwiseAbs().maxCoeff());
  EXPECT_LT((d.second - second).cwiseAbs().maxCoeff(), 1e-10 * second.cwiseAbs().maxCoeff());
}

TEST(Smooth, KeepsTheAccelerationUpToTheEnds) {
  const Index n = 2000;
  const double dt = 0.002, w = 2.0 * 3.14159265358979 * 0.7;
  const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(n, 0.0, dt * (n - 1));
  const Smoothed s = smooth((0.1 * (w * t + 1.0).sin()).matrix(), dt, {.cutoff_hz = 8.0});
  const Eigen::ArrayXd exact = -0.1 * w * w * (w * t + 1.0).sin();
  const double most = 0.1 * w * w;
  EXPECT_LT((s.second.array() - exact).abs().maxCoeff(), 0.05 * most);  // also at both ends
  EXPECT_LT((s.second.array() - exact).segment(250, n - 500).abs().maxCoeff(), 2e-3 * most);
  const Eigen::ArrayXd slope = 0.1 * w * (w * t + 1.0).cos();
  EXPECT_LT((s.first.array() - slope).abs().maxCoeff(), 0.01 * 0.1 * w);
}

/// Motion of half the cut-off, to the first and last sample: a quartic over several of its periods
/// has the acceleration there of another motion.
TEST(Smooth, KeepsTheAccelerationOfFastMotionAtTheEnds) {
  const Index n = 2000, end = 25;
  const double dt = 0.002, w = 2.0 * std::numbers::pi * 2.5;
  Rng rng({17});
  for (const double phase : {0.0, 0.7, 1.4, 2.1}) {
    Eigen::VectorXd x(n), exact(n);
    for (Index i = 0; i < n; ++i) {
      const double turn = w * dt * static_cast<double>(i) + phase;
      x(i) = 0.01 * std::sin(turn) + 5e-6 * rng.normal();
      exact(i) = -0.01 * w * w * std::sin(turn);
    }
    const Eigen::VectorXd error = smooth(x, dt, {.cutoff_hz = 5.0}).second - exact;
    const double most = 0.2 * 0.01 * w * w;
    EXPECT_LT(error.head(end).norm() / 5.0, most) << phase;
    EXPECT_LT(error.tail(end).norm() / 5.0, most) << phase;
  }
}

/// Slow, large motion that ends on the move, a tremor, and white noise, over 40 s at 400 Hz.
Eigen::VectorXd trembling(double noise) {
  constexpr double kDt = 0.0025;
  Rng rng({11});
  Eigen::VectorXd x(16'000);
  for (Index i = 0; i < x.size(); ++i) {
    const double t = kDt * static_cast<double>(i), turn = 2.0 * std::numbers::pi * t;
    x(i) = 0.1 * std::sin(0.31 * turn) + 1e-4 * std::sin(9.5 * turn) + noise * rng.normal();
  }
  return x;
}

TEST(Smooth, TakesNoiseOffBetweenTheBandsOfTheMotion) {
  const Eigen::VectorXd gain = gain_of(trembling(1e-5), 0.0025, {30.0, 1.0}, 400);  // 0.5 Hz each
  const auto mean = [&](double from, double to) {
    const auto first = static_cast<Index>(2.0 * from), end = static_cast<Index>(2.0 * to);
    return gain.segment(first, end - first).mean();
  };
  EXPECT_GT(mean(0.0, 2.0), 0.99);
  EXPECT_GT(mean(9.0, 10.0), 0.9);
  // Of noise alone a mean of 41 bins leaves about sqrt(2/pi/41) = 0.125.
  EXPECT_LT(mean(4.5, 7.5), 0.2);
  EXPECT_LT(mean(12.0, 25.0), 0.2);
}

/// Between the bands of the motion the noise of the acceleration falls to a fifth, and at the ends
/// the filter adds nothing to it.
TEST(Smooth, LeavesTheAccelerationOfWhatMovesUpToTheEnds) {
  const Eigen::VectorXd noisy = trembling(1e-5), exact = trembling(0.0);
  const auto error = [&](const LowPass& filter, Index first, Index count) {
    const Eigen::VectorXd r =
        smooth(noisy, 0.0025, filter).second - smooth(exact, 0.0025, {200.0, 0.0}).second;
    return std::sqrt(r.segment(first, count).squaredNorm() / double(count));
  };
  const LowPass with{25.0, 1.0}, without{25.0, 0.0};
  EXPECT_LT(error(with, 2000, 12'000), 0.5 * error(without, 2000, 12'000));
  for (const Index first : {Index{120}, Index{16'000 - 120 - 400}}) {
    EXPECT_LT(error(with, first, 400), 1.1 * error(without, first, 400));
  }
}

/// A cut-off chosen on a slow recording serves one that trembles, and lets no noise of either pass.
TEST(Smooth, PassesMotionBeyondTheCutoffOfARecordingWithoutIt) {
  Rng rng({3});
  const auto slow = [&] {
    Eigen::VectorXd x(16'000);
    for (Index i = 0; i < x.size(); ++i) {
      const double turn = 2.0 * std::numbers::pi * 0.0025 * double(i);
      x(i) = 0.1 * std::sin(0.31 * turn) + 1e-5 * rng.normal();
    }
    return x;
  };
  LowPass filter{.cutoff_hz = 5.0};
  filter.most_noise = most_noise(slow(), 0.0025, filter);
  EXPECT_GT(filter.most_noise.back(), 1.0);
  const auto mean = [&](const Eigen::VectorXd& x, double from, double to) {
    const auto first = static_cast<Index>(2.0 * from), end = static_cast<Index>(2.0 * to);
    return gain_of(x, 0.0025, filter, 400).segment(first, end - first).mean();
  };
  for (int draw = 0; draw < 20; ++draw) EXPECT_LT(mean(slow(), 12.0, 200.0), 1e-3);
  EXPECT_GT(mean(trembling(1e-5), 9.0, 10.0), 0.9);
  EXPECT_LT(mean(trembling(1e-5), 12.0, 200.0), 1e-3);
  filter.most_noise.clear();
  EXPECT_LT(mean(trembling(1e-5), 9.0, 10.0), 0.02);
}

/// Motion that slows as its frequency rises: what one recording holds at 4 Hz, another may hold
/// less of at 9 Hz, where the first has nothing.
TEST(Smooth, PassesWhatExceedsAnotherRecordingAtItsFrequencyAndAbove) {
  Rng rng({4});
  const auto swinging = [&](double hz, double size) {
    Eigen::VectorXd x(16'000);
    for (Index i = 0; i < x.size(); ++i) {
      const double turn = 2.0 * std::numbers::pi * 0.0025 * double(i);
      x(i) = size * std::sin(hz * turn) + 1e-5 * rng.normal();
    }
    return x;
  };
  LowPass filter{.cutoff_hz = 5.0};
  filter.most_noise = most_noise(swinging(4.2, 0.1), 0.0025, filter);
  ASSERT_EQ(filter.most_noise.size(), 25u);
  EXPECT_TRUE(std::is_sorted(filter.most_noise.rbegin(), filter.most_noise.rend()));
  const auto at_nine = [&](const LowPass& other) {
    return gain_of(swinging(9.2, 0.01), 0.0025, other, 400).segment(18, 1).mean();
  };
  EXPECT_GT(at_nine(filter), 0.5);
  LowPass as_much_everywhere = filter;
  as_much_everywhere.most_noise = {filter.most_noise.front()};
  EXPECT_LT(at_nine(as_much_everywhere), 0.05);
}

TEST(DerivativeSpec, KeepsHowMuchPasses) {
  DerivativeSpec spec;
  spec.kind = DerivativeSpec::Kind::kSpectral;
  for (const std::vector<double>& most : {std::vector<double>{}, {10.0}, {3.0, 2.0, 1.0}}) {
    spec.most_noise = most;
    const Json json = to_json(spec);
    EXPECT_EQ(parse_derivative(Options(json, "model", Exit::kData)).most_noise, most);
  }
  const Json number{{"kind", "spectral"}, {"most_noise", 10.0}};
  EXPECT_EQ(parse_derivative(Options(number, "model", Exit::kData)).most_noise,
            std::vector<double>{10.0});
  const Json negative{{"kind", "spectral"}, {"most_noise", {1.0, -1.0}}};
  EXPECT_THROW(parse_derivative(Options(negative, "model", Exit::kData)), Error);
}

}  // namespace
}  // namespace dcnn
