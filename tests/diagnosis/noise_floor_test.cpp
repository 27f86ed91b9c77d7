// SPDX-License-Identifier: Apache-2.0
// Floors against simulated noise of a known spectrum.
#include "diagnosis/noise_floor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dcnn/core/random.h"

namespace dcnn {
namespace {

constexpr double kDt = 0.004;
constexpr Index kRows = 5000;

/// Recordings of one channel, of which only the clock matters.
Case recordings_of(int count) {
  Case study;
  study.channels = {0};
  for (int k = 0; k < count; ++k) {
    Log log;
    log.motion.dt = kDt;
    log.motion.t = Eigen::VectorXd::LinSpaced(kRows, 0.0, kDt * (kRows - 1));
    log.motion.segments = {{0, kRows}};
    log.motion.R_BS.resize(kRows);
    log.measured = Eigen::MatrixXd::Zero(kRows, 1);
    study.logs.push_back(std::move(log));
  }
  return study;
}

/// AR(1) of unit variance.
Signals noise_of(int count, double rho, Rng& rng) {
  Signals signals;
  for (int k = 0; k < count; ++k) {
    Eigen::MatrixXd x(kRows, 1);
    double at = rng.normal();
    for (Index i = 0; i < kRows; ++i) {
      x(i, 0) = at;
      at = rho * at + std::sqrt(1.0 - rho * rho) * rng.normal();
    }
    signals.push_back(x);
  }
  return signals;
}

Signals ones(int count) { return Signals(std::size_t(count), Eigen::MatrixXd::Ones(kRows, 1)); }

double true_density(double rho, double hz) {
  return (1.0 - rho * rho) /
         (1.0 - 2.0 * rho * std::cos(2.0 * std::numbers::pi * hz * kDt) + rho * rho);
}

// What the band above the motion (20 Hz) hardly tells of the noise at 1 Hz, all of it does.
TEST(NoiseFloor, OfAllThatIsLeftHasTheDensityOfTheNoise) {
  const Case study = recordings_of(4);
  for (const double rho : {0.0, 0.64, 0.9}) {
    int refuted = 0;
    double square = 0.0;
    constexpr int kTrials = 40;
    for (int seed = 0; seed < kTrials; ++seed) {
      Rng rng(static_cast<std::uint64_t>(100 + seed));
      const auto floors =
          noise_of_all(study, noise_of(4, rho, rng), ones(4), std::vector<Floor>(1));
      if (!floors) {
        ++refuted;
        continue;
      }
      for (const double hz : {1.0, 4.0, 30.0}) {
        square += std::pow(std::log(floors->front().density(hz) / true_density(rho, hz)), 2) / 3.0;
      }
    }
    EXPECT_LE(refuted, 1) << rho;  // 0.1 % of them by chance
    EXPECT_LT(std::sqrt(square / kTrials), 0.15) << rho;
  }
}

/// Noise of deviation 0.03 (1 + |F|/knee) (1 + uneven sign F) beside a force F of
/// 0.05 + 2 sin(2 pi hz t); the force, and the levels.
std::pair<Eigen::VectorXd, Eigen::VectorXd> levels_beside(double hz, double knee, double uneven,
                                                          std::uint64_t seed) {
  Case study = recordings_of(1);
  Rng rng({seed});
  Signals residual{Eigen::MatrixXd(kRows, 1)};
  for (Index i = 0; i < kRows; ++i) {
    const double phase = 2.0 * std::numbers::pi * hz * kDt * static_cast<double>(i);
    const double force = 0.05 + 2.0 * std::sin(phase);
    const double level = (1.0 + std::copysign(uneven, force)) * (1.0 + std::abs(force) / knee);
    residual[0](i, 0) = 0.03 * level * rng.normal();
    study.logs[0].measured(i, 0) = force + residual[0](i, 0);
  }
  return {study.logs[0].measured.col(0), noise_level(study, residual)[0].col(0)};
}

// Windows of a steady oscillation have nearly one mean load, whose small differences tell no power
// of it: here every other window of half a second holds two half-waves above zero.
TEST(NoiseLevel, OfASteadyOscillationIsNotMadeOfChance) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto levels = levels_beside(3.0, 1e9, 0.5, seed).second;
    EXPECT_LT(levels.maxCoeff(), 3.0) << seed;
    EXPECT_GT(levels.minCoeff(), 0.3) << seed;
  }
}

TEST(NoiseLevel, GrowsWithALoadThatTakesItsTime) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const auto [force, levels] = levels_beside(0.07, 0.5, 0.0, seed);
    double high = 0.0, low = 0.0, highs = 0.0, lows = 0.0;
    for (Index i = 0; i < kRows; ++i) {
      const double load = std::abs(force(i));
      if (load > 1.8) high += levels(i), ++highs;
      if (load < 0.2) low += levels(i), ++lows;
    }
    EXPECT_NEAR(high / highs / (low / lows), 4.8 / 1.2, 0.8) << seed;
  }
}

