// SPDX-License-Identifier: Apache-2.0
#include "dcnn/conceal/inject.h"

#include <gtest/gtest.h>

#include "dcnn/conceal/challenge.h"
#include "dcnn/core/file.h"
#include "support/process.h"

namespace dcnn::conceal {
namespace {

constexpr double kSpeed = 0.1;  // m/s along x

/// A log of a tool that moves steadily, without noise but for its logger's digits.
Injection steady(const test::TemporaryFolder& folder, const std::string& what) {
  Table log{{"t", "x", "y", "z", "alpha", "beta", "gamma", "fx", "fy", "fz"}, {}};
  log.values = Eigen::MatrixXd::Zero(4000, 10);
  for (Eigen::Index i = 0; i < 4000; ++i) {
    log.values(i, 0) = 7.0 + 0.002 * static_cast<double>(i);
    log.values(i, 1) = kSpeed * 0.002 * static_cast<double>(i);
    for (int j = 7; j < 10; ++j) log.values(i, j) = 0.01 * static_cast<double>((i * i * j) % 11);
  }
  write_csv(folder / "log.csv", log);
  write_file(folder / "sim.json",
             Json{{"tool", {{"mass_kg", 0.7}, {"com_m", {0.0, 0.0, 0.1}}}}}.dump());
  Injection request;
  request.what = what;
  request.simulator = folder / "sim.json";
  request.motion = {folder / "log.csv"};
  return request;
}

Eigen::MatrixXd added(const test::TemporaryFolder& folder) {
  const Table before = read_csv(folder / "log.csv"), after = read_csv(folder / "out" / "log.csv");
  EXPECT_EQ(before.columns, after.columns);
  EXPECT_EQ(before.values.leftCols(7), after.values.leftCols(7));
  return (after.values - before.values).rightCols(3);
}

TEST(Inject, TheNumbersOfAFileAsTheyAre) {
  const test::TemporaryFolder folder;
  write_file(folder / "hidden.json",
             R"([{"effect":"viscous_friction","axis":"base_x","interval_s":null,
                  "parameters":{"c_nspm":2.0}},
                 {"effect":"step_bias","interval_s":[10,15],
                  "parameters":{"step_x_n":0,"step_y_n":0.5,"step_z_n":0}}])");
  inject(steady(folder, folder / "hidden.json"), 1, folder / "out", folder / "seal.json");
  const Eigen::MatrixXd d = added(folder);
  EXPECT_NEAR(d(2000, 0), -2.0 * kSpeed, 1e-6);
  EXPECT_NEAR(d(1400, 1), 0.0, 1e-9);  // 9.8 s
  EXPECT_NEAR(d(1600, 1), 0.5, 1e-9);
  EXPECT_NEAR(d.col(2).norm(), 0.0, 1e-9);
  EXPECT_EQ(open_seal(folder / "out", folder / "seal.json")["scenarios"][0]["hidden"].size(), 2U);
}

TEST(Inject, ADrawnEffectHasTheAmplitudeAskedFor) {
  const test::TemporaryFolder folder;
  Injection request = steady(folder, "coulomb_friction@base_x");
  request.amplitude = 0.5;
  inject(request, 1, folder / "out", folder / "seal.json");
  const Json answer = open_seal(folder / "out", folder / "seal.json")["scenarios"][0];
  const double sigma = answer["noise"]["sigma_n"], fc = answer["hidden"][0]["parameters"]["fc_n"];
  EXPECT_NEAR(fc / sigma, 0.5, 0.02);
  EXPECT_NEAR(added(folder)(2000, 0), -fc, 1e-6);

  request.noise = 0.2;
  inject(request, 1, folder / "out", folder / "seal.json");
  EXPECT_NEAR(added(folder)(2000, 0), -0.5 * 0.2, 0.01);
}

/// What is measured drives the axis: friction asks for more along the motion.
TEST(Inject, OnAMachineTheDriveCarriesTheEffect) {
  const test::TemporaryFolder folder;
  Injection request = steady(folder, folder / "hidden.json");
  write_file(folder / "hidden.json",
             R"([{"effect":"viscous_friction","axis":"base_x","interval_s":null,
                  "parameters":{"c_nspm":2.0}},
                 {"effect":"cable_spring","axis":"alpha:base_x","interval_s":null,
                  "parameters":{"k_nprad":3.0,"rest_rad":0.1}}])");
  write_file(folder / "system.json",
             R"({"kind":"axes","axes":[{"name":"slide","measured":"fx","unit":"N","position":"x",
                                        "base":["acceleration"]}]})");
  request.simulator.clear();
  request.system = folder / "system.json";
  inject(request, 1, folder / "out", folder / "seal.json");
  const Table before = read_csv(folder / "log.csv"), after = read_csv(folder / "out" / "log.csv");
  EXPECT_EQ(before.values.leftCols(7), after.values.leftCols(7));
  const double x = kSpeed * 0.002 * 2000.0;
  EXPECT_NEAR(after.values(2000, 7) - before.values(2000, 7), 2.0 * kSpeed + 3.0 * (x - 0.1), 1e-5);
  EXPECT_EQ(before.values.rightCols(2), after.values.rightCols(2));
}

TEST(Inject, WhatCannotBeAddedIsRefused) {
  const test::TemporaryFolder folder;
  for (const char* what : {"inertial_terms", "no_such_effect", "viscous_friction@base_y"}) {
    EXPECT_THROW(inject(steady(folder, what), 1, folder / "out", folder / "seal.json"), Error)
        << what;
  }
}

}  // namespace
}  // namespace dcnn::conceal
