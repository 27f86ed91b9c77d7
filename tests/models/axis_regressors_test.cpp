// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include "support.h"

namespace dcnn {
namespace {

double largest_axis_error(const Model& model, const Samples& samples) {
  return (model.predict(samples) - samples.y).cwiseAbs().maxCoeff();
}

TEST(Axes, EveryTargetSeesEveryAxis) {
  Json description = {{"kind", "axes"}, {"axes", Json::array()}};
  for (const char* name : {"a", "b"}) {
    const std::string n = name;
    description["axes"].push_back({{"name", n},
                                   {"measured", "tau_" + n},
                                   {"unit", "N*m"},
                                   {"position", "q_" + n},
                                   {"velocity", "qd_" + n},
                                   {"acceleration", "qdd_" + n},
                                   {"signals", Json::array({"temp"})}});
  }
  const System system = parse_system(description, "test");
  Problem problem;
  problem.layout.spec.set = FeatureSpec::Set::kAxes;
  problem.layout.system = system;
  problem.layout.names = {"a_position", "a_velocity", "a_acceleration", "temp",
                          "b_position", "b_velocity", "b_acceleration"};
  problem.layout.units.assign(7, "");
  problem.targets = {{"tau_a", "tau_b"}, {"N*m", "N*m"}};
  problem.where = "test";
  Samples samples;
  samples.x.resize(500, 7);
  Rng rng(1);
  for (double& value : samples.x.reshaped()) value = rng.normal();
  const auto x = [&](Index j) { return samples.x.col(j).array(); };
  samples.y.resize(500, 2);
  samples.y.col(0) = 2.0 * x(0).sin() + 0.7 * x(2) + 3.0 * x(1) - 0.1 * x(3) + 0.2 * x(6) + 0.5;
  samples.y.col(1) = 1.5 * x(4).cos() + 0.3 * x(6) + 0.4 * x(5) + 0.2 * x(2);
  samples.segments = {{0, 500}};
  problem.configuration = {{"noise", {{"levels_db", Json::array({nullptr})}}}};
  const auto rigid = test::fitted("rigid", {problem, samples});
  EXPECT_LT(largest_axis_error(*rigid, samples), 1e-9);
  EXPECT_EQ(rigid->parameter_count(), 2 * (2 * 3 + 4 + 1 + 1));
  samples.y.col(0) = 2.0 * x(0).sin() + 0.5 * x(4);
  samples.y.col(1) = 1.5 * x(4).cos() - x(0);
  const auto cf = test::fitted("cf", {problem, samples});
  EXPECT_LT(largest_axis_error(*cf, samples), 1e-9);
  EXPECT_EQ(cf->parameter_count(), 2 * 7);
}

}  // namespace
}  // namespace dcnn
