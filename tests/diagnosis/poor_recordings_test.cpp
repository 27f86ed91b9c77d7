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

}  // namespace
}  // namespace dcnn
