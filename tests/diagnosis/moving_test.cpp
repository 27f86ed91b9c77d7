// SPDX-License-Identifier: Apache-2.0
// Whether an axis moves, in recordings so slow that its motion fills their band.
#include "diagnosis/moving.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "diagnosis/axis_case.h"
#include "support/process.h"

namespace dcnn {
namespace {

constexpr double kSlowClock = 0.1;  // s

/// Whether an axis at 10 Hz with steps of 1 mm moves; `range` [m], some rows at where it is parked.
bool moves_within(double range, int parked) {
  const test::TemporaryFolder folder;
  Table table{{"t", "x", "f"}, Eigen::MatrixXd(900, 3)};
  Rng rng({7});
  for (Index i = 0; i < table.values.rows(); ++i) {
    const double t = kSlowClock * static_cast<double>(i);
    const double x = range * (std::sin(3.0 * t) + 0.02 * std::sin(17.0 * t)) + 2e-4 * rng.normal();
    const double place = i % 90 < parked ? 0.2 : x;
    table.values.row(i) << t, 1e-3 * std::round(1e3 * place), rng.normal();
  }
  write_csv(folder / "log.csv", table);
  write_file(folder / "slide.json", R"({"kind": "axes", "axes": [{"name": "slide",
    "measured": "f", "unit": "N", "position": "x", "base": []}]})");
  DiagnosisRequest request;
  request.system = folder / "slide.json";
  request.fit = {folder / "log.csv"};
  return moves(load_axes(request).cases[0].fit);
}

TEST(Moving, InASlowRecordingToo) {
  EXPECT_TRUE(moves_within(0.04, 0));
  EXPECT_TRUE(moves_within(0.04, 2));  // jumps to where it is parked, and back
}

TEST(Moving, NotWithinTheStepsOfAnEncoder) { EXPECT_FALSE(moves_within(1e-4, 0)); }

}  // namespace
}  // namespace dcnn
