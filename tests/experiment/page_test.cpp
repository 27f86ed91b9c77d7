// Pages as people use them: zoom, values under the pointer, series, sorting, dark mode, narrow
// screens, a million samples.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "dcnn/experiment/calibration_report.h"
#include "dcnn/experiment/diagnosis_report.h"
#include "experiment/report_words.h"
#include "support/chromium.h"
#include "support/sanitizer.h"

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

constexpr const char* kUse = R"js(
  const out = {width: innerWidth, wide: document.documentElement.scrollWidth, plots: 0, together: true};
  out.background = getComputedStyle(document.body).backgroundColor;
  const group = [...groups.values()][0];
  if (group) {
    out.plots = group.length;
    const graph = group[0], area = graph.getArea(), box = graph.graphDiv.getBoundingClientRect();
    const event = (kind, share) => new MouseEvent(kind, {bubbles: true, cancelable: true, view: window, detail: 1,
      clientX: box.left + area.x + share * area.w, clientY: box.top + area.y + area.h / 2});
    const canvas = graph.graphDiv.querySelectorAll('canvas')[1];
    canvas.dispatchEvent(event('mousemove', 0.5));
    out.value = document.querySelector('.plot output').textContent;
    const whole = graph.xAxisRange();
    canvas.dispatchEvent(event('mousedown', 0.3));
    document.dispatchEvent(event('mousemove', 0.6));
    document.dispatchEvent(event('mouseup', 0.6));
    const part = graph.xAxisRange();
    out.zoom = (part[1] - part[0]) / (whole[1] - whole[0]);
    for (const other of group) out.together = out.together && Math.abs(other.xAxisRange()[0] - part[0]) < 1e-9;
    document.querySelector('.key input').click();
    out.visible = graph.visibility();
    document.querySelector('.key button').click();
    const again = graph.xAxisRange();
    out.reset = (again[1] - again[0]) / (whole[1] - whole[0]);
  }
  const table = document.querySelector('table'), head = table.tHead.rows[0].cells[1];
  head.click();
  out.sorted = Array.from(table.tBodies[0].rows, row => row.cells[1].textContent);
  out.order = head.getAttribute('aria-sort');
  return out;
)js";

class Pages : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::kSanitized || !test::has_chromium()) GTEST_SKIP() << "no chromium here";
  }
  static void expect_no_errors(const Json& seen) {
    EXPECT_TRUE(seen["errors"].empty()) << seen["errors"].dump();
  }
};

TEST_F(Pages, ZoomHoverSeriesAndSortingWork) {
  const Json seen = test::browse(to_html(example_diagnosis(4000)), kUse);
  expect_no_errors(seen);
  ASSERT_TRUE(seen.contains("zoom")) << seen.dump();
  EXPECT_EQ(seen["plots"].get<int>(), 4);  // one for each target, the telling one beside the answer
  EXPECT_NEAR(seen["zoom"].get<double>(), 0.3, 0.02);
  EXPECT_TRUE(seen["together"].get<bool>());
  EXPECT_NE(seen["value"].get<std::string>().find(" at "), std::string::npos);
  EXPECT_FALSE(seen["visible"][0].get<bool>());
  EXPECT_NEAR(seen["reset"].get<double>(), 1.0, 1e-9);
  EXPECT_EQ(seen["order"].get<std::string>(), "ascending");
}

TEST_F(Pages, FitANarrowScreenAndKnowDarkMode) {
  const std::string dark = "--blink-settings=preferredColorScheme=0";
  for (const auto& html :
       {to_html(example_diagnosis(2000)), to_html(example_calibration(), example_pairs())}) {
    const Json seen = test::browse(html, kUse, 400, dark);
    expect_no_errors(seen);
    EXPECT_LE(seen["wide"].get<int>(), seen["width"].get<int>()) << "the page scrolls sideways";
    EXPECT_EQ(seen["width"].get<int>(), 400);
    EXPECT_EQ(seen["background"].get<std::string>(), "rgb(22, 24, 27)");
  }
}

TEST_F(Pages, OfAMillionSamplesStaySmallAndWork) {
  const std::string html = to_html(example_diagnosis(1'000'000));
  EXPECT_LT(html.size(), 8U << 20U);
  RecordProperty("bytes", static_cast<int>(html.size()));
  const Json seen = test::browse(html, kUse);
  expect_no_errors(seen);
  EXPECT_NEAR(seen["zoom"].get<double>(), 0.3, 0.02);
}

TEST(ReportWords, SayUnitsAndNamesPeopleUse) {
  EXPECT_EQ(with_unit(0.0031, "kg"), "3.1 g");
  EXPECT_EQ(with_unit(0.00021, "m"), "0.21 mm");
  EXPECT_EQ(with_unit(0.402, "N"), "0.402 N");
  EXPECT_EQ(with_unit(0.0123, "N*m"), "12.3 mN·m");
  EXPECT_EQ(with_unit(2.5, "N*s^2/m^2"), "2.5 N·s²/m²");
  EXPECT_EQ(with_interval(0.402, 0.398, 0.406, "N"), "0.402 N (0.398 to 0.406)");
  EXPECT_EQ(with_unit(0.0012, unit_in_words("gain_x", "")), "0.12 %");
  EXPECT_EQ(words_of_axis("tool_z"), "along the tool");
  EXPECT_EQ(words_of_axis("gamma:sensor_y"), "along the sensor's y axis, by the angle gamma");
  EXPECT_EQ(words_of_axis("shoulder"), "shoulder");
  EXPECT_EQ(words_of_effect("coulomb_friction"), "dry friction");
  EXPECT_EQ(words_of_parameter("fc_n"), "friction force");
  EXPECT_EQ(words_of_parameter("c_xy"), "share of fy in fx");
}

/// A report says nothing in names of the code: every published parameter has words.
TEST(ReportWords, KnowEveryParameterOfTheCatalogue) {
  for (const EffectKind* kind : effect_kinds()) {
    const Json example = Json::parse(kind->example);
    for (const auto& [name, value] : example.items()) {
      EXPECT_EQ(words_of_parameter(name).find('_'), std::string::npos) << name;
      EXPECT_GT(words_of_parameter(name).size(), 4U) << kind->name << ": " << name;
    }
  }
}

TEST(DiagnosisPage, BeginsWithTheAnswerAPictureAndATable) {
  const std::string html = to_html(example_diagnosis(2000));
  const auto answer = html.find("class=\"answer\""), picture = html.find("<figure>", answer),
             table = html.find("<table>", answer), contents = html.find("<nav>"),
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
