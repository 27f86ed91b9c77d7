// The offset between the clocks of a force and a pose, from a simulated rigid tool.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "dcnn/import/assemble.h"
#include "import/logs.h"

namespace dcnn {
namespace {

using Vector3 = Eigen::Vector3d;

struct Motion {
  Vector3 position, acceleration;
  Eigen::Quaterniond turn;
};

Motion motion_at(double t, double size) {
  const double a = 2.1, b = 3.3;  // rad/s
  Motion m;
  m.position =
      size * Vector3(0.1 * std::sin(a * t), 0.05 * std::cos(b * t), 0.03 * std::sin(b * t));
  m.acceleration = size * Vector3(-0.1 * a * a * std::sin(a * t), -0.05 * b * b * std::cos(b * t),
                                  -0.03 * b * b * std::sin(b * t));
  m.turn = Eigen::AngleAxisd(size * 0.6 * std::sin(1.3 * t), Vector3::UnitX()) *
           Eigen::AngleAxisd(size * 0.5 * std::cos(0.9 * t), Vector3::UnitY());
  return m;
}

/// 20 s; force at 200 Hz, pose at 125 Hz, its clock `late` s behind: what it calls t was t - late.
ClockPair make_pair(double late, double noise, double size) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0.0, noise);
  ClockPair pair;
  pair.step = 0.008;
  constexpr Index kRows = 4000, kPoses = 2500;
  pair.force.resize(kRows, 3);
  pair.pose.resize(kPoses, 7);
  for (Index k = 0; k < kRows; ++k) {
    const double t = 0.005 * static_cast<double>(k);
    const Motion m = motion_at(t, size);
    const Vector3 f = m.turn.conjugate() * (0.8 * (Vector3(0, 0, -9.81) - m.acceleration));
    pair.t.push_back(t);
    for (Index c = 0; c < 3; ++c) pair.force(k, c) = f[c] + 0.3 + normal(random);
  }
  for (Index k = 0; k < kPoses; ++k) {
    const double t = 0.008 * static_cast<double>(k);
    const Motion m = motion_at(t, size);
    pair.pose_t.push_back(t - late);
    pair.pose.row(k) << m.position.transpose(), m.turn.w(), m.turn.x(), m.turn.y(), m.turn.z();
  }
  return pair;
}

TEST(ClockOffsetEstimate, FindsAnOffsetOfEitherSignWithinItsInterval) {
  for (const double late : {-0.12, 0.0, 0.0437}) {
    const ClockOffset found = estimate_clock_offset(make_pair(late, 0.05, 1.0), 0.5);
    EXPECT_TRUE(found.certain) << late;
    EXPECT_NEAR(found.seconds, late, 4.0 * found.sd + 1e-4) << late;
    EXPECT_LT(found.sd, 0.002) << late;
  }
}

TEST(ClockOffsetEstimate, IsUncertainWhereNothingMoves) {
  EXPECT_FALSE(estimate_clock_offset(make_pair(0.05, 0.05, 0.001), 0.5).certain);
  EXPECT_FALSE(estimate_clock_offset(make_pair(0.9, 0.05, 1.0), 0.5).certain);  // beyond the reach
}

TEST(ClockOffsetEstimate, IsShownForTwoStreamsOfALog) {
  const ClockPair pair = make_pair(0.0437, 0.05, 1.0);
  const test::TemporaryFolder folder;
  std::ostringstream force, pose;
  force.precision(12);
  pose.precision(12);
  force << "t fx fy fz\n";
  pose << "t x y z qw qx qy qz\n";
  for (Index k = 0; k < pair.force.rows(); ++k) {
    force << pair.t[static_cast<std::size_t>(k)] << " " << pair.force.row(k) << "\n";
  }
  for (Index k = 0; k < pair.pose.rows(); ++k) {
    pose << pair.pose_t[static_cast<std::size_t>(k)] << " " << pair.pose.row(k) << "\n";
  }
  test::spill(folder / "force.txt", force.str());
  test::spill(folder / "pose.txt", pose.str());
  const ForeignLog log = read_log({folder / "force.txt", folder / "pose.txt"}, {});
  const StreamOffset found = estimate_offset(log, propose(log, {}).recipe, 0.5);
  EXPECT_EQ(found.stream, "file2");
  EXPECT_NEAR(found.offset.seconds, 0.0437, 0.001);
  EXPECT_NE(words_of(found).find("--clock-offset file2=auto"), std::string::npos)
      << words_of(found);
  EXPECT_NE(picture_of(found).find("</svg>"), std::string::npos);
}

}  // namespace
}  // namespace dcnn
