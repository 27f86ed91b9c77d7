// SPDX-License-Identifier: Apache-2.0
// Rates that a driver made of differences, or filtered, and logged too late.
#include "diagnosis/lagging_rates.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "dcnn/diagnosis/diagnose.h"
#include "support/process.h"

namespace dcnn {
namespace {

constexpr double kLoggedStep = 0.002;  // s

double place(double t) { return 0.3 * std::sin(4.0 * t) + 0.1 * std::sin(11.0 * t + 1.0); }
double speed(double t) { return 1.2 * std::cos(4.0 * t) + 1.1 * std::cos(11.0 * t + 1.0); }

/// A slide of 2 kg with friction, its rate logged `late` [s] and with noise.
Table slide(double late, double noise, std::uint64_t seed) {
  Table table{{"t", "x", "v", "f"}, Eigen::MatrixXd(8000, 4)};
  Rng rng({seed});
  for (Index i = 0; i < table.values.rows(); ++i) {
    const double t = kLoggedStep * static_cast<double>(i);
    const double a = -4.8 * std::sin(4.0 * t) - 12.1 * std::sin(11.0 * t + 1.0);
    table.values.row(i) << t, place(t), speed(t - late) + noise * rng.normal(),
        2.0 * a + 6.0 * std::tanh(speed(t) / 0.004) + 3.0 * speed(t) + 0.5 * rng.normal();
  }
  return table;
}

class LaggingRates : public testing::Test {
 protected:
  std::filesystem::path written(const std::string& name, const Table& table) const {
    write_csv(folder_ / name, table);
    return folder_ / name;
  }
  std::filesystem::path system() const {
    write_file(folder_ / "slide.json", R"({"kind": "axes", "axes": [{"name": "slide",
      "measured": "f", "unit": "N", "position": "x", "velocity": "v", "base": ["acceleration"]}]})");
    return folder_ / "slide.json";
  }
  RateSums sums_of(const std::filesystem::path& log) const {
    const System described = read_system(system());
    return rate_sums({read_recording(log, {}, described)}, described.axes[0], 20.0);
  }
  double lag_of(double late, double noise) const {
    const auto path = written("log.csv", slide(late, noise, 1));
    return rate_lag({sums_of(path)}, kLoggedStep);
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(LaggingRates, AreToldByTheDerivativeOfThePosition) {
  EXPECT_NEAR(lag_of(0.004, 0.01), 0.004, 1e-4);
  EXPECT_EQ(lag_of(0.0, 0.01), 0.0);
  EXPECT_EQ(lag_of(-0.004, 0.01), 0.0);  // ahead of its position
  EXPECT_EQ(lag_of(0.0005, 0.0), 0.0);   // less than a difference of two rows is late
}

// Of a rate whose noise hides its lag the driver's other rates tell it.
TEST_F(LaggingRates, AreThoseOfOneDriver) {
  const RateSums clear = sums_of(written("clear.csv", slide(0.004, 0.01, 4)));
  const RateSums noisy = sums_of(written("noisy.csv", slide(0.004, 0.3, 5)));
  EXPECT_EQ(rate_lag({noisy}, kLoggedStep), 0.0);
  EXPECT_NEAR(rate_lag({clear, noisy}, kLoggedStep), 0.004, 1e-4);
  const RateSums timely = sums_of(written("timely.csv", slide(0.0, 0.01, 6)));
  EXPECT_EQ(rate_lag({timely, timely, clear}, kLoggedStep), 0.0);
}

// Beside the late rate the reading would seem to lead the motion.
TEST_F(LaggingRates, AreDerivedOfThePosition) {
  DiagnosisRequest request;
  request.system = system();
  request.fit = {written("fit.csv", slide(0.004, 0.01, 2))};
  request.holdout = {written("hold.csv", slide(0.004, 0.01, 3))};
  const Json report = diagnose(request, nullptr).report;
  ASSERT_EQ(report["findings"].size(), 2u) << report["findings"].dump(1);
  EXPECT_EQ(report["findings"][0]["effect"], "coulomb_friction");
  EXPECT_EQ(report["findings"][1]["effect"], "viscous_friction");
  EXPECT_EQ(report["notes"][0],
            "fit.csv: v lags 3.99 ms behind the derivative of x, which is used in its place");
}

}  // namespace
}  // namespace dcnn
