// SPDX-License-Identifier: Apache-2.0
// Slow noise of a known spectrum: its estimate, and names beside it.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dcnn/core/random.h"
#include "diagnosis/slow_part.h"
#include "diagnosis/support.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

using test::Bench;
using test::change;
using test::configuration;
using test::found;
using test::hidden;

constexpr double kPeriod = 0.002;

/// First-order Gauss-Markov noise whose density at 0 Hz is `at_rest`, with the corner `hz`.
Eigen::VectorXd markov_noise(Index rows, double at_rest, double hz, Rng& rng) {
  const double rho = std::exp(-2.0 * std::numbers::pi * hz * kPeriod);
  const double deviation = std::sqrt(at_rest * (1.0 - rho) / (1.0 + rho));
  Eigen::VectorXd x(rows);
  double at = deviation * rng.normal();
  for (Index i = 0; i < rows; ++i) {
    x(i) = at;
    at = rho * at + deviation * std::sqrt(1.0 - rho * rho) * rng.normal();
  }
  return x;
}

/// A recording of so many rows and channels that are noise alone.
Case noisy_case(Index rows, Index channels) {
  Case study;
  for (int j = 0; j < channels; ++j) study.channels.push_back(j);
  Log log;
  log.motion.dt = kPeriod;
  log.motion.t = Eigen::VectorXd::LinSpaced(rows, 0.0, kPeriod * static_cast<double>(rows - 1));
  log.motion.segments = {{0, rows}};
  log.motion.R_BS.resize(static_cast<std::size_t>(rows));
  log.measured = Eigen::MatrixXd::Zero(rows, channels);
  study.logs.push_back(log);
  return study;
}

TEST(SlowPart, HasTheDensityOfTheNoise) {
  constexpr Index kLength = 20000;
  const Case study = noisy_case(kLength, 1);
  Floor floor;
  floor.white = 1.0, floor.dt = kPeriod;
  for (const double at_rest : {0.0, 10.0, 40.0}) {
    double square = 0.0;
    constexpr int kTrials = 20;
    for (int seed = 0; seed < kTrials; ++seed) {
      Rng rng(static_cast<std::uint64_t>(seed));
      Eigen::VectorXd x = markov_noise(kLength, at_rest, 0.3, rng);
      for (double& value : x) value += rng.normal();
      const auto parts = slow_parts(study, {x}, {floor});
      ASSERT_TRUE(parts);
      Floor sum = floor;
      parts->front().add_to(sum);
      for (const double hz : {0.1, 0.3, 1.0, 5.0}) {
        const double truth = 1.0 + at_rest / (1.0 + hz * hz / 0.09);
        square += std::pow(std::log(sum.density(hz) / truth), 2) / 4.0;
      }
    }
    // An octave about 0.1 Hz has 3 bins of 40 s, whose mean errs by 0.6.
    EXPECT_LT(std::sqrt(square / kTrials), 0.3) << at_rest;
  }
}

/// Three channels of white noise of unit density and noise of density c/f^slope, but for a factor:
/// first-order processes an octave apart, the one with its corner at f of density c/f^slope at
/// rest.
Eigen::MatrixXd rising_noise(Index rows, double c, double slope, Rng& rng) {
  Eigen::MatrixXd x(rows, 3);
  for (Index j = 0; j < 3; ++j) {
    for (double& value : x.col(j)) value = rng.normal();
    for (double corner = 0.01; corner < 20.0; corner *= 2.0) {
      x.col(j) += markov_noise(rows, c * std::pow(corner, -slope), corner, rng);
    }
  }
  return x;
}

/// The slow parts of that noise, whose floor is known.
std::vector<SlowPart> parts_of_rising_noise(double c, double slope, int seed) {
  constexpr Index kLength = 10000;
  Floor floor;
  floor.white = 1.0, floor.dt = kPeriod;
  Rng rng(static_cast<std::uint64_t>(seed));
  const auto parts = slow_parts(noisy_case(kLength, 3), {rising_noise(kLength, c, slope, rng)},
                                {floor, floor, floor});
  EXPECT_TRUE(parts);
  return parts.value_or(std::vector<SlowPart>(3));
}

