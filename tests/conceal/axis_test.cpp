// SPDX-License-Identifier: Apache-2.0
// Single axes: their drawn logs, the hidden forces against closed forms, and the seal.
#include "dcnn/conceal/axis.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "conceal/axis_draw.h"
#include "dcnn/conceal/challenge.h"
#include "dcnn/core/file.h"
#include "dcnn/diagnosis/diagnose.h"
#include "diagnosis/candidates.h"
#include "support/process.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// A sine of 0.7 Hz about zero, 4 s at 500 Hz, and its exact derivatives.
constexpr double kSineW = 2.0 * std::numbers::pi * 0.7;
AxisPath sine_path() {
  AxisPath path;
  path.per_row = 16, path.rows = 2000, path.step = 1.0 / 8000.0, path.before = 4000;
  path.start = -0.5;
  const Index n = path.rows * path.per_row + 2 * path.before;
  path.q = path.v = path.a = VectorXd::Zero(n);
  for (Index i = 0; i < n; ++i) {
    const double t = path.time(i);
    path.q(i) = 0.8 * std::sin(kSineW * t);
    path.v(i) = 0.8 * kSineW * std::cos(kSineW * t);
    path.a(i) = -0.8 * kSineW * kSineW * std::sin(kSineW * t);
  }
  return path;
}

AxisBody sine_body() {
  AxisBody body;
  body.inertia = 0.3, body.hz = 0.7, body.fast = 0.8 * kSineW, body.wide = 0.8;
  body.effort = 3.0, body.turn = 2.0 * std::numbers::pi;
  return body;
}

/// Worst difference between what the effect adds in the log and `law` of the time of its rows.
template <class Law>
double error_of(const Hidden& h, const Law& law) {
  const AxisPath path = sine_path();
  const VectorXd added = path.logged(axis_effort(sine_body(), path, {h})) -
                         path.logged(axis_effort(sine_body(), path, {}));
  double worst = 0.0;
  for (Index i = 0; i < added.size(); ++i) {
    worst = std::max(worst, std::abs(added(i) - law(static_cast<double>(i) / 500.0)));
  }
  return worst;
}

TEST(Axis, DrawnForcesAreTheirClosedForms) {
  Rng rng({5u});
  const auto q = [](double t) { return 0.8 * std::sin(kSineW * t); };
  const auto v = [](double t) { return 0.8 * kSineW * std::cos(kSineW * t); };
  const auto a = [&](double t) { return -kSineW * kSineW * q(t); };
  const Hidden dry = draw_axis_effect("coulomb_friction", sine_body(), rng);
  EXPECT_LT(error_of(dry,
                     [&](double t) {
                       return dry.parameters.at("fc_n") *
                              std::tanh(v(t) / dry.parameters.at("v0_mps"));
                     }),
            1e-9);
  const Hidden cogging = draw_axis_effect("cogging", sine_body(), rng);
  EXPECT_LT(error_of(cogging,
                     [&](double t) {
                       const auto& p = cogging.parameters;
                       return p.at("amp_n") * std::sin(p.at("order") * q(t) + p.at("phase_rad"));
                     }),
            1e-9);
  const Hidden load = draw_axis_effect("gravity_load", sine_body(), rng);
  EXPECT_LT(error_of(load,
                     [&](double t) {
                       const auto& p = load.parameters;
                       return p.at("amp_n") * std::sin(q(t) - p.at("rest_rad"));
                     }),
            1e-9);
  const Hidden inertia = draw_axis_effect("inertia", sine_body(), rng);
  EXPECT_LT(
      error_of(inertia, [&](double t) { return inertia.parameters.at("delta_inertia_kg") * a(t); }),
      1e-9);
  Hidden delay = draw_axis_effect("time_delay", sine_body(), rng);
  for (const double late : {0.0123, -0.0217}) {  // a lead too
    delay.parameters["delay_s"] = late;
    EXPECT_LT(error_of(delay, [&](double t) { return 0.3 * (a(t - late) - a(t)); }), 1e-6) << late;
  }
}

