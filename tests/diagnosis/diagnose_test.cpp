// The diagnosis on simulated recordings in which an effect of the catalogue was hidden.
#include "dcnn/diagnosis/diagnose.h"

#include <gtest/gtest.h>

#include <map>

#include "dcnn/core/file.h"
#include "dcnn/experiment/diagnosis_report.h"
#include "dcnn/physics/scenario.h"
#include "support/process.h"

namespace dcnn {
namespace {

#ifdef __SANITIZE_ADDRESS__
constexpr bool kSlow = true;  // a few cases under the sanitizers, all of them optimised
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
constexpr bool kSlow = true;
#else
constexpr bool kSlow = false;
#endif
#else
constexpr bool kSlow = false;
#endif

constexpr int kSamples = 10000;

Json recording(const char* name, double t0) {
  return {{"name", name},
          {"samples", kSamples},
          {"t0_s", t0},
          {"trajectory",
           {{"kind", "multisine"},
            {"tones", 6},
            {"hz", {0.05, 1.0}},
            {"position_m", {0.12, 0.12, 0.12}},
            {"angle_rad", {1.05, 0.61, 0.7}},
            {"angle_center_rad", {0.0, 0.0, 3.14159}}}}};
}

Json configuration(const Json& hidden) {
  return {{"seed", 5},
          {"simulator",
           {{"tool", {{"mass_kg", 0.75}, {"com_m", {0.004, -0.006, 0.16}}}},
            {"sensor", {{"bias_n", {0.1, -0.2, 0.3}}}}}},
          {"pose_noise", {{"m", 5e-6}, {"rad", 5e-6}}},
          {"force_noise", {{"n", 0.04}}},
          {"recordings", {recording("fit", 0.0), recording("hold", 25.0)}},
          {"hidden", hidden}};
}

/// Recordings and the nominal simulator in a folder of their own.
class Bench {
 public:
  explicit Bench(const Json& configuration) {
    const Scenario scenario = simulate_config(configuration, "test");
    for (const auto& r : scenario.recordings) write_csv(folder_ / (r.name + ".csv"), r.noisy.table);
    write_file(folder_ / "sim.json", scenario.simulator.dump());
  }
  DiagnosisRequest request(bool holdout = true) const {
    DiagnosisRequest request;
    request.simulator = folder_ / "sim.json";
    request.fit = {folder_ / "fit.csv"};
    if (holdout) request.holdout = {folder_ / "hold.csv"};
    return request;
  }
  Diagnosis diagnose(bool holdout = true) const {
    return dcnn::diagnose(request(holdout), nullptr);
  }
  std::filesystem::path operator/(const std::string& name) const { return folder_ / name; }

 private:
  test::TemporaryFolder folder_;
};

std::vector<std::string> names(const Json& report) {
  std::vector<std::string> list;
  for (const Json& f : report["findings"]) list.push_back(f["effect"].get<std::string>());
  return list;
}

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
  write_diagnosis(bench / "out", diagnosis);
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
  EXPECT_NE(page.find("<svg"), std::string::npos);
  EXPECT_EQ(page.find("http-equiv"), std::string::npos);
  EXPECT_EQ(page.find("src="), std::string::npos);
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
  EXPECT_EQ(count, 2500);  // one block of 5 s in 20 s
  write_diagnosis(bench / "out", diagnosis);
  EXPECT_EQ(read_csv(bench / "out/holdout_0_pred.csv").columns.back(), "held_out");
}

TEST(Diagnose, WorksOnSomebodyElsesSimulator) {
  const Bench bench(configuration({{{"effect", "coulomb_friction"},
                                    {"axis", "base_y"},
                                    {"parameters", {{"fc_n", 0.08}, {"v0_mps", 0.01}}}}}));
  for (const char* name : {"fit.csv", "hold.csv"}) {
    Recording log = read_recording(bench / name, ReadOptions(), System());
    const Recording simulated =
        predict_motion(read_simulator(bench / "sim.json"), log, DerivativeSpec());
    for (const std::string axis : {"fx", "fy", "fz"})
      log.set(axis + "_sim", simulated.column(axis));
    write_csv(bench / name, log.table);
  }
  DiagnosisRequest request = bench.request();
  request.simulator.reset();
  const Json report = diagnose(request, nullptr).report;
  EXPECT_EQ(names(report), std::vector<std::string>{"coulomb_friction"})
      << report["findings"].dump(1);
  EXPECT_TRUE(report["fit"]["holdout_rmse_parameters"].is_null());
}

// On a lattice as coarse as the noise the largest reading repeats as every other one does.
TEST(Diagnose, CoarseReadingsAreNotHeldAtALimit) {
  const Json coarse{
      {"effect", "quantisation"}, {"axis", nullptr}, {"parameters", {{"step_n", 0.25}}}};
  Json slow = configuration(Json::array({coarse}));
  for (Json& r : slow["recordings"]) r["trajectory"]["hz"] = {0.03, 0.2};
  const Json report = Bench(slow).diagnose().report;
  for (const auto& name : names(report))
    EXPECT_NE(name, "saturation") << report["findings"].dump(1);
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

/// Every effect that the diagnosis looks for, hidden alone with the numbers of its example.
class EveryFit : public testing::TestWithParam<const EffectKind*> {};

std::vector<const EffectKind*> fitted_kinds() {
  std::vector<const EffectKind*> kinds;
  for (const auto* kind : effect_kinds()) {
    if (!kind->fits.empty() && !kind->machines_only) kinds.push_back(kind);
  }
  return kinds;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryFit, testing::ValuesIn(fitted_kinds()),
                         [](const auto& test) { return std::string(test.param->name); });

TEST_P(EveryFit, IsNamedWhenHiddenAlone) {
  const EffectKind& kind = *GetParam();
  if (kSlow && kind.stage != Stage::kDynamics) GTEST_SKIP() << "optimised builds run all";
  Json entry{{"effect", kind.name}, {"axis", nullptr}, {"parameters", Json::parse(kind.example)}};
  const auto axes = admitted_axes(kind.axis);
  if (!axes.empty()) entry["axis"] = axes.front();
  if (kind.interval == IntervalRule::kRequired) entry["interval_s"] = {6.3, 11.8};
  if (kind.interval == IntervalRule::kOnset) entry["interval_s"] = {8.4, 45.0};
  Json config = configuration(Json::array({entry}));
  if (std::string(kind.name) == "inertial_terms") {
    config["simulator"]["model"] = {{"inertial", "none"}};
  }
  // At 12 Hz the tool would ring by less than the log can show: nothing moves that fast here.
  if (std::string(kind.name) == "flexible_resonance") {
    config["hidden"][0]["parameters"]["freq_hz"] = 3.0;
  }
  if (std::string(kind.name) == "saturation") config["hidden"][0]["parameters"]["limit_n"] = 1.5;
  const Json report = Bench(config).diagnose().report;
  const auto found = names(report);
  ASSERT_EQ(found, std::vector<std::string>{kind.name}) << report["findings"].dump(1);
  const Json& finding = report["findings"][0];
  if (!axes.empty()) {
    EXPECT_EQ(finding["axis"], axes.front());
  }
  for (const auto& [name, p] : finding["parameters"].items()) {
    EXPECT_EQ(p["unit"], unit_of_parameter(name));
    // What is read off the raw values is known to their last digit, not better.
    EXPECT_LT(p["ci95"][0].get<double>(), p["ci95"][1].get<double>()) << name;
  }
}

}  // namespace
}  // namespace dcnn