// 1/f noise as a sum of first-order processes, an octave apart; it equals the floor at 5 Hz. One
// channel of 20 s often looks like a process with a corner, which is flat where this rises.
TEST(SlowPart, ChannelsOfOneSensorShareTheirForm) {
  constexpr double kCornerHz = 5.0;
  // sum over octaves of r/(1 + (f/c)^2), r ~ 1/c, is pi/2/ln 2 r c/f.
  constexpr double kSize = kCornerHz * 2.0 * std::numbers::ln2 / std::numbers::pi;
  constexpr int kTrials = 20;
  int rising = 0;
  for (int seed = 0; seed < kTrials; ++seed) {
    for (const SlowPart& part : parts_of_rising_noise(kSize, 1.0, seed)) {
      Floor sum;
      sum.white = 1.0, sum.dt = kPeriod;
      part.add_to(sum);
      rising += std::abs(std::log(sum.density(0.1) / (1.0 + kCornerHz / 0.1))) < 0.5 ? 1 : 0;
    }
  }
  EXPECT_GE(rising, 51);  // of 60: a form is chosen wrongly in one recording of ten
}

// The same with a steeper rise, of which a process with a corner has no trace below it.
TEST(SlowPart, RisesAsSteeplyAsTheNoise) {
  constexpr double kSteep = 1.5;
  constexpr int kTrials = 20;
  double sum = 0.0;
  for (int seed = 0; seed < kTrials; ++seed) {
    for (const SlowPart& part : parts_of_rising_noise(4.0, kSteep, 100 + seed)) {
      Floor slow;
      part.add_to(slow);
      sum += std::log(slow.density(0.1) / slow.density(1.0)) / std::log(10.0);
    }
  }
  EXPECT_NEAR(sum / (3.0 * kTrials), kSteep, 0.2);
}

// 25 times the floor below 0.3 Hz, a deviation of a quarter of the noise's: no drift, step or
// contact makes it, and the name stands beside it.
TEST(SlowNoise, IsNoEventAndHidesNoName) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(configuration(Json::array(
      {hidden("gravity_tilt", nullptr, {{"tilt_x_rad", 0.008}, {"tilt_y_rad", -0.006}})})));
  Rng rng({31});
  change(bench, [&](Recording& log) {
    for (const char* axis : {"fx", "fy", "fz"}) {
      const Eigen::VectorXd& force = log.column(axis);
      log.set(axis, force + 0.04 * markov_noise(force.size(), 25.0, 0.3, rng));
    }
  });
  const Json report = bench.diagnose().report;
  EXPECT_EQ(found(report), std::set<std::string>{"gravity_tilt"}) << report["findings"].dump(1);
  EXPECT_EQ(report["verdict"], "explained");
  EXPECT_TRUE(report["refuted"].empty()) << report["refuted"].dump(1);
}

// Each makes half of what is left: a spectrum like theirs is less likely than they are.
TEST(SlowNoise, IsNotTwoSteps) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  const Bench bench(configuration(Json::array()));
  Recording log = read_recording(bench / "fit.csv", ReadOptions(), System());
  const Eigen::ArrayXd t = log.column("t").array() - log.column("t")(0);
  log.set("fx", log.column("fx") + 0.25 * (t > 6.0).cast<double>().matrix());
  log.set("fy", log.column("fy") - 0.3 * (t > 13.0).cast<double>().matrix());
  write_csv(bench / "fit.csv", log.table);
  const Json report = bench.diagnose(false).report;
  EXPECT_EQ(test::names(report), (std::vector<std::string>{"step_bias", "step_bias"}))
      << report["findings"].dump(1);
}

}  // namespace
}  // namespace dcnn
