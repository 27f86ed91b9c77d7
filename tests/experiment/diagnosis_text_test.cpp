// SPDX-License-Identifier: Apache-2.0
// What dcnn-diagnose prints: words and units, and no name of the code.
#include <gtest/gtest.h>

#include "dcnn/experiment/diagnosis_report.h"

namespace dcnn {
namespace {

Json text_number(double value, const char* unit) {
  return {{"value", value}, {"ci95", {0.9 * value, 1.1 * value}}, {"unit", unit}};
}

Json text_finding(const char* effect, const Json& axis, const Json& parameters) {
  return {{"effect", effect},      {"axis", axis},
          {"interval_s", nullptr}, {"confidence", 0.98},
          {"holdout_gain", 0.9},   {"alternatives", Json::array()},
          {"words", "a law"},      {"parameters", parameters}};
}

/// Of a wrist with forces and torques.
Diagnosis text_diagnosis() {
  Json friction =
      text_finding("coulomb_friction", "tool_z",
                   {{"fc_n", text_number(0.4, "N")}, {"v0_mps", text_number(0.01, "m/s")}});
  friction["alternatives"] = {"lugre_friction"};
  const Json cubic =
      text_finding("cubic_spring", "gamma:sensor_y", {{"k3", text_number(2.0, "N*m/rad^3")}});
  Json bump = text_finding("step_bias", nullptr, {{"step_x_n", text_number(0.02, "N")}});
  bump["interval_s"] = {3.0, 8.0};
  Diagnosis diagnosis;
  diagnosis.report = {
      {"targets", {"fx", "tx"}},
      {"units", {"N", "N*m"}},
      {"verdict", "partly-explained"},
      {"findings", {friction, cubic, bump}},
      {"unnamed", {{"words", nullptr}}},
      {"search", {{"complete", true}}},
      {"next_motion",
       {{"separates", {"coulomb_friction tool_z", "gain"}}, {"words", "move x over 0.2 m"}}},
      {"fit",
       {{"holdout_rmse_before", {0.4, 0.01}},
        {"holdout_rmse_parameters", nullptr},
        {"holdout_rmse_after", {0.04, 0.01}},
        {"noise_floor", {0.04, 0.01}}}}};
  return diagnosis;
}

TEST(DiagnosisText, MarksWhatIsRatherWrongThanRight) {
  Diagnosis diagnosis = text_diagnosis();
  Json& finding = diagnosis.report["findings"][0];
  finding["confidence"] = 0.3;
  finding["alternatives"] = Json::array();
  EXPECT_NE(to_text(diagnosis).find("doubtful    dry friction, along the tool; confidence 30 %\n"),
            std::string::npos)
      << to_text(diagnosis);
}

TEST(DiagnosisText, SaysFindingsInWordsAndUnits) {
  const std::string text = to_text(text_diagnosis());
  for (const char* words :
       {"verdict     partly explained\n",
        "found       dry friction, along the tool; confidence 98 %\n"
        "            friction force: 0.4 N (0.36 to 0.44);\n"
        "            speed scale of its change of sign: 10 mm/s (9 to 11)",
        "            or: friction with elastic presliding\n",
        "along the sensor's y axis, by the angle gamma; confidence 98 %\n"
        "            cubic stiffness: 2 N·m/rad³ (1.8 to 2.2)\n",
        "from 3.0 to 8.0 s; confidence 98 %\n            size of the step, x: 20 mN (18 to 22)\n",
        "hold-out    RMSE 0.4 as given, 0.04 with all findings; sensor's noise 0.04 N (fx)\n",
        "next        to tell dry friction along the tool from scale error per axis: move x"}) {
    EXPECT_NE(text.find(words), std::string::npos) << words << "\nin\n" << text;
  }
}

TEST(DiagnosisText, HoldsNoNameOfTheCode) {
  const std::string text = to_text(text_diagnosis());
  for (const char* name : {"_", "tool_z", "fc", "k3", "N*m", "^"}) {
    EXPECT_EQ(text.find(name), std::string::npos) << name << " in\n" << text;
  }
}

TEST(DiagnosisText, OfALawThatNoNameDescribesAsksForAMotionThatShowsIt) {
  Diagnosis diagnosis = text_diagnosis();
  diagnosis.report["next_motion"]["separates"] = {"discovered", "unknown"};
  EXPECT_NE(to_text(diagnosis).find("next        to see what no name describes: move"),
            std::string::npos);
}

}  // namespace
}  // namespace dcnn
