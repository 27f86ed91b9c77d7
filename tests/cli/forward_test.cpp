// SPDX-License-Identifier: Apache-2.0
// From a log of an oscillator to a simulator that moves like it, by the programs.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "data/testing.h"
#include "dcnn/core/file.h"
#include "dcnn/core/random.h"
#include "dcnn/data/csv.h"
#include "support/process.h"

namespace dcnn {
namespace {

using test::run;
using testing::contains;

constexpr double kNoise = 2e-4;

/// 20 s at 400 Hz of 0.5 a + 5 v + 900 q + 4000 q^3 = u, by Runge and Kutta in tenths of a sample.
void write_oscillator(const std::filesystem::path& file, double phase, std::uint64_t seed) {
  const auto drive = [&](double t) {
    double u = 0.0;
    for (int k = 1; k <= 12; ++k) {
      u += 14.0 * std::sin(2.0 * std::numbers::pi * 0.93 * k * t + phase * k * k);
    }
    return u;
  };
  const auto rate = [&](double t, const Eigen::Vector2d& x) {
    const double q = x(0), v = x(1);
    return Eigen::Vector2d(v, (drive(t) - 5.0 * v - 900.0 * q - 4000.0 * q * q * q) / 0.5);
  };
  Rng rng({seed});
  Table table;
  table.columns = {"t", "u", "y"};
  table.values.resize(8000, 3);
  Eigen::Vector2d x = Eigen::Vector2d::Zero();
  constexpr double kStep = 2.5e-4;
  for (Eigen::Index i = 0; i < 8000; ++i) {
    double t = 0.0025 * double(i);
    table.values.row(i) << t, drive(t), x(0) + kNoise * rng.normal();
    for (int k = 0; k < 10; ++k, t += kStep) {
      const Eigen::Vector2d a = rate(t, x), b = rate(t + kStep / 2, x + kStep / 2 * a),
                            c = rate(t + kStep / 2, x + kStep / 2 * b),
                            d = rate(t + kStep, x + kStep * c);
      x += kStep / 6.0 * (a + 2.0 * b + 2.0 * c + d);
    }
  }
  write_csv(file, table);
}

class ForwardPrograms : public ::testing::Test {
 protected:
  void SetUp() override {
    write_oscillator(folder_ / "fit.csv", 0.7, 1);
    write_oscillator(folder_ / "test.csv", 1.9, 2);
    write_file(folder_ / "system.json",
               R"({"kind": "axes", "axes": [{"name": "mass", "measured": "u",
      "unit": "N", "position": "y", "base": ["acceleration", "velocity", "position"]}]})");
  }
  std::string at(const std::string& name) const { return (folder_ / name).string(); }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(ForwardPrograms, ALogBecomesASimulatorThatMovesLikeIt) {
  const auto diagnosed = run("diagnose", {"-q", "--system", at("system.json"), "--fit",
                                          at("fit.csv"), "--out", at("report")});
  ASSERT_EQ(diagnosed.exit_code, 0) << diagnosed.err;
  ASSERT_TRUE(contains(diagnosed.out, "\nfound       cubic spring, mass")) << diagnosed.out;
  const auto refined = run("forward", {"-q", "--json", at("report/model.json"), "--fit",
                                       at("fit.csv"), "--save", at("refined.json")});
  ASSERT_EQ(refined.exit_code, 0) << refined.err;
  const Json numbers = Json::parse(refined.out)["numbers"];
  for (const Json& number : numbers) {
    if (number["name"] != "cubic_spring k3 [N/m^3]") continue;
    EXPECT_NEAR(number["after"].get<double>(), 4000.0, 4.0 * number["deviation"].get<double>());
    EXPECT_LT(number["deviation"].get<double>(), 60.0);
  }
  const auto simulated = run("forward", {"-q", "--json", at("refined.json"), "--data",
                                         at("test.csv"), "--out", at("simulated.csv")});
  ASSERT_EQ(simulated.exit_code, 0) << simulated.err;
  const Json summary = Json::parse(simulated.out);
  EXPECT_LT(summary["rmse_settled"].get<double>(), 1.1 * kNoise);  // the noise of what was logged
  EXPECT_EQ(summary["position_unit"], "m");
  EXPECT_EQ(read_csv(at("simulated.csv")).columns,
            (std::vector<std::string>{"t", "u", "y", "y_hat"}));
}

TEST_F(ForwardPrograms, SaysWhatIsWrong) {
  const auto nothing = run("forward", {at("system.json")});
  EXPECT_EQ(nothing.exit_code, 2);
  EXPECT_TRUE(contains(nothing.err, "give --data to simulate, --fit to refine, or both"));
  const auto foreign = run("forward", {at("system.json"), "--data", at("test.csv")});
  EXPECT_EQ(foreign.exit_code, 4) << foreign.err;
  const auto save =
      run("forward", {at("system.json"), "--data", at("test.csv"), "--save", at("other.json")});
  EXPECT_EQ(save.exit_code, 2) << save.err;
}

}  // namespace
}  // namespace dcnn