TEST(Axis, ALagAndLoadFrictionAreTheirClosedForms) {
  Rng rng({6u});
  const auto a = [](double t) { return -0.8 * kSineW * kSineW * std::sin(kSineW * t); };
  const Hidden load = draw_axis_effect("load_friction", sine_body(), rng);
  EXPECT_LT(error_of(load,
                     [&](double t) {
                       const double v = 0.8 * kSineW * std::cos(kSineW * t);
                       return load.parameters.at("mu") * std::abs(0.3 * a(t)) *
                              std::tanh(v / load.parameters.at("v0_mps"));
                     }),
            1e-9);
  Hidden lag = draw_axis_effect("lowpass", sine_body(), rng);
  const double tau = lag.parameters["tau_s"] = 0.02;
  // Steady state of tau y' + y = sin(w t), long after the 0.5 s before the first row.
  EXPECT_LT(error_of(lag,
                     [&](double t) {
                       const double late = std::atan(kSineW * tau), gain = std::cos(late);
                       return 0.3 * (gain * a(t - late / kSineW) - a(t));
                     }),
            1e-6);
}

TEST(Axis, AScenarioHoldsWhatItsAnswersSay) {
  const AxisScenario s = draw_axis_scenario("single:3/coulomb_friction/2", 9);
  ASSERT_EQ(s.hidden.size(), 1U);
  EXPECT_GT(s.hidden[0].amplitude, 3.0 / 1.5);
  EXPECT_LT(s.hidden[0].amplitude, 1.5 * std::sqrt(10.0) * 3.0);
  const Json truth = axis_truth(s);
  EXPECT_EQ(truth["hidden"][0]["class"], "friction");
  EXPECT_NEAR(truth["oracle_rmse"][0].get<double>() / s.log.sigma, 1.0, 0.4);
  int held_out = 0;
  for (const AxisRecording& r : s.recordings) held_out += r.holdout ? 1 : 0;
  EXPECT_EQ(held_out, 1);
  for (const AxisRecording& r : s.recordings) {
    for (Index i = 1; i < r.t.size(); ++i) ASSERT_GT(r.t(i), r.t(i - 1)) << r.name;
  }
  EXPECT_THROW(draw_axis_scenario("single:3/mass/0", 9), Error);
  EXPECT_THROW(draw_axis_scenario("nobody:3/gain/0", 9), Error);
  EXPECT_THROW(draw_axis_scenario("single:none/gain/0", 9), Error);
}

TEST(Axis, EveryMotionIsTheIntegralOfItsDerivatives) {
  for (const std::string& kind : axis_motions()) {
    AxisPath path;
    path.step = 1e-3;
    Rng rng({7u});
    make_axis_motion(kind, sine_body(), 0.4, 20000, path, rng);
    double q = path.q(1), v = path.v(1), worst = 0.0;
    for (Index i = 2; i + 1 < path.q.size(); ++i) {
      q += 0.5 * path.step * (path.v(i - 1) + path.v(i));
      v += 0.5 * path.step * (path.a(i - 1) + path.a(i));
      worst = std::max({worst, std::abs(q - path.q(i)), std::abs(v - path.v(i)) / kSineW});
    }
    EXPECT_LT(worst, 0.02 * 0.8) << kind;
    EXPECT_GT(path.v.cwiseAbs().maxCoeff(), 0.0) << kind;
  }
}

