// SPDX-License-Identifier: Apache-2.0
// The diagnosis on simulated recordings in which an effect of the catalogue was hidden.
#include "dcnn/diagnosis/diagnose.h"

#include <gtest/gtest.h>

#include <map>

#include "dcnn/experiment/diagnosis_report.h"
#include "diagnosis/support.h"
#include "support/page.h"

namespace dcnn {
namespace {

using test::Bench;
using test::configuration;
using test::names;

TEST(Diagnose, SaysThatNothingIsMissing) {
  const Json report = Bench(configuration(Json::array())).diagnose().report;
  EXPECT_EQ(report["verdict"], "consistent");
  EXPECT_TRUE(report["findings"].empty()) << report["findings"].dump();
  EXPECT_GT(report["not_detected"].size(), 8U);
  for (const Json& floor : report["fit"]["noise_floor"]) {
    EXPECT_NEAR(floor.get<double>(), 0.04, 0.002);
  }
}

TEST(Diagnose, TakesApartTwoEffectsAndShowsTheErrorFall) {
  const Bench bench(configuration(
      {{{"effect", "coulomb_friction"},
        {"axis", "tool_z"},
        {"parameters", {{"fc_n", 0.06}, {"v0_mps", 0.01}}}},
       {{"effect", "mass"}, {"axis", nullptr}, {"parameters", {{"delta_mass_kg", 0.01}}}}}));
  const Diagnosis diagnosis = bench.diagnose();
  const Json& report = diagnosis.report;
  EXPECT_EQ(report["verdict"], "explained");
  auto found = names(report);
  std::sort(found.begin(), found.end());
  ASSERT_EQ(found, (std::vector<std::string>{"coulomb_friction", "mass"}));
  for (const Json& f : report["findings"]) {
    for (const auto& [name, p] : f["parameters"].items()) {
      const auto value = p["value"].get<double>();
      EXPECT_LT(p["ci95"][0].get<double>(), value) << name;
      EXPECT_LT(value, p["ci95"][1].get<double>()) << name;
    }
    EXPECT_LT(f["p_value"].get<double>(), 0.01);
    EXPECT_GT(f["holdout_gain"].get<double>(), 0.02);
  }
  const Json& fit = report["fit"];
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_LT(fit["holdout_rmse_after"][j].get<double>(), 0.0415);
  }
  const auto refitted = fit["holdout_rmse_parameters"][2].get<double>();
  EXPECT_GT(fit["holdout_rmse_before"][2].get<double>(), refitted);
  EXPECT_GT(refitted, fit["holdout_rmse_after"][2].get<double>());

