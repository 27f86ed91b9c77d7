// SPDX-License-Identifier: Apache-2.0
// Pages as people use them: zoom, values under the pointer, series, sorting, dark mode, narrow
// screens, a million samples.
#include "support/page.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "dcnn/experiment/calibration_report.h"
#include "dcnn/experiment/diagnosis_report.h"
#include "dcnn/experiment/report.h"
#include "dcnn/physics/effect.h"
#include "dcnn/physics/effect_words.h"
#include "experiment/markup.h"
#include "experiment/report_words.h"

namespace dcnn {
namespace {

/// What a report of dcnn-diagnose on a wrist with torques holds.
Json diagnosis_json() {
  const Json number = {{"value", 0.402}, {"ci95", {0.398, 0.406}}, {"unit", "N"}};
  const Json finding = {{"effect", "coulomb_friction"},
                        {"kind", "structural"},
                        {"axis", "tool_z"},
                        {"interval_s", nullptr},
                        {"parameters", {{"fc_n", number}}},
                        {"confidence", 0.99},
                        {"p_value", 0.001},
                        {"alternatives", Json::array({"lugre_friction"})},
                        {"holdout_gain", 0.9},
                        {"words", "dry friction of 0.402 N along the tool"}};
  const Json fit = {{"holdout_rmse_before", {0.04, 0.04, 0.395, 0.003}},
                    {"holdout_rmse_parameters", nullptr},
                    {"holdout_rmse_after", {0.04, 0.04, 0.0401, 0.003}},
                    {"noise_floor", {0.039, 0.039, 0.0383, 0.003}}};
  const Json where = {
      {"axes", Json::array({{{"axis", "fz"}, {"share", 0.97}, {"excess_rms", 0.393}},
                            {{"axis", "tx"}, {"share", 0.01}, {"excess_rms", 0.0004}}})},
      {"segments", Json::array()},
      {"regimes", Json::array()},
      {"bands", Json::array()},
      {"budget", Json::array()}};
  return {{"targets", {"fx", "fy", "fz", "tx"}},
          {"units", {"N", "N", "N", "N*m"}},
          {"verdict", "explained"},
          {"findings", Json::array({finding})},
          {"fit", fit},
          {"where", where},
          {"unnamed", {{"words", nullptr}}},
          {"next_motion", nullptr},
          {"not_detected",
           Json::array(
               {{{"effect", "mass"},
                 {"minimum_detectable_rms", 0.03},
                 {"least", {{"parameter", "delta_mass_kg"}, {"value", 0.0031}, {"unit", "kg"}}}},
                {{"effect", "com"},
                 {"minimum_detectable_rms", 0.03},
                 {"least", {{"parameter", "delta_com_z_m"}, {"value", 0.00021}, {"unit", "m"}}}}})},
          {"not_testable",
           Json::array({{{"effect", "thermal_drift"}, {"why", "the recordings are too short"}}})}};
}

Diagnosis example_diagnosis(Eigen::Index samples) {
  Diagnosis diagnosis;
  diagnosis.report = diagnosis_json();
  HeldOut record;
  record.recording = "test.csv";
  record.t = Eigen::VectorXd::LinSpaced(samples, 0.0, 0.002 * static_cast<double>(samples - 1));
  record.measured.resize(samples, 4);
  for (Eigen::Index i = 0; i < samples; ++i) {
    for (Eigen::Index j = 0; j < 4; ++j) {
      record.measured(i, j) =
          std::sin(0.01 * static_cast<double>(i * (j + 1))) + 1e-3 * static_cast<double>(i % 7);
    }
  }
  record.before = 0.5 * record.measured;
  record.after = 0.9 * record.measured;
  diagnosis.holdout = {record};
  return diagnosis;
}

Calibration example_calibration() {
  Calibration c;
  c.pairs = 6;
  c.residual_rms = 0.03;
  c.covariance = 1e-6 * Eigen::Matrix3d::Identity();
  c.mass_kg = 0.75;
  return c;
}

ForcePairs example_pairs() {
  ForcePairs pairs;
  pairs.sensor = Eigen::MatrixXd::Random(6, 3);
  pairs.reference = pairs.sensor + 0.03 * Eigen::MatrixXd::Random(6, 3);
  pairs.weights = Eigen::VectorXd::Ones(6);
  return pairs;
}

class Pages : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::kSanitized || !test::has_chromium()) GTEST_SKIP() << "no chromium here";
  }
};

TEST_F(Pages, OfADiagnosisAndACalibrationAreUsable) {
  test::expect_usable_page(to_html(example_diagnosis(4000)));
  test::expect_usable_page(to_html(example_calibration(), example_pairs()));
}

