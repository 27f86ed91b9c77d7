// SPDX-License-Identifier: Apache-2.0
// A sensor whose filter lags by half a second and whose axes leak into each other, turned slowly
// and held: next to what these explain a faint force without a name and an offset that wanders.
#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "diagnosis/support.h"
#include "support/sanitizer.h"

namespace dcnn {
namespace {

constexpr Index kHeldRows = 1750;
constexpr double kHeldStep = 0.1, kFilterLag = 0.6;  // s

/// Holds of 2 to 9 s between turns of 2.5 to 6 s within these angles [rad].
Eigen::VectorXd held_and_turned(double low, double high, Rng& rng) {
  Eigen::VectorXd angle(kHeldRows);
  double now = rng.uniform(low, high);
  for (Index k = 0; k < kHeldRows;) {
    for (auto n = static_cast<Index>(rng.uniform(20.0, 90.0)); n > 0 && k < kHeldRows; --n)
      angle(k++) = now;
    const double next = rng.uniform(low, high), rows = std::floor(rng.uniform(25.0, 60.0));
    for (double n = 0.0; n < rows && k < kHeldRows; ++n)
      angle(k++) = now + (next - now) * 0.5 * (1.0 - std::cos(M_PI * n / rows));
    now = next;
  }
  return angle;
}

Table filtered_readings(std::uint64_t seed) {
  Rng rng({seed});
  const Eigen::VectorXd a = held_and_turned(-0.25, 0.25, rng), b = held_and_turned(-0.3, 0.3, rng);
  Eigen::Matrix3d leaks;
  leaks << 1.03, 0.006, -0.024, 0.013, 1.053, 0.0, -0.042, -0.005, 1.06;
  Table log{{"t", "qw", "qx", "qy", "qz", "fx", "fy", "fz"}, Eigen::MatrixXd(kHeldRows, 8)};
  Eigen::Vector3d read = Eigen::Vector3d::Zero(), wander = Eigen::Vector3d::Zero();
  for (Index k = 0; k < kHeldRows; ++k) {
    const Eigen::Quaterniond q = Eigen::AngleAxisd(b(k), Eigen::Vector3d::UnitY()) *
                                 Eigen::AngleAxisd(2.27 + a(k), Eigen::Vector3d::UnitX());
    const Eigen::Vector3d force = leaks * (q.conjugate() * Eigen::Vector3d(0.0, 0.0, -1.12 * 9.81));
    read = k == 0
               ? force
               : Eigen::Vector3d(read + (force - read) * (1.0 - std::exp(-kHeldStep / kFilterLag)));
    for (int c = 0; c < 3; ++c) wander(c) = 0.998 * wander(c) + 6e-4 * rng.normal();
    Eigen::Vector3d f = read + wander + Eigen::Vector3d(-2.5, -4.8, -16.5);
    if (b(k) > 0.05) f(1) += 0.05 * std::tanh((b(k) - 0.1) / 0.05);
    for (int c = 0; c < 3; ++c) f(c) += 6e-4 * rng.normal();
    log.values.row(k) << kHeldStep * static_cast<double>(k), q.w(), q.x(), q.y(), q.z(),
        f.transpose();
  }
  return log;
}

TEST(FilteredSensor, ItsLagIsKeptBesideWhatHasNoName) {
  if (test::kSanitized) GTEST_SKIP() << "optimised builds run all";
  test::TemporaryFolder folder;
  write_csv(folder / "log.csv", filtered_readings(1));
  write_file(folder / "sim.json", Json{{"tool", {{"mass_kg", 1.09}, {"com_m", {0.0, 0.0, 0.05}}}},
                                       {"sensor", {{"bias_n", {-2.5, -4.75, -16.5}}}}}
                                      .dump());
  DiagnosisRequest request;
  request.simulator = folder / "sim.json";
  request.fit = {folder / "log.csv"};
  const Json report = diagnose(request, nullptr).report;
  EXPECT_TRUE(test::found(report).count("lowpass")) << report["findings"].dump(1);
  EXPECT_TRUE(test::found(report).count("crosstalk")) << report["findings"].dump(1);
  for (const Json& after : report["fit"]["holdout_rmse_after"]) {
    EXPECT_LT(after.get<double>(), 0.05) << "0.6 N as given";
  }
}

}  // namespace
}  // namespace dcnn