  // What the files hold is what dcnn-sim makes of model.json.
  write_file(bench / "out/holdout_1_pred.csv", "of an earlier diagnosis, of two recordings");
  write_file(bench / "out/notes.txt", "somebody's");
  write_diagnosis(bench / "out", diagnosis);
  EXPECT_FALSE(std::filesystem::exists(bench / "out/holdout_1_pred.csv"));
  EXPECT_TRUE(std::filesystem::exists(bench / "out/notes.txt"));
  const Simulator corrected = read_simulator(bench / "out/model.json");
  ReadOptions read;
  const Recording hold = read_recording(bench / "hold.csv", read, System());
  const Recording again = predict_motion(corrected, hold, DerivativeSpec());
  const Table written = read_csv(bench / "out/holdout_0_pred.csv");
  ASSERT_EQ(written.columns, (std::vector<std::string>{"t", "fx", "fy", "fz"}));
  for (const auto& target : {"fx", "fy", "fz"}) {
    const auto column =
        std::find(written.columns.begin(), written.columns.end(), target) - written.columns.begin();
    EXPECT_LT((written.values.col(column) - again.column(target)).cwiseAbs().maxCoeff(), 1e-9);
  }
  const std::string page = test::slurp(bench / "out/report.html");
  test::expect_usable_page(page);
  EXPECT_LT(page.size(), 2'000'000U);
}

TEST(Diagnose, HoldsOutBlocksOfTimeByItself) {
  const Bench bench(configuration(
      {{{"effect", "viscous_friction"}, {"axis", "base_x"}, {"parameters", {{"c_nspm", 0.6}}}}}));
  const Diagnosis diagnosis = bench.diagnose(false);
  EXPECT_EQ(names(diagnosis.report), std::vector<std::string>{"viscous_friction"});
  EXPECT_TRUE(diagnosis.report["holdout_recordings"].empty());
  ASSERT_EQ(diagnosis.holdout.size(), 1U);
  const auto& held = diagnosis.holdout[0].held;
  const auto count = std::count(held.begin(), held.end(), 1);
  EXPECT_EQ(count, 2000);  // four pieces of 1 s in 20 s
  write_diagnosis(bench / "out", diagnosis);
  EXPECT_EQ(read_csv(bench / "out/holdout_0_pred.csv").columns.back(), "held_out");
}

TEST(Diagnose, WorksOnSomebodyElsesSimulator) {
  const Bench bench(configuration({{{"effect", "coulomb_friction"},
                                    {"axis", "base_y"},
                                    {"parameters", {{"fc_n", 0.08}, {"v0_mps", 0.01}}}}}));
  const Json report = bench.diagnose_columns().report;
  EXPECT_EQ(names(report), std::vector<std::string>{"coulomb_friction"})
      << report["findings"].dump(1);
  EXPECT_TRUE(report["fit"]["holdout_rmse_parameters"].is_null());
}

// Sample by sample a parabola over 0.1 s lags: the model names the window with which it errs least.
TEST(Diagnose, AModelKnowsHowItRunsSampleBySample) {
  const Bench bench(
      configuration(Json::array({hidden("viscous_friction", "base_y", {{"c_nspm", 2.0}})})));
  const Diagnosis diagnosis = bench.diagnose();
  const Json& fit = diagnosis.report["fit"];
  Simulator model = parse_simulator(diagnosis.model, "model.json", Exit::kModel);
  ASSERT_TRUE(model.online_derivative);
  const auto streamed = fit["online"]["holdout_rmse"].get<std::vector<double>>(),
             offline = fit["holdout_rmse_after"].get<std::vector<double>>();
  const Recording hold = read_recording(bench / "hold.csv", ReadOptions(), System());
  model.derivative = causal_derivative();
  const Recording parabola = predict_motion(model, hold, DerivativeSpec());
  const std::vector<std::string> axes{"fx", "fy", "fz"};
  for (std::size_t j = 0; j < axes.size(); ++j) {
    const Eigen::VectorXd left = hold.column(axes[j]) - parabola.column(axes[j]);
    EXPECT_LT(streamed[j], 1.6 * offline[j]) << axes[j];
    EXPECT_LT(streamed[j], std::sqrt(left.squaredNorm() / static_cast<double>(left.size())));
  }
  Json noncausal = diagnosis.model;
  noncausal["online_derivative"]["kind"] = "spectral";
  EXPECT_THROW(parse_simulator(noncausal, "model.json", Exit::kModel), Error);
}

// On a lattice as coarse as the noise the largest reading repeats as every other one does.
TEST(Diagnose, CoarseReadingsAreNotHeldAtALimit) {
  const Json coarse{
      {"effect", "quantisation"}, {"axis", nullptr}, {"parameters", {{"step_n", 0.25}}}};
  Json slow = configuration(Json::array({coarse}));
  for (Json& r : slow["recordings"]) r["trajectory"]["hz"] = {0.03, 0.2};
  const Json report = Bench(slow).diagnose().report;
  EXPECT_EQ(names(report), std::vector<std::string>{"quantisation"}) << report["findings"].dump(1);
  EXPECT_EQ(report["verdict"], "explained");
}

TEST(Diagnose, PosesAtRestShowWhatGravityShows) {
  Json configuration_at_rest = configuration(
      {{{"effect", "mass"}, {"axis", nullptr}, {"parameters", {{"delta_mass_kg", 0.08}}}}});
  configuration_at_rest["recordings"] = {
      {{"name", "fit"},
       {"samples", 40},
       {"trajectory",
        {{"kind", "static"}, {"angle_rad", {3.0, 1.4, 3.0}}, {"angle_center_rad", {0, 0, 0}}}}}};
  const Json report = Bench(configuration_at_rest).diagnose(false).report;
  EXPECT_EQ(names(report), std::vector<std::string>{"mass"});
  bool untestable = false;
  for (const Json& entry : report["not_testable"]) untestable |= entry["effect"] == "time_delay";
  EXPECT_TRUE(untestable);
}

/// Forty poses at rest, one every ten seconds and not on a clock: nothing is interpolated between
/// them, and an offset that drifts is told from gravity.
TEST(Diagnose, PosesWithTheirTimesShowADrift) {
  Json world = configuration(
      {{{"effect", "mass"}, {"axis", nullptr}, {"parameters", {{"delta_mass_kg", 0.08}}}}});
  world["recordings"] = {
      {{"name", "fit"},
       {"samples", 40},
       {"trajectory",
        {{"kind", "static"}, {"angle_rad", {3.0, 1.4, 3.0}}, {"angle_center_rad", {0, 0, 0}}}}}};
  const Bench bench(world);
  Table table = read_csv(bench / "fit.csv");
  const Index n = table.values.rows();
  Eigen::VectorXd t(n);
  for (Index i = 0; i < n; ++i)
    t(i) = 10.0 * static_cast<double>(i) + static_cast<double>(i * i % 7);
  for (std::size_t k = 0; k < table.columns.size(); ++k) {
    if (table.columns[k] == "fx") table.values.col(static_cast<Index>(k)) += 0.002 * t;
  }
  table.columns.emplace_back("t");
  table.values.conservativeResize(Eigen::NoChange, table.values.cols() + 1);
  table.values.rightCols(1) = t;
  write_csv(bench / "fit.csv", table);
  const Json report = bench.diagnose(false).report;
  EXPECT_EQ(test::found(report), (std::set<std::string>{"linear_drift", "mass"}))
      << report["findings"].dump(1);
  EXPECT_EQ(report["verdict"], "explained");
  for (const Json& finding : report["findings"]) {
    if (finding["effect"] != "linear_drift") continue;
    EXPECT_NEAR(finding["parameters"]["rate_x_nps"]["value"].get<double>(), 0.002, 2e-4);
    EXPECT_GT(finding["holdout_gain"].get<double>(), 0.5);
  }
}

// A wrist of which only the orientation is logged: gravity alone is simulated, and what needs the
// acceleration is neither tried nor passed over in silence.
TEST(Diagnose, WithoutAPositionItTellsWhatItCannotTest) {
  Json at_rest = configuration(
      {{{"effect", "bias"},
        {"axis", nullptr},
        {"parameters",
         {{"delta_bias_x_n", 0.1}, {"delta_bias_y_n", -0.2}, {"delta_bias_z_n", 0.15}}}}});
  at_rest["simulator"]["model"] = {{"inertial", "none"}};
  const Bench bench(at_rest);
  for (const char* name : {"fit.csv", "hold.csv"}) {
    Table table = read_csv(bench / name), without;
    without.values.resize(table.values.rows(), 0);
    for (std::size_t k = 0; k < table.columns.size(); ++k) {
      if (table.columns[k] == "x" || table.columns[k] == "y" || table.columns[k] == "z") continue;
      without.columns.push_back(table.columns[k]);
      without.values.conservativeResize(Eigen::NoChange, without.values.cols() + 1);
      without.values.rightCols(1) = table.values.col(static_cast<Index>(k));
    }
    write_csv(bench / name, without);
  }
  const Json report = bench.diagnose().report;
  EXPECT_EQ(names(report), std::vector<std::string>{"bias"});
  std::map<std::string, std::string> why;
  for (const Json& entry : report["not_testable"]) why[entry["effect"]] = entry["why"];
  for (const char* effect : {"inertial_terms", "com", "loose_load"}) {
    EXPECT_EQ(why[effect], "no position or acceleration is logged") << effect;
  }
  EXPECT_EQ(why["coulomb_friction"], "no position or velocity is logged");
}

TEST(Diagnose, RefusesWhatItCannotCompare) {
  const Bench bench(configuration(Json::array()));
  DiagnosisRequest request = bench.request();
  request.simulator.reset();
  try {
    diagnose(request, nullptr);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kData);
    EXPECT_NE(std::string(error.what()).find("--sim"), std::string::npos);
  }
  request = bench.request();
  request.holdout = request.fit;
  request.shared_clock = true;
  try {
    diagnose(request, nullptr);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.exit(), Exit::kData);
    EXPECT_NE(std::string(error.what()).find("--clock own"), std::string::npos);
  }
}

}  // namespace
}  // namespace dcnn