TEST(CalibrationPage, HasItsWarningsBelowTheAnswerAndAListOfContents) {
  const std::string html =
      to_html(example_calibration(), example_pairs(),
              {"likely: st.csv: base_frame: the force is in the base's frame"});
  const auto answer = html.find("The sensor is turned by"), doubt = html.find("likely: st.csv");
  ASSERT_NE(doubt, html.npos);
  EXPECT_LT(answer, doubt);
  EXPECT_LT(doubt, html.find("<figure>"));
  EXPECT_NE(html.find("<nav>"), html.npos);
  test::expect_answer_first(html);
}

TEST_F(Pages, OfADiagnosisBeginWithItsAnswer) {
  Diagnosis diagnosis = example_diagnosis(2000);
  diagnosis.report["check"] = Json::array({"likely: a.csv: columns are exchanged"});
  const std::string html = to_html(diagnosis);
  const auto answer = html.find(headline(diagnosis.report).substr(0, 20)),
             doubt = html.find("likely: a.csv");
  ASSERT_TRUE(answer != html.npos && doubt != html.npos);
  EXPECT_LT(answer, doubt);
}

TEST_F(Pages, HaveAPlotForEachTarget) {
  const Json seen = test::browse(to_html(example_diagnosis(2000)), test::kUse);
  EXPECT_EQ(seen["plots"].get<int>(), 4) << seen.dump();
}

/// Units with a prefix are in one column with those without.
TEST_F(Pages, SortNumbersInTheirUnits) {
  HtmlReport page("units");
  page.paragraph("sizes");
  page.table({"what", "size"}, {{"a", "0.389 N"}, {"b", "35.8 mN"}, {"c", "2 kN"}, {"d", "70 µN"}});
  const Json seen = test::browse(page.html(), test::kUse);
  EXPECT_EQ(seen["sorted"], Json({"70 µN", "35.8 mN", "0.389 N", "2 kN"})) << seen.dump();
}

/// A table of many columns is a list of its cells on a narrow screen, and whole in print.
TEST_F(Pages, CutNoTable) {
  HtmlReport page("wide");
  page.paragraph("a table");
  std::vector<std::string> header{"model"}, row{"a/long/name/of/a/model.dcnn"};
  for (int k = 0; k < 9; ++k) header.push_back("largest error " + std::to_string(k) + " [N·m]");
  for (int k = 0; k < 9; ++k) row.push_back("0.01234 ± 0.00056");
  page.table(header, {row, row});
  test::expect_worked(test::browse(page.html(), test::kUse, 1000), 1000);
  test::expect_worked(test::browse(page.html(), test::kUse, 400), 400);
  const Json printed = test::browse(page.html(), test::kPrint, test::kPaper);
  EXPECT_TRUE(printed["errors"].empty()) << printed["errors"].dump();
  EXPECT_EQ(printed["rules"].get<int>(), 1) << "for print";
  EXPECT_TRUE(printed["cut"].empty()) << printed["cut"].dump();
}

TEST_F(Pages, OfAMillionSamplesStaySmallAndWork) {
  const std::string html = to_html(example_diagnosis(1'000'000));
  EXPECT_LT(html.size(), 8U << 20U);
  RecordProperty("bytes", static_cast<int>(html.size()));
  test::expect_worked(test::browse(html, test::kUse), 1000);
}

TEST(Markup, NumbersOfAColumnHaveTheSameDecimals) {
  EXPECT_EQ(common_decimals({0.3947, 0.404, 0.04038}, 3), 4);
  EXPECT_EQ(common_decimals({1234.0, 56.0}, 3), 1);
  EXPECT_EQ(common_decimals({0.0, NAN, 1e9}, 3), 0);
  EXPECT_EQ(common_decimals({1e-30}, 3), 9);
  EXPECT_EQ(percent(0.8791), "88 %");
  EXPECT_EQ(percent(0.007091), "0.71 %");
  EXPECT_EQ(percent(1e-5), "< 0.01 %");
  EXPECT_EQ(percent(0.0), "0 %");
}

