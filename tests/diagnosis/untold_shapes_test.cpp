// SPDX-License-Identifier: Apache-2.0
// Drifts whose time constant the recordings tell, and drifts whose they do not.
#include <gtest/gtest.h>

#include <cmath>

#include "dcnn/core/random.h"
#include "diagnosis/load.h"
#include "diagnosis/one_joint.h"
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

/// A search on an axis that reads `effort` of position and velocity, in noise.
template <class Effort>
Search search_of_effort(const Effort& effort, std::uint64_t seed) {
  Rng rng({seed});
  Table table = test::joint_table(5000);
  for (Index i = 0; i < table.values.rows(); ++i) {
    const double t = 0.004 * static_cast<double>(i);
    const double q = std::sin(1.1 * t) + 0.4 * std::sin(2.9 * t),
                 v = 1.1 * std::cos(1.1 * t) + 1.16 * std::cos(2.9 * t);
    table.values.row(i) << t, q, effort(q, v) + 0.05 * rng.normal();
  }
  return test::search_of_joint({table});
}

/// The names on an axis with viscous friction and with dry friction `fc` that varies by `a` with 9
/// times the position, after both were fitted to it and what is not told of gears was left out.
std::vector<std::string> names_beside_gears(double a, double fc = 1.0) {
  Search search = search_of_effort(
      [=](double q, double v) {
        return 2.0 * v + fc * (1.0 + a * std::sin(9.0 * q)) * std::tanh(v / 0.02);
      },
      4);
  const EffectKind &gears = *find_effect("gear_friction"),
                   &viscous = *find_effect("viscous_friction");
  search.settle({make_member(search.study(), viscous, viscous.fits[0], "alpha:base_x", {}),
                 make_member(search.study(), gears, gears.fits[0], "alpha:base_x",
                             Eigen::Vector2d(9.0, 0.02))});
  search.leave_untold_bends();
  std::vector<std::string> names;
  for (const Member& member : search.fit().members) names.push_back(member.name());
  return names;
}

TEST(UntoldShapes, GearsThatVaryKeepTheirName) {
  EXPECT_EQ(names_beside_gears(0.3),
            (std::vector<std::string>{"viscous_friction", "gear_friction"}));
}

TEST(UntoldShapes, GearsThatDoNotVaryAreDryFriction) {
  EXPECT_EQ(names_beside_gears(0.0),
            (std::vector<std::string>{"viscous_friction", "coulomb_friction"}));
}

/// What stands after one member was fitted to such an axis and what is not told of its bend was
/// left out.
template <class Effort>
std::vector<Member> left_of_bend(const Effort& effort, const char* effect,
                                 const Eigen::VectorXd& shapes) {
  Search search = search_of_effort(effort, 6);
  const EffectKind& kind = *find_effect(effect);
  const char* axis = kind.axis == AxisRule::kAngle ? "alpha:base_x" : "base_x";
  search.settle({make_member(search.study(), kind, kind.fits[1], axis, shapes)});
  search.leave_untold_bends();
  return search.fit().members;
}

// Of a drag that is straight over all speeds the speed at which it bends is not told.
TEST(UntoldShapes, ADragThatDoesNotBendIsPlain) {
  const Eigen::VectorXd bend = Eigen::VectorXd::Constant(1, 3.0);
  const auto straight = [](double, double v) { return v; };
  EXPECT_EQ(left_of_bend(straight, "viscous_friction", bend).front().own_shapes(), 0);
  const auto bent = [](double, double v) { return v / (1.0 + std::abs(v)); };
  EXPECT_EQ(left_of_bend(bent, "viscous_friction", bend).front().own_shapes(), 1);
}

// Dry friction turns within less than a loop's least width: its width, force and shape are told
// together alone.
TEST(UntoldShapes, ALoopThatIsDryFrictionIsThat) {
  const auto dry = [](double, double v) { return std::tanh(v / 0.01); };
  const auto members = left_of_bend(dry, "hysteresis", Eigen::Vector2d(0.02, -0.6));
  ASSERT_EQ(members.size(), 1U);
  EXPECT_EQ(members.front().kind->friction, EffectKind::Friction::kDry) << members.front().name();
}

// Friction that falls with the speed is no drive: it ends where it vanishes.
TEST(UntoldShapes, GearsThatWouldDriveAreNoNegativeFriction) {
  EXPECT_EQ(names_beside_gears(0.0, -0.2).front(), "viscous_friction");
}

}  // namespace
}  // namespace dcnn
