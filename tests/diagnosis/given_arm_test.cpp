// SPDX-License-Identifier: Apache-2.0
// Arms whose simulator is given: a payload is found, and nothing is where nothing is.
#include "diagnosis/given_arm.h"

#include <gtest/gtest.h>

#include "dcnn/conceal/arm.h"
#include "dcnn/core/file.h"
#include "dcnn/core/random.h"
#include "dcnn/physics/axis_machine.h"
#include "diagnosis/arm_words.h"
#include "diagnosis/axis_case.h"
#include "support/process.h"

namespace dcnn {
namespace {

/// An arm of the concealed world, whose mechanics are other than ours.
class GivenArms : public ::testing::Test {
 protected:
  /// The answer, and the request that knows nothing of it.
  std::pair<Json, DiagnosisRequest> concealed(const std::string& id, std::uint64_t seed) {
    const auto set = folder_ / std::to_string(count_++);
    const auto seal = folder_ / (std::to_string(count_) + ".sealed.json");
    conceal::conceal_arms({id}, seed, set, seal, [](int, int) {});
    DiagnosisRequest request;
    request.system = set / "s0001/system.json";
    request.fit = {set / "s0001/fit_0.csv", set / "s0001/fit_1.csv"};
    request.holdout = {set / "s0001/holdout_0.csv"};
    return {read_json(seal, Exit::kData)["scenarios"][0], request};
  }
  test::TemporaryFolder folder_;
  int count_ = 0;
};

void expect_payload(const Json& answer, const Json& finding) {
  ASSERT_FALSE(finding.is_null());
  ASSERT_EQ(finding["effect"], "payload");
  const Json &truth = answer["hidden"][0]["parameters"], &said = finding["parameters"];
  const auto error = [&](const std::string& name) {
    return std::abs(said[name]["value"].get<double>() - truth[name].get<double>());
  };
  EXPECT_LT(error("delta_mass_kg"), 0.02 * truth["delta_mass_kg"].get<double>()) << said.dump(1);
  for (const char* k : {"x", "y", "z"}) {
    EXPECT_LT(error(std::string("delta_com_") + k + "_m"), 0.005) << said.dump(1);
  }
}

TEST_F(GivenArms, APayloadIsFoundBesideFrictionWhetherBodiesOrTorquesAreGiven) {
  bool described[2] = {false, false};
  for (std::uint64_t seed = 1; !described[0] || !described[1]; ++seed) {
    const auto [answer, request] = concealed("loaded:2/any/0", seed);
    bool& done = described[answer["described"].get<bool>() ? 1 : 0];
    if (done) continue;
    done = true;
    const LoadedAxes loaded = load_axes(request);
    expect_payload(answer, loaded.finding);
    for (const LoadedCase& joint : loaded.cases) EXPECT_TRUE(joint.fit.axis->payload.has_value());
  }
}

TEST_F(GivenArms, NothingIsMissingWhereNothingIsHidden) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const auto [answer, request] = concealed("null:0/none/0", seed);
    const LoadedAxes loaded = load_axes(request);
    EXPECT_TRUE(loaded.finding.is_null()) << seed << loaded.finding.dump(1);
  }
}

/// The arm at rest where a recording begins, while a hand pushes each joint now and then: its
/// drives give way by a milliradian.
void push_at_rest(const std::filesystem::path& file, std::uint64_t seed) {
  Rng rng({seed});
  Table table = read_csv(file);
  const Eigen::RowVectorXd start = table.values.row(0);
  for (Index k = 0; k < table.values.cols(); ++k) {
    const bool angle = table.columns[static_cast<std::size_t>(k)].starts_with("q_");
    const bool torque = table.columns[static_cast<std::size_t>(k)].starts_with("tau_");
    if (!angle && !torque) continue;
    // An angle and its torque have one number and so one push.
    const double phase = static_cast<double>(table.columns[static_cast<std::size_t>(k)].back());
    for (Index i = 0; i < table.values.rows(); ++i) {
      const double t = table.values(i, 0) - start(0);
      const double push = std::pow(std::max(0.0, std::sin(0.9 * t + phase)), 4.0) *
                          std::sin((1.3 + 0.1 * static_cast<double>(seed)) * t + 2.0 * phase);
      table.values(i, k) = start(k) + (angle ? 1e-3 * push : 20.0 * push + 0.1 * rng.normal());
    }
  }
  write_csv(file, table);
}

TEST_F(GivenArms, AHandThatPushesAnArmAtRestIsNoPayload) {
  const auto [answer, request] = concealed("null:0/none/0", 2);
  push_at_rest(request.fit[0], 1);
  push_at_rest(request.fit[1], 2);
  push_at_rest(request.holdout[0], 3);
  const Json finding = load_axes(request).finding;
  EXPECT_TRUE(finding.is_null()) << finding.dump(1);
}