// An effect that is added to the catalogue of an axis must be hidden here too.
TEST(Axis, ThePlanHidesEveryEffectThatTheDiagnosisLooksForOnAnAxis) {
  Case study;
  auto plan = std::make_shared<AxisPlan>();
  plan->system.axes.emplace_back();
  plan->system.axes.front().position_unit = "rad";
  study.axis = plan;
  std::set<std::string> catalogue;
  for (const EffectKind* kind : effect_kinds()) {
    const bool by_search = kind->example_law == nullptr;  // a law found, not one of the catalogue
    if (by_search && dcnn::is_listed(study, *kind)) catalogue.insert(kind->name);
  }
  EXPECT_EQ(catalogue, std::set<std::string>(axis_catalogue().begin(), axis_catalogue().end()));
  std::set<std::string> planned, laws;
  const auto ids = axis_plan(160, 3);
  for (const std::string& id : ids) {
    const AxisRequest request = parse_axis_id(id);
    if (request.group == "single") planned.insert(request.effects.front());
    if (request.group == "unlisted") laws.insert(request.effects.front());
  }
  EXPECT_EQ(planned, catalogue);
  EXPECT_EQ(laws, std::set<std::string>(axis_laws().begin(), axis_laws().end()));
  EXPECT_GE(axis_laws().size(), 12U);
  EXPECT_EQ(axis_plan(160, 3), ids);
  EXPECT_NE(axis_plan(160, 4), ids);
}

TEST(Axis, TheSameSeedSealsTheSameBytesAndTheFolderHoldsNoAnswer) {
  const test::TemporaryFolder folder;
  const auto sealed = [&](const std::string& name, std::uint64_t seed) {
    return conceal_axes({"double:3/coulomb_friction+viscous_friction/1"}, seed, folder / name,
                        folder / (name + ".json"), [](int, int) {});
  };
  const std::string first = sealed("a", 1);
  EXPECT_EQ(first, sealed("b", 1));
  EXPECT_NE(first, sealed("c", 2));
  for (const auto& file : std::filesystem::recursive_directory_iterator(folder / "a")) {
    if (!file.is_regular_file()) continue;
    const std::string text = test::slurp(file.path());
    for (const char* answer : {"friction", "hidden", "drawn", "double:", "fc_n"}) {
      EXPECT_EQ(text.find(answer), std::string::npos) << file.path() << " " << answer;
    }
  }
  const Json one = open_seal(folder / "a", folder / "a.json")["scenarios"][0];
  EXPECT_EQ(one["hidden"].size(), 2U);
  EXPECT_TRUE(one["sha256"].contains("system.json") && one["sha256"].contains("holdout_0.csv"));
}

TEST(Axis, ADiagnosisOfAScenarioIsScored) {
  const test::TemporaryFolder folder;
  // The first with few rows: this test is about the way from the drawing to the score.
  std::string id;
  for (int k = 0; id.empty(); ++k) {
    const std::string next = "single:10/bias/" + std::to_string(k);
    double rows = 0.0;
    const AxisScenario s = draw_axis_scenario(next, 4);
    for (const AxisRecording& r : s.recordings) rows += static_cast<double>(r.t.size());
    if (rows < 8000.0 && s.form == "simulated" && s.body.kind == "linear") id = next;
  }
  conceal_axes({id}, 4, folder / "set", folder / "seal.json", [](int, int) {});
  const auto place = folder / "set" / "s0001";
  DiagnosisRequest request;
  request.system = place / "system.json";
  for (const auto& file : std::filesystem::directory_iterator(place)) {
    const std::string name = file.path().filename().string();
    if (name.starts_with("fit_")) request.fit.push_back(file.path());
    if (name.starts_with("holdout_")) request.holdout.push_back(file.path());
  }
  std::sort(request.fit.begin(), request.fit.end());
  const Diagnosis found = diagnose(request, {});
  std::filesystem::create_directories(folder / "set" / "reports" / "s0001");
  write_file(folder / "set" / "reports" / "s0001" / "report.json", found.report.dump());
  const Json scores = score_challenge(folder / "set", folder / "seal.json");
  const Json& scored = scores["scenarios"][0];
  EXPECT_EQ(scored["family"], "axis");
  EXPECT_TRUE(scored["top1"].get<bool>()) << found.report["findings"].dump(1);
  EXPECT_TRUE(scored["effects"][0]["kind_named"].get<bool>());
  EXPECT_TRUE(scored["verdict_right"].get<bool>());
  EXPECT_EQ(scores["tables"]["confidence"]["n"], 1);
}

}  // namespace
}  // namespace dcnn::conceal