TEST(ReportWords, SayUnitsAndNamesPeopleUse) {
  EXPECT_EQ(with_unit(0.0031, "kg"), "3.1 g");
  EXPECT_EQ(with_unit(0.00021, "m"), "0.21 mm");
  EXPECT_EQ(with_unit(0.402, "N"), "0.402 N");
  EXPECT_EQ(with_unit(0.0123, "N*m"), "12.3 mN·m");
  EXPECT_EQ(with_unit(2.5, "N*s^2/m^2"), "2.5 N·s²/m²");
  EXPECT_EQ(with_unit(3830.0, "N/m^3"), "3830 N/m³");
  EXPECT_EQ(with_interval(0.402, 0.398, 0.406, "N"), "0.402 N (0.398 to 0.406)");
  EXPECT_EQ(with_interval(0.5, 0.49999, 0.50001, "m"), "500 mm (499.99 to 500.01)");
  EXPECT_EQ(with_interval(1.0, 1.0, 1.0, ""), "1");
  EXPECT_EQ(with_unit(0.0012, unit_in_words("gain", "gain_x", "")), "0.12 %");
  EXPECT_EQ(words_of_axis("tool_z"), "along the tool");
  EXPECT_EQ(words_of_axis("gamma:sensor_y"), "along the sensor's y axis, by the angle gamma");
  EXPECT_EQ(words_of_axis("shoulder"), "shoulder");
  EXPECT_EQ(words_of_effect("coulomb_friction"), "dry friction");
  EXPECT_EQ(words_of_parameter("coulomb_friction", "fc_n"), "friction force");
  EXPECT_EQ(words_of_parameter("bias", "delta_bias_tx_nm"), "offset, torque about x");
  EXPECT_EQ(words_of_parameter("crosstalk", "c_xy"), "share of fy in fx");
  EXPECT_EQ(words_of_parameter("cable_spring", "rest_rad"), "angle at rest");
  EXPECT_EQ(words_of_parameter("cable_spring", "rest"), "position at rest");  // a sliding axis
  EXPECT_EQ(words_of_parameter("coulomb_friction", "fc"), "friction");        // or a torque
  EXPECT_EQ(words_of_parameter("gear_friction", "a"), "variation with the position");
  EXPECT_EQ(with_unit(0.3, unit_in_words("gear_friction", "a", "")), "30 %");
  EXPECT_EQ(with_unit(0.5, unit_in_words("discovered", "gain_2", "")), "0.5");
  EXPECT_EQ(words_of_parameter("friction", "coulomb_friction.fc_n"),
            "friction force of dry friction");
  EXPECT_EQ(words_of_structure("coulomb_friction tool_z + gain"),
            "dry friction along the tool and scale error per axis");
  EXPECT_EQ(words_of_signal("v_base_z"), "velocity along the base's z axis");
  EXPECT_EQ(words_of_part("memory"), "history");
}

/// A report says nothing in names of the code: every published parameter has words.
TEST(ReportWords, KnowEveryParameterOfTheCatalogue) {
  for (const EffectKind* kind : effect_kinds()) {
    const Json example = Json::parse(kind->example);
    for (const auto& [name, value] : example.items()) {
      EXPECT_EQ(words_of_parameter(kind->name, name).find('_'), std::string::npos) << name;
      EXPECT_GT(words_of_parameter(kind->name, name).size(), 4U) << kind->name << ": " << name;
    }
  }
}

TEST(ReportWords, KnowTheNumbersOfDiscoveredLaws) {
  EXPECT_EQ(words_of_parameter("discovered", "amplitude_n"), "amplitude");
  EXPECT_EQ(words_of_parameter("discovered", "scale_1_m"), "scale of the first variable");
  EXPECT_EQ(words_of_parameter("discovered", "centre_2_rad"), "centre of the second variable");
  EXPECT_EQ(words_of_parameter("discovered", "power_1"), "exponent of the first variable");
  EXPECT_EQ(words_of_parameter("discovered", "gain_2"), "slope of the second variable");
  EXPECT_EQ(words_of_parameter("discovered", "memory_1_s"), "time constant of the first variable");
  EXPECT_EQ(words_of_parameter("discovered", "lag_s"), "delay");
  EXPECT_EQ(words_of_parameter("discovered", "vector_scale_n"), "scale of the direction");
}

TEST(DiagnosisPage, SaysWhenAContactActsAndInWhichRecording) {
  Diagnosis diagnosis = example_diagnosis(2000);
  Json& finding = diagnosis.report["findings"][0];
  finding["interval_s"] = {12.34, 14.0};
  finding["recording"] = "fit_0.csv";
  EXPECT_NE(to_html(diagnosis).find("along the tool, from 12.3 to 14.0 s of fit_0.csv"),
            std::string::npos);
}

TEST(DiagnosisPage, BeginsWithTheAnswerAPictureAndATable) {
  const std::string html = to_html(example_diagnosis(2000));
  const auto answer = html.find("class=\"answer\""), picture = html.find("<figure>", answer),
             table = html.find("<table", answer), contents = html.find("<nav>"),
             next = html.find("<h2");
  EXPECT_LT(answer, picture);
  EXPECT_LT(picture, table);
  EXPECT_LT(table, contents);
  EXPECT_LT(contents, next);
  for (const char* name :
       {"fc_n", "tool_z", "coulomb_friction", "delta_mass_kg", "unit of the target"}) {
    EXPECT_EQ(html.substr(answer).find(std::string(">") + name), std::string::npos) << name;
  }
  EXPECT_NE(html.find("3.1 g"), std::string::npos);
  EXPECT_NE(html.find("0.21 mm"), std::string::npos);
}

}  // namespace
}  // namespace dcnn