// The second link is described as lighter by a third than it is.
TEST_F(GivenArms, ALinkThatIsHeavierThanDescribedIsNoPayload) {
  for (std::uint64_t seed = 1;; ++seed) {
    const auto [answer, request] = concealed("null:0/none/0", seed);
    if (!answer["described"].get<bool>()) continue;
    Json system = read_json(*request.system, Exit::kData);
    Json& body = system["arm"]["joints"][1]["body"];
    body["mass_kg"] = 0.67 * body["mass_kg"].get<double>();
    for (Json& moment : body["moment_kgm"]) moment = 0.67 * moment.get<double>();
    write_file(*request.system, system.dump());
    const Json finding = load_axes(request).finding;
    ASSERT_FALSE(finding.is_null());
    EXPECT_EQ(finding["effect"], "link_inertia");
    return;
  }
}

TEST_F(GivenArms, AnEffectOfOneJointIsNoPayload) {
  for (const char* effect : {"gain", "cable_spring", "coulomb_friction", "lowpass"}) {
    const auto [answer, request] = concealed(std::string("single:2/") + effect + "/0", 4);
    const LoadedAxes loaded = load_axes(request);
    EXPECT_TRUE(loaded.finding.is_null()) << effect << loaded.finding.dump(1);
  }
}

/// All of it once: the sentence, the verdict, and a model.json that predicts what the report says.
TEST_F(GivenArms, AreReportedAsAWhole) {
  const auto [answer, request] = concealed("payload:1/payload/0", 7);
  const Diagnosis diagnosis = diagnose(request, nullptr);
  const Json& report = diagnosis.report;
  ASSERT_FALSE(report["findings"].empty());
  expect_payload(answer, report["findings"][0]);
  EXPECT_GT(report["findings"][0]["holdout_gain"].get<double>(), 0.5);
  EXPECT_NE(report["arm"]["words"].get<std::string>().find("payload of"), std::string::npos);
  EXPECT_EQ(report["joints"].size(), report["targets"].size());
  for (std::size_t j = 0; j < report["targets"].size(); ++j) {
    EXPECT_LT(report["fit"]["holdout_rmse_after"][j].get<double>(),
              1.1 * report["fit"]["noise_floor"][j].get<double>());
  }
  EXPECT_NE(headline(report).find("Payload of"), std::string::npos);

  const AxisMachine machine = parse_axis_machine(diagnosis.model, "model.json", Exit::kData);
  ASSERT_TRUE(machine.payload.has_value());
  const Recording held = read_recording(request.holdout[0], request.read, machine.system);
  const Eigen::MatrixXd predicted = predict_axes(machine, held);
  EXPECT_LT((predicted - diagnosis.holdout[0].after).cwiseAbs().maxCoeff(), 1e-9);
}

System four_axes() {
  System system;
  for (const char* name : {"a", "b", "c", "d"}) {
    Axis axis;
    axis.name = name;
    system.axes.push_back(axis);
  }
  return system;
}

Json finding_of(const std::string& effect, const Json& axis, const std::string& words) {
  return {{"effect", effect}, {"axis", axis}, {"words", words}};
}

TEST(ArmWords, NameJointsTogether) {
  Json report{{"verdict", "explained"}, {"findings", Json::array()}, {"joints", Json::array()}};
  report["findings"].push_back(
      finding_of("payload", nullptr, "payload of 2.6 kg, centre 4 cm off"));
  for (const char* axis : {"a", "b", "c", "d"}) {
    report["findings"].push_back(finding_of("coulomb_friction", axis, ""));
    report["findings"].push_back(finding_of("viscous_friction", axis, ""));
    report["joints"].push_back({{"axis", axis}, {"verdict", "explained"}});
  }
  report["findings"].push_back(finding_of("hum", "d", ""));
  EXPECT_EQ(arm_json(report, four_axes())["words"],
            "payload of 2.6 kg, centre 4 cm off; dry and viscous friction on a to d; hum on d; "
            "nothing else");
  report["findings"].back()["confidence"] = 0.3;
  EXPECT_EQ(arm_json(report, four_axes())["words"],
            "payload of 2.6 kg, centre 4 cm off; dry and viscous friction on a to d; nothing else");
  report["joints"][1]["verdict"] = "partly-explained";
  const std::string words = arm_json(report, four_axes())["words"];
  EXPECT_TRUE(words.ends_with("; something without a name on b")) << words;
  report["findings"] = Json::array();
  report["joints"] = Json::array();
  EXPECT_EQ(arm_json(report, four_axes())["words"], "nothing is missing");
}

}  // namespace
}  // namespace dcnn