/// A line at 55 Hz is noise: part of the deviation, and of no band of the motion.
TEST(NoiseFloor, HoldsLinesAboveTheMotion) {
  const Case study = recordings_of(2);
  constexpr double kHz = 55.0, kWidth = 0.2;
  const double r = std::exp(-std::numbers::pi * kWidth * kDt);
  const double turn = 2.0 * r * std::cos(2.0 * std::numbers::pi * kHz * kDt);
  double deviation = 0.0, density = 0.0, without = 0.0;
  constexpr int kTrials = 20;
  for (int seed = 0; seed < kTrials; ++seed) {
    Rng rng(static_cast<std::uint64_t>(900 + seed));
    Signals noise = noise_of(2, 0.0, rng);
    without += noise_floor(study, noise, ones(2)).front().deviation() / kTrials;
    for (auto& x : noise) {
      Eigen::VectorXd ring = Eigen::VectorXd::Zero(kRows);
      for (Index i = 2; i < kRows; ++i)
        ring(i) = turn * ring(i - 1) - r * r * ring(i - 2) + rng.normal();
      x.col(0) += 0.8 * std::sqrt(double(kRows)) / ring.norm() * ring;
    }
    const Floor floor = noise_floor(study, noise, ones(2)).front();
    deviation += floor.deviation() / kTrials;
    density += floor.density(5.0) / kTrials;
  }
  EXPECT_NEAR(without, 1.0, 0.02);
  EXPECT_NEAR(deviation, std::sqrt(1.0 + 0.8 * 0.8), 0.06);
  EXPECT_NEAR(density, 1.0, 0.1);
}

// A sensor whose noise is thirty times as loud while it moves as while it stops, half a second
// each, beside an offset and a slow error of the law of a thousand times the noise: neither is
// noise.
TEST(NoiseFloor, TakesNoErrorOfALawForNoiseWhereTheLevelSteps) {
  const Case study = recordings_of(2);
  constexpr double kLoud = 30.0, kOffset = 1000.0, kSlowHz = 0.2;
  constexpr Index kStop = 125;  // rows
  Rng rng(7);
  Signals residual = noise_of(2, 0.0, rng);
  const double unit = std::sqrt(0.5 * (1.0 + kLoud * kLoud));  // levels have an rms of 1
  Signals levels = ones(2);
  for (std::size_t k = 0; k < residual.size(); ++k) {
    for (Index i = 0; i < kRows; ++i) {
      levels[k](i, 0) = (i / kStop % 2 == 0 ? 1.0 : kLoud) / unit;
      residual[k](i, 0) *= levels[k](i, 0);
      const double phase = 2.0 * std::numbers::pi * kSlowHz * kDt * static_cast<double>(i);
      residual[k](i, 0) += kOffset * (1.0 + std::sin(phase));
    }
  }
  const Floor floor = noise_floor(study, residual, levels).front();
  EXPECT_NEAR(floor.deviation(), 1.0, 0.05);
}

TEST(NoiseFloor, ExceedsWhatIsLeftOnlyWhereItDoes) {
  const Case study = recordings_of(4);
  int falsely = 0, rightly = 0;
  constexpr int kTrials = 100;
  for (int seed = 0; seed < kTrials; ++seed) {
    Rng rng(static_cast<std::uint64_t>(500 + seed));
    const Signals noise = noise_of(4, 0.64, rng);
    const Periodograms p = periodograms(study, noise, 0);
    const Eigen::VectorXd density = density_of(p);
    const auto slow = slow_bins(study, noise, 0);
    Floor floor{.coloured = 1.0, .rho = 0.64};
    floor.dt = kDt;
    falsely += exceeds(floor, p, density, slow);
    floor.coloured = 1.5;
    rightly += exceeds(floor, p, density, slow);
  }
  EXPECT_LE(falsely, 3);  // 0.1 % in each of nine octaves
  EXPECT_GE(rightly, 95);
}

// The error of a reading in steps is as slow as the reading: above the motion's band little of it
// shows.
TEST(NoiseFloor, OfRoundedReadingsHoldsTheirRounding) {
  constexpr double kStep = 1.0, kNoise = 0.09;
  Case study = recordings_of(2);
  study.rounding_step = kStep;
  study.rounding_noise = kNoise;
  Rng rng(7);
  Signals left;
  double square = 0.0;
  for (int k = 0; k < 2; ++k) {
    Eigen::MatrixXd x(kRows, 1);
    for (Index i = 0; i < kRows; ++i) {
      const double turn = 2.0 * std::numbers::pi * kDt * double(i);
      const double force = 2.0 * std::sin(0.1 * turn + k) + 1.5 * std::sin(0.17 * turn);
      x(i, 0) = kStep * std::round((force + kNoise * rng.normal()) / kStep) - force;
    }
    square += x.squaredNorm() / (2.0 * kRows);
    left.push_back(x);
  }
  std::vector<Floor> floors = noise_floor(study, left, ones(2));
  EXPECT_LT(floors.front().deviation(), 0.8 * std::sqrt(square));
  add_rounding(study, floors);
  EXPECT_NEAR(floors.front().deviation() / std::sqrt(square), 1.0, 0.05);
}

