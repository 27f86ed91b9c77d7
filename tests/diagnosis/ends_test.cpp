// SPDX-License-Identifier: Apache-2.0
// The ends of recordings, where a smoother passes fast motion in part: nothing is judged there.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dcnn/data/rotation.h"
#include "diagnosis/support.h"

namespace dcnn {
namespace {

constexpr double kToolMass = 0.75, kForceNoise = 0.04;  // of test::configuration()

/// A machine's vibration along the base's z axis [m], and the force that it makes of the tool.
void shake(Recording& log, double hz, double metres) {
  const double w = 2.0 * std::numbers::pi * hz;
  const Eigen::VectorXd t = log.column("t");
  const auto R = rotations(log);
  Eigen::VectorXd z = log.column("z");
  Eigen::MatrixXd f = log.block({"fx", "fy", "fz"});
  for (Index k = 0; k < t.size(); ++k) {
    const double swing = metres * (1.0 + 0.4 * std::sin(1.3 * t(k))) * std::sin(w * t(k));
    z(k) += swing;
    const Eigen::Vector3d force = R[static_cast<std::size_t>(k)].transpose() *
                                  Eigen::Vector3d(0, 0, kToolMass * w * w * swing);
    f.row(k) += force.transpose();
  }
  log.set("z", z);
  log.set("fx", f.col(0));
  log.set("fy", f.col(1));
  log.set("fz", f.col(2));
}

double greatest(const Json& list) {
  double most = 0.0;
  for (const Json& value : list) most = std::max(most, value.get<double>());
  return most;
}

/// The report on recordings of 12 s of which the held-out one, or both, vibrate at 17 Hz.
Json report_of_shaken(bool both) {
  Json configuration = test::configuration(Json::array());
  for (Json& r : configuration["recordings"]) r["samples"] = 6000;
  const test::Bench bench(configuration);
  test::change(bench, [&](Recording& log) {
    if (both || log.name == "hold.csv") shake(log, 17.0, 4e-5);
  });
  return bench.diagnose().report;
}

TEST(Ends, AVibrationOfTheHeldOutRecordingAloneRefutesNothing) {
  const Json report = report_of_shaken(false);
  EXPECT_EQ(report["verdict"], "consistent") << report["findings"].dump(1);
  EXPECT_LT(greatest(report["fit"]["holdout_rmse_after"]), 1.2 * kForceNoise);
}

TEST(Ends, AVibrationIsNoNoise) {
  const Json report = report_of_shaken(true);
  EXPECT_EQ(report["verdict"], "consistent") << report["findings"].dump(1);
  EXPECT_LT(greatest(report["fit"]["noise_floor"]), 1.1 * kForceNoise);
  EXPECT_LT(greatest(report["fit"]["holdout_rmse_after"]), 1.2 * kForceNoise);
}

}  // namespace
}  // namespace dcnn
