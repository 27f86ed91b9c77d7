// SPDX-License-Identifier: Apache-2.0
#include "diagnosis/outlying.h"

#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "diagnosis/axis_case.h"
#include "support/process.h"

namespace dcnn {
namespace {

/// Of two recordings of noise, of 30 s and 6.5 s, where six times as much is left of the second
/// from one time to another, in s.
std::vector<Span> spans_beside(double from, double to) {
  const test::TemporaryFolder folder;
  DiagnosisRequest request;
  for (const double seconds : {30.0, 6.5}) {
    Rng rng({7, request.fit.size()});
    Table table{{"t", "q", "torque"}, Eigen::MatrixXd(static_cast<Index>(200.0 * seconds), 3)};
    for (Index i = 0; i < table.values.rows(); ++i) {
      const double t = 0.005 * static_cast<double>(i);
      table.values.row(i) << t, std::sin(3.0 * t), rng.normal();
    }
    request.fit.push_back(folder / (std::to_string(request.fit.size()) + ".csv"));
    write_csv(request.fit.back(), table);
  }
  write_file(folder / "system.json", R"({"kind": "axes", "axes": [
    {"name": "joint", "measured": "torque", "unit": "N*m", "position": "q", "base": []}]})");
  request.system = folder / "system.json";
  Search search(load_axes(request).cases[0].fit, {}, nullptr);
  search.settle({});
  Signals left;
  for (const Log& log : search.study().logs) left.push_back(log.measured);
  const Eigen::VectorXd& t = search.study().logs[1].motion.t;
  for (Index i = 0; i < t.size(); ++i) {
    if (t(i) >= from && t(i) < to) left[1].row(i) *= 6.0;
  }
  return outlying(search.setting(), left, {});
}

TEST(Outlying, AHandIsLeftOut) {
  const auto spans = spans_beside(3.0, 4.0);
  ASSERT_EQ(spans.size(), 1U);
  EXPECT_EQ(spans[0].log, 1U);
  EXPECT_NEAR(spans[0].begin, 2.5, 1e-9);
  EXPECT_NEAR(spans[0].end, 4.5, 1e-9);
}

// One that is louder throughout shows other motion, though it be a fifth of all.
TEST(Outlying, ARecordingIsNoCollision) { EXPECT_TRUE(spans_beside(0.0, 6.5).empty()); }

}  // namespace
}  // namespace dcnn