// Many sensors filter what they send: a plateau and a fall of two orders are no first-order colour.
TEST(NoiseFloor, OfTorquesHoldsNoRoundingOfForces) {
  Case study = recordings_of(1);
  study.channels = {2, 3};
  study.rounding_step = 0.05;
  study.rounding_noise = 0.01;
  Floor floor;
  floor.white = 1e-6;
  floor.dt = kDt;
  std::vector<Floor> floors(2, floor);
  add_rounding(study, floors);
  EXPECT_GT(floors[0].rounding, 1e-4);
  EXPECT_EQ(floors[1].rounding, 0.0);
}

TEST(NoiseFloor, ThePowerOfARecordingSpreadsAsItsSpectrumTells) {
  constexpr int kRecordings = 400;
  const double seconds = kDt * kRows;
  for (const double rho : {0.0, 0.995}) {
    Floor floor;
    floor.dt = kDt;
    (rho > 0.0 ? floor.coloured : floor.white) = 1.0;
    floor.rho = rho;
    Rng rng({31u});
    double sum = 0.0, squares = 0.0;
    for (const Eigen::MatrixXd& x : noise_of(kRecordings, rho, rng)) {
      const double power = x.squaredNorm() / kRows;
      sum += power;
      squares += power * power;
    }
    const double mean = sum / kRecordings,
                 deviation = std::sqrt(squares / kRecordings - mean * mean) / mean;
    // A deviation of 400 numbers is known to 3.5 %.
    EXPECT_NEAR(floor.power_deviation(seconds) / deviation, 1.0, 0.15) << rho;
  }
}

// Between rows of a jittering clock interpolation takes noise off, above the motion more than
// within.
TEST(NoiseFloor, OfInterpolatedRowsIsThatOfTheRowsBefore) {
  Case study = recordings_of(2);
  double density = 0.0, deviation = 0.0, square = 0.0, true_density = 0.0;
  constexpr int kTrials = 10;
  for (int seed = 0; seed < kTrials; ++seed) {
    Rng rng(static_cast<std::uint64_t>(60 + seed));
    Signals noise;
    for (Log& log : study.logs) {
      Eigen::MatrixXd x(kRows, 1);
      double at = rng.normal(), next = rng.normal(), own = 0.0, shared = 0.0, before = 0.0;
      for (Index i = 0; i < kRows; ++i, at = next, next = rng.normal()) {
        const double part = rng.uniform(0.0, 1.0);
        x(i, 0) = (1.0 - part) * at + part * next;
        own += ((1.0 - part) * (1.0 - part) + part * part) / kRows;
        shared += before * (1.0 - part) / kRows;
        before = part;
      }
      log.recording.interpolated = {own, shared};
      true_density += (own + 2.0 * shared) / (2.0 * kTrials);
      square += x.squaredNorm() / (2.0 * kTrials * kRows);
      noise.push_back(x);
    }
    const Floor floor = noise_floor(study, noise, ones(2)).front();
    density += floor.density(2.0) / kTrials;
    deviation += floor.deviation() / kTrials;
  }
  EXPECT_NEAR(density / true_density, 1.0, 0.05);
  EXPECT_NEAR(deviation / std::sqrt(square), 1.0, 0.02);
}

TEST(NoiseFloor, OfAFilteredSensorIsThatOfItsPlateau) {
  constexpr double kCutoff = 45.0;  // Hz
  constexpr int kInside = 8;        // samples that the sensor filters for each that it sends
  const Case study = recordings_of(2);
  // Second-order Butterworth filter by the bilinear transform.
  const double k = std::tan(std::numbers::pi * kCutoff * kDt / kInside), q = std::numbers::sqrt2;
  const double a0 = 1.0 + q * k + k * k, b = k * k / a0;
  const double a1 = 2.0 * (k * k - 1.0) / a0, a2 = (1.0 - q * k + k * k) / a0;
  double density = 0.0, deviation = 0.0, square = 0.0;
  constexpr int kTrials = 10;
  for (int seed = 0; seed < kTrials; ++seed) {
    Rng rng(static_cast<std::uint64_t>(40 + seed));
    Signals noise;
    for (int log = 0; log < 2; ++log) {
      Eigen::VectorXd u(kInside * kRows), y = Eigen::VectorXd::Zero(u.size());
      for (double& e : u) e = std::sqrt(double(kInside)) * rng.normal();
      for (Index i = 2; i < u.size(); ++i) {
        y(i) = b * (u(i) + 2.0 * u(i - 1) + u(i - 2)) - a1 * y(i - 1) - a2 * y(i - 2);
      }
      noise.emplace_back(y(Eigen::seqN(0, kRows, kInside)));
      square += noise.back().squaredNorm() / (2.0 * kTrials * kRows);
    }
    const Floor floor = noise_floor(study, noise, ones(2)).front();
    density += floor.density(2.0) / kTrials;
    deviation += floor.deviation() / kTrials;
  }
  EXPECT_NEAR(density, 1.0, 0.06);
  EXPECT_NEAR(deviation / std::sqrt(square), 1.0, 0.03);
}

}  // namespace
}  // namespace dcnn
