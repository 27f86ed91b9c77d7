// SPDX-License-Identifier: Apache-2.0
// Recordings that the spectra and detectors of the diagnosis must not read beyond.
#include <gtest/gtest.h>

#include "diagnosis/detectors.h"
#include "diagnosis/load.h"
#include "diagnosis/support.h"

namespace dcnn {
namespace {

Json report_of(const Json& world, const std::function<void(Recording&)>& by) {
  const test::Bench bench(world);
  test::change(bench, by);
  return bench.diagnose().report;
}

/// Below 2.7 s a spectrum has no bin beside a line to compare it with.
TEST(PoorRecordings, OfTwoSecondsHaveSpectraToo) {
  const Json report = report_of(test::configuration(Json::array()), [](Recording& log) {
    log.table.values.conservativeResize(1100, Eigen::NoChange);
  });
  EXPECT_EQ(report["verdict"], "consistent") << report["findings"].dump(1);
}

/// Dry friction of ten times the noise within 0.7 s: no band has a spectrum, and what a model
/// leaves of so few rows is no noise that held-out rows may be excused by.
TEST(PoorRecordings, OfLessThanASecondAreNeverCalledComplete) {
  const double noise = 0.04;
  const Json world = test::configuration(
      Json::array({test::hidden("coulomb_friction", "tool_z", {{"fc_n", 0.4}, {"v0_mps", 0.01}})}));
  for (const Index first : {500, 2500, 4500, 7000}) {
    const test::Bench bench(world);
    test::change(bench, [&](Recording& log) {
      log.table.values = log.table.values.middleRows(first, 350).eval();
    });
    const Json report = bench.diagnose(/*holdout=*/false).report;
    const double left = report["fit"]["holdout_rmse_after"][2];
    const auto verdict = report["verdict"].get<std::string>();
    const bool complete = verdict == "consistent" || verdict == "explained";
    EXPECT_FALSE(complete && left > 3.0 * noise) << first << ": " << verdict << ", " << left;
  }
}

/// Seven poses leave three degrees of freedom of each channel's noise: an offset of 0.2 N beside
/// noise of 0.05 N may be chance.
TEST(PoorRecordings, OfSevenPosesMakeNobodySure) {
  Eigen::MatrixXd poses(7, 6);
  poses << -1.583711, -0.952402, -0.623651, -7.982857, 3.336640, -4.507652,  //
      1.802714, 0.636390, -1.668431, 5.894861, 7.812902, 0.959887,           //
      -1.964013, -0.945160, -1.713597, -7.867524, 5.645040, 1.048871,        //
      -1.839386, -0.456360, 0.761854, -4.407248, -6.089658, -6.269264,       //
      2.280305, -0.991876, 0.635111, -8.239547, -3.236549, -4.095841,        //
      -2.463923, 1.043012, 2.192905, 8.526017, -4.055289, 3.066627,          //
      2.453222, 0.173680, 2.293903, 1.729678, -7.293057, 6.535842;
  const test::TemporaryFolder folder;
  write_csv(folder / "poses.csv", {{"alpha", "beta", "gamma", "fx", "fy", "fz"}, poses});
  write_file(folder / "sim.json",
             R"({"tool": {"mass_kg": 1.0, "com_m": [0.0, 0.0, 0.04]}, "sample_rate_hz": 500})");
  DiagnosisRequest request;
  request.simulator = folder / "sim.json";
  request.fit = {folder / "poses.csv"};
  const Json report = diagnose(request, nullptr).report;
  for (const Json& finding : report["findings"]) {
    EXPECT_LT(finding["confidence"].get<double>(), 0.95) << finding.dump(1);
  }
}

/// The law of a limit is one of forces, along three axes.
TEST(PoorRecordings, ALimitOfTorqueIsNoLimitOfForce) {
  Json world = test::configuration(Json::array());
  world["simulator"]["tool"]["inertia_kgm2"] = {0.01, 0.01, 0.01, 0.0, 0.0, 0.0};
  const test::Bench bench(world);
  for (const char* channel : {"tx", "fz"}) {
    test::change(bench, [&](Recording& log) {
      const Eigen::VectorXd x = log.column(channel);
      const double limit = 0.8 * x.cwiseAbs().maxCoeff();
      log.set(channel, x.cwiseMin(limit).cwiseMax(-limit));
    });
    const std::size_t forces = channel[0] == 'f' ? 1 : 0;
    EXPECT_EQ(clipping(load_wrist(bench.request()).fit).size(), forces) << channel;
  }
}

/// A controller of 125 Hz behind a log of 500 Hz: the pose has moved on where a force is repeated.
TEST(PoorRecordings, AForceThatIsHeldIsReadWhereItIsNew) {
  const Json report = report_of(test::configuration(Json::array()), [](Recording& log) {
    for (const char* axis : {"fx", "fy", "fz"}) {
      Eigen::VectorXd x = log.column(axis);
      for (Index i = 0; i < x.size(); ++i) x(i) = x(i - i % 4);
      log.set(axis, x);
    }
  });
  EXPECT_EQ(report["verdict"], "consistent") << report["findings"].dump(1);
  EXPECT_EQ(report["notes"].size(), 2u) << report["notes"].dump(1);
}

void leave_out(const std::vector<std::string>& columns, const test::Bench& bench) {
  for (const char* name : {"fit.csv", "hold.csv"}) {
    const Table whole = read_recording(bench / name, ReadOptions(), System()).table;
    Table part;
    std::vector<Index> kept;
    for (std::size_t k = 0; k < whole.columns.size(); ++k) {
      if (std::count(columns.begin(), columns.end(), whole.columns[k]) > 0) continue;
      part.columns.push_back(whole.columns[k]);
      kept.push_back(static_cast<Index>(k));
    }
    part.values = whole.values(Eigen::all, kept);
    write_csv(bench / name, part);
  }
}

/// What a sensor of fewer than three forces, or a log without a position, tells.
Json report_without(const std::vector<std::string>& columns, const Json& world) {
  const test::Bench bench(world);
  leave_out(columns, bench);
  DiagnosisRequest request = bench.request();
  request.read.part_of_wrench = true;
  return diagnose(request, nullptr).report;
}

TEST(PoorRecordings, ASensorOfOneAxisIsRead) {
  const Json world = test::configuration(Json::array(
      {test::hidden("cable_spring", "alpha:sensor_z", {{"k_nprad", 0.8}, {"rest_rad", 0.2}})}));
  const Json report = report_without({"fx", "fy", "tx", "ty", "tz"}, world);
  EXPECT_EQ(report["targets"], Json::array({"fz"}));
  EXPECT_EQ(test::found(report), std::set<std::string>{"cable_spring"})
      << report["findings"].dump(1);
}

TEST(PoorRecordings, WithoutAPositionHaveNoInertialForce) {
  Json world =
      test::configuration(Json::array({test::hidden("mass", nullptr, {{"delta_mass_kg", 0.1}})}));
  for (Json& each : world["recordings"]) each["trajectory"]["position_m"] = {0.0, 0.0, 0.0};
  world["simulator"]["tool"]["com_m"] = {0.0, 0.0, 0.0};
  const Json report = report_without({"x", "y", "z"}, world);
  EXPECT_EQ(test::found(report), std::set<std::string>{"mass"}) << report["findings"].dump(1);
  EXPECT_NE(report["notes"].dump().find("the tool's inertial force is left out"),
            std::string::npos);
}

/// A simulator whose forces are columns has no tool either whose acceleration a position tells.
TEST(PoorRecordings, WithoutAPositionASimulatorInColumnsIsCompared) {
  const test::Bench bench(test::configuration(Json::array({test::hidden(
      "bias", nullptr,
      {{"delta_bias_x_n", 0.3}, {"delta_bias_y_n", 0.0}, {"delta_bias_z_n", -0.2}})})));
  const DiagnosisRequest request = bench.request_of_columns();
  leave_out({"x", "y", "z"}, bench);
  const Json report = diagnose(request, nullptr).report;
  EXPECT_EQ(test::found(report), std::set<std::string>{"bias"}) << report["findings"].dump(1);
  const auto beside = load_wrist(bench.request()).fit.logs.front().recording.notes;
  EXPECT_NE(Json(beside).dump().find("--sim is the simulator"), std::string::npos);
}

TEST(PoorRecordings, RowsThatAreNoReadingAreLeftOut) {
  const test::Bench bench(test::configuration(Json::array()));
  test::change(bench, [](Recording& log) {
    Eigen::VectorXd fz = log.column("fz");
    fz.segment(2000, 600).setConstant(fz(2000));
    log.set("fz", fz);
  });
  DiagnosisRequest request = bench.request();
  for (const auto& path : {request.fit[0], request.holdout[0]}) {
    const Eigen::VectorXd t = read_recording(path, ReadOptions(), System()).column("t");
    request.no_readings.push_back({path, t(2000), t(2599), "fz"});
  }
  const Json report = diagnose(request, nullptr).report;
  EXPECT_EQ(report["verdict"], "consistent") << report["findings"].dump(1);
  EXPECT_NE(report["notes"].dump().find("fz is frozen from "), std::string::npos);
}

/// Derivatives take 0.1 s of rows: what is shorter between two gaps is left out.
TEST(PoorRecordings, AFewRowsBetweenTwoGapsStopNothing) {
  const test::Bench bench(test::configuration(Json::array()));
  test::change(bench, [](Recording& log) {
    const Index all = log.samples();
    std::vector<Index> kept;
    for (Index i = 0; i < all; ++i) {
      const Index from_middle = i - all / 2;
      const bool lost =
          (from_middle >= -10 && from_middle < 0) || (from_middle >= 15 && from_middle < 25);
      if (!lost) kept.push_back(i);
    }
    log.table.values = Eigen::MatrixXd(log.table.values(kept, Eigen::all));
  });
  const LoadedCase loaded = load_wrist(bench.request());
  const Recording& read = loaded.fit.logs.front().recording;
  EXPECT_EQ(read.segments.size(), 2u);
  EXPECT_EQ(read.notes.back(), "15 rows in stretches shorter than 51 rows between gaps: left out");
}

TEST(PoorRecordings, TellOfColumnsThatNothingLooksAt) {
  const test::Bench bench(test::configuration(Json::array()));
  test::change(bench, [](Recording& log) {
    log.table.values.conservativeResize(3000, Eigen::NoChange);
    log.set("pressure", log.column("x"));
  });
  EXPECT_NE(bench.diagnose().report["notes"].dump().find("not looked at: pressure; --signals"),
            std::string::npos);
}

}  // namespace
}  // namespace dcnn
