// Drifts whose time constant the recordings tell, and drifts whose they do not.
#include <gtest/gtest.h>

#include <cmath>

#include "diagnosis/load.h"
#include "diagnosis/search.h"
#include "diagnosis/support.h"

namespace dcnn {
namespace {

/// Whether a drift that is fitted to an offset f(t) on fx has a time constant that is not told.
bool is_untold_of(double (*offset)(double)) {
  const test::Bench bench(test::configuration(Json::array()));
  test::change(bench, [&](Recording& log) {
    Eigen::VectorXd force = log.column("fx");
    const Eigen::VectorXd t = log.column("t");
    for (Index i = 0; i < force.size(); ++i) force(i) += offset(t(i));
    log.set("fx", force);
  });
  Search search(load_wrist(bench.request()).fit, {}, nullptr);
  const EffectKind& kind = *find_effect("thermal_drift");
  Member drift =
      make_member(search.study(), kind, kind.fits[0], "", Eigen::VectorXd::Constant(1, 1.0));
  search.settle({drift});
  return has_untold_shape(search.setting(), search.fit());
}

TEST(UntoldShapes, AnOffsetThatSettlesHasATimeConstant) {
  EXPECT_FALSE(is_untold_of([](double t) { return 0.5 * (1.0 - std::exp(-t / 4.0)); }));
}

// One that was there before the recording settles within any time that is short enough.
TEST(UntoldShapes, AConstantHasNone) {
  EXPECT_TRUE(is_untold_of([](double) { return 0.05; }));
}

}  // namespace
}  // namespace dcnn
