// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <numbers>

#include "conceal/arm_draw.h"
#include "core/elementary.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;

constexpr double kArmTurn = 2.0 * std::numbers::pi;

Eigen::Matrix3d about_x(double angle) {
  const double c = elementary::cos(angle), s = elementary::sin(angle);
  Eigen::Matrix3d R;
  R << 1, 0, 0, 0, c, -s, 0, s, c;
  return R;
}

struct LimbShape {
  Vector3d origin;
  double roll;  // rad, about x
  double mass;  // kg
  Vector3d centre;
  double girth;  // m, mean radius of gyration
};

/// Six joints like those of common cobots, or seven in a row that turn and bend.
const std::vector<LimbShape>& shapes(std::size_t joints) {
  constexpr double h = 0.5 * std::numbers::pi;
  static const std::vector<LimbShape> kSix{{{0, 0, 0.18}, 0, 7.0, {0, -0.02, -0.01}, 0.06},
                                           {{0, 0, 0}, h, 12.0, {-0.3, 0, 0.15}, 0.15},
                                           {{-0.6, 0, 0}, 0, 4.0, {-0.25, 0, 0.05}, 0.13},
                                           {{-0.55, 0, 0.16}, 0, 2.0, {0, -0.01, 0}, 0.04},
                                           {{0, -0.12, 0}, h, 2.0, {0, 0.01, 0}, 0.04},
                                           {{0, 0.1, 0}, -h, 0.8, {0.02, 0.01, -0.03}, 0.04}};
  static const std::vector<LimbShape> kSeven{{{0, 0, 0.16}, 0, 4.0, {0, -0.03, 0.12}, 0.08},
                                             {{0, 0, 0.2}, -h, 4.0, {0, -0.06, 0.04}, 0.08},
                                             {{0, -0.21, 0}, h, 3.0, {0, 0.03, 0.13}, 0.07},
                                             {{0, 0, 0.21}, h, 2.7, {0, 0.07, 0.03}, 0.07},
                                             {{0, 0.2, 0}, -h, 1.7, {0, 0.02, 0.08}, 0.06},
                                             {{0, 0, 0.2}, -h, 1.8, {0, 0, 0.01}, 0.05},
                                             {{0, -0.08, 0}, h, 0.6, {0.02, 0.01, 0.02}, 0.04}};
  return joints == 6 ? kSix : kSeven;
}

}  // namespace

Eigen::Matrix3d drawn_turn(Rng& rng) {
  Eigen::Vector4d q(rng.normal(), rng.normal(), rng.normal(), rng.normal());
  q.normalize();
  return Eigen::Quaterniond(q(0), q(1), q(2), q(3)).toRotationMatrix();
}

std::vector<Limb> draw_limbs(std::size_t joints, Rng& rng) {
  std::vector<Limb> limbs;
  for (const LimbShape& shape : shapes(joints)) {
    Limb limb;
    limb.origin = shape.origin * rng.uniform(0.85, 1.15);
    limb.turned = about_x(shape.roll);
    const Vector3d centre = shape.centre * rng.uniform(0.8, 1.2);
    Vector3d radii;
    for (double& r : radii) r = shape.girth * rng.uniform(0.6, 1.4);
    limb.masses = solid(shape.mass * rng.uniform(0.8, 1.2), centre, radii, drawn_turn(rng));
    limbs.push_back(limb);
  }
  return limbs;
}

MatrixXd draw_angles(std::size_t joints, Rng& rng) {
  const auto n = static_cast<Index>(kArmSeconds / kStep);
  MatrixXd q = MatrixXd::Zero(n, static_cast<Index>(joints));
  Eigen::VectorXd clock(n);
  const double period = rng.uniform(8.0, 14.0), phase = rng.uniform(0.0, kArmTurn);
  double now = 0.0;
  for (Index i = 0; i < n; ++i) {
    clock(i) = now;
    const double wave = elementary::sin(kArmTurn * kStep * static_cast<double>(i) / period + phase);
    now += kStep * (1.0 - 1.0 / (1.0 + elementary::exp(-(wave - 0.8) / 0.05)));
  }
  for (Index j = 0; j < q.cols(); ++j) {
    q.col(j).setConstant(rng.uniform(-0.6, 0.6));
    for (int tone = 0; tone < 5; ++tone) {
      const double hz = logarithmic(rng, 0.04, 0.5), p = rng.uniform(0.0, kArmTurn);
      const double size = 0.7 * std::min(1.0, 0.2 / hz);
      for (Index i = 0; i < n; ++i) q(i, j) += size * elementary::sin(kArmTurn * hz * clock(i) + p);
    }
  }
  return q;
}

}  // namespace dcnn::conceal
