// SPDX-License-Identifier: Apache-2.0
// A sensor whose noise is a hundredth of the residual of any law: it averages over a second, which
// is no first-order lag, and its zero drifts.
#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "diagnosis/support.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

constexpr double kPreciseStep = 0.1, kPreciseNoise = 5e-4;  // s, N
constexpr Index kAveraged = 11;                             // rows

/// Turned by smooth moves to new orientations and held there.
Table precise_readings(Index rows, std::uint64_t seed) {
  Rng rng({seed});
  Eigen::MatrixXd angles(rows, 2);
  Eigen::Vector2d from = Eigen::Vector2d::Zero(), to = from;
  for (Index k = 0, begun = 0, length = 1; k < rows; ++k) {
    if (k >= begun + 2 * length) {  // half of the time at rest
      from = to;
      to = Eigen::Vector2d(rng.uniform(-0.35, 0.35), rng.uniform(-0.35, 0.35));
      begun = k;
      length = static_cast<Index>(rng.uniform(20.0, 50.0));
    }
    const double share = std::min(1.0, double(k - begun) / double(length));
    angles.row(k) = (from + (to - from) * 0.5 * (1.0 - std::cos(M_PI * share))).transpose();
  }
  Eigen::MatrixXd wrench(rows, 6);
  Table log{{"t", "qw", "qx", "qy", "qz", "fx", "fy", "fz", "tx", "ty", "tz"},
            Eigen::MatrixXd(rows, 11)};
  const Eigen::Vector3d com(-0.0006, 0.0, 0.048);
  Eigen::Vector3d rate = Eigen::Vector3d::Zero(), wander = rate;
  for (Index k = 0; k < rows; ++k) {
    const double t = kPreciseStep * static_cast<double>(k);
    const Eigen::Quaterniond q = Eigen::AngleAxisd(angles(k, 1), Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(2.3 + angles(k, 0), Eigen::Vector3d::UnitX());
    const Eigen::Vector3d weight = q.conjugate() * Eigen::Vector3d(0.0, 0.0, -1.16 * 9.80665);
    wrench.row(k) << weight.transpose(), com.cross(weight).transpose();
    const Index first = std::max<Index>(0, k - kAveraged + 1);
    for (int c = 0; c < 3; ++c) {
      rate(c) = 0.9 * rate(c) + 2e-4 * rng.normal();
      wander(c) = 0.998 * wander(c) + rate(c);
    }
    const Eigen::RowVectorXd mean = wrench.middleRows(first, k - first + 1).colwise().mean();
    Eigen::RowVectorXd read(6);  // and a bridge that bends with the load across it
    read << -3.1, -4.7, -16.7 + 0.25 * std::exp(-t / 40.0), 0.005, -0.061, 0.006;
    read.head(3) += wander.transpose();
    read(0) += 0.02 * mean(1) * mean(1) / 11.4;
    read(1) -= 0.03 * mean(0) * std::abs(mean(0)) / 11.4;
    for (int c = 0; c < 6; ++c) read(c) += (c < 3 ? 1.0 : 0.1) * kPreciseNoise * rng.normal();
    log.values.row(k) << t, q.w(), q.x(), q.y(), q.z(), mean + read;
  }
  return log;
}

TEST(Swamped, NamesOfAPreciseSensorAreNotRefutedByWhatNoLawLeavesOut) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  test::TemporaryFolder folder;
  write_csv(folder / "fit.csv", precise_readings(1200, 2));
  write_csv(folder / "hold.csv", precise_readings(550, 3));
  write_file(folder / "sim.json", Json{{"tool",
                                        {{"mass_kg", 1.1},
                                         {"com_m", {0.0, 0.0, 0.052}},
                                         {"inertia_kgm2", {0.004, 0.004, 0.001, 0.0, 0.0, 0.0}}}}}
                                      .dump());
  DiagnosisRequest request;
  request.simulator = folder / "sim.json";
  request.fit = {folder / "fit.csv"};
  request.holdout = {folder / "hold.csv"};
  const Json report = diagnose(request, nullptr).report;
  const auto names = test::found(report);
  EXPECT_TRUE(names.count("bias")) << report["findings"].dump(1);
  EXPECT_TRUE(names.count("lowpass") || names.count("time_delay")) << report["findings"].dump(1);
  for (const Json& after : report["fit"]["holdout_rmse_after"]) {
    EXPECT_LT(after.get<double>(), 0.08) << "16 N as given";
  }
}

}  // namespace
}  // namespace dcnn
