// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <numbers>

#include "conceal/draws.h"
#include "core/elementary.h"

namespace dcnn::conceal {
namespace {

using Eigen::Index;
constexpr double kFullTurn = 2.0 * std::numbers::pi;

Eigen::Matrix3d turn(double a, double b, double c) {
  const double ca = elementary::cos(a), sa = elementary::sin(a), cb = elementary::cos(b),
               sb = elementary::sin(b);
  const double cc = elementary::cos(c), sc = elementary::sin(c);
  Eigen::Matrix3d R;
  R << ca * cb, ca * sb * sc - sa * cc, ca * sb * cc + sa * sc,  //
      sa * cb, sa * sb * sc + ca * cc, sa * sb * cc - ca * sc,   //
      -sb, cb * sc, cb * cc;
  return R;
}

Eigen::MatrixXd differences(const Eigen::MatrixXd& y) {
  const Index n = y.rows();
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(n, y.cols());
  d.middleRows(1, n - 2) = (y.bottomRows(n - 2) - y.topRows(n - 2)) / (2.0 * kStep);
  d.row(0) = d.row(1);
  d.row(n - 1) = d.row(n - 2);
  return d;
}

constexpr double kReach[6] = {0.12, 0.12, 0.12, 1.0, 0.6, 0.7};

/// Tones under a clock that slows to a stand at pauses.
void add_tones(Eigen::MatrixXd& q, int tones, double low, double high, double pauses, Rng& rng) {
  Eigen::VectorXd clock(q.rows());
  const double period = rng.uniform(6.0, 12.0), phase = rng.uniform(0.0, kFullTurn);
  double now = 0.0;
  for (Index i = 0; i < q.rows(); ++i) {
    clock(i) = now;
    const double wave =
        elementary::sin(kFullTurn * kStep * static_cast<double>(i) / period + phase);
    now += kStep * (1.0 - pauses / (1.0 + elementary::exp(-(wave - 0.7) / 0.05)));
  }
  for (int j = 0; j < 6; ++j) {
    for (int k = 0; k < tones; ++k) {
      const double hz = low * elementary::pow(high / low, rng.uniform()),
                   p = rng.uniform(0.0, kFullTurn);
      const double size = kReach[j] * std::sqrt(1.0 / tones) * std::min(1.0, 0.35 / hz);
      for (Index i = 0; i < q.rows(); ++i)
        q(i, j) += size * elementary::sin(kFullTurn * hz * clock(i) + p);
    }
  }
}

void add_points(Eigen::MatrixXd& q, double shortest, double longest, double dwell, int cycle,
                Rng& rng) {
  std::vector<Eigen::VectorXd> points;
  for (int k = 0; k < cycle; ++k) {
    Eigen::VectorXd p(6);
    for (int j = 0; j < 6; ++j) p(j) = kReach[j] * rng.uniform(-1.0, 1.0);
    points.push_back(p);
  }
  Eigen::VectorXd from = points[0];
  Index i = 0;
  for (int k = 1; i < q.rows(); ++k) {
    const Eigen::VectorXd to = points[static_cast<std::size_t>(k % cycle)];
    const double move = rng.uniform(shortest, longest), rest = rng.uniform(0.2, 1.0) * dwell;
    for (double s = 0.0; s < move + rest && i < q.rows(); s += kStep, ++i) {
      const double u = std::min(1.0, s / move);
      q.row(i) = (from + (to - from) * (u * u * u * (10.0 + u * (6.0 * u - 15.0)))).transpose();
    }
    from = to;
  }
}

void add_harmonic(Eigen::MatrixXd& q, Rng& rng) {
  const double hz = rng.uniform(0.15, 0.5);
  for (int j = 0; j < 6; ++j) {
    const double size = kReach[j] * rng.uniform(0.4, 0.9), p = rng.uniform(0.0, kFullTurn);
    for (Index i = 0; i < q.rows(); ++i) {
      q(i, j) += size * elementary::sin(kFullTurn * hz * kStep * static_cast<double>(i) + p);
    }
  }
}

}  // namespace

double Climate::operator()(double t) const {
  return start + rise * (1.0 - elementary::exp(-t / settle_s)) +
         swing * elementary::sin(kFullTurn * t / period_s);
}

Climate draw_climate(Rng& rng) {
  return {rng.uniform(19.0, 23.0), rng.uniform(1.0, 6.0), rng.uniform(20.0, 80.0),
          rng.uniform(0.2, 1.5), rng.uniform(40.0, 150.0)};
}

Path make_path(const std::string& motion, double start, double seconds,
               const Eigen::Vector3d& mounting, const Conditions& conditions, std::uint64_t seed) {
  Rng rng({seed, 11});
  Eigen::MatrixXd q = Eigen::MatrixXd::Zero(static_cast<Index>(seconds / kStep), 6);
  if (motion == "human")
    add_tones(q, 10, 0.05, 2.0, 1.0, rng);
  else if (motion == "multisine")
    add_tones(q, 6, 0.03, 1.0, 0.0, rng);
  else if (motion == "points")
    add_points(q, 0.8, 2.5, 1.5, 60, rng);
  else if (motion == "scan")
    add_points(q, 3.0, 7.0, 0.5, 30, rng);
  else if (motion == "repeats")
    add_points(q, 1.0, 2.0, 0.6, 6, rng);
  else if (motion == "harmonic")
    add_harmonic(q, rng);
  else {
    add_tones(q, 6, 0.05, 1.0, 0.0, rng);
    for (int j : {2, 4, 5}) q.col(j).setZero();
  }
  add_tremor(conditions, q, rng);
  q.col(0).array() += 0.5;
  q.col(2).array() += 0.3;
  q.col(5).array() += std::numbers::pi;
  std::vector<Eigen::Matrix3d> rotation;
  for (Index i = 0; i < q.rows(); ++i) rotation.push_back(turn(q(i, 3), q(i, 4), q(i, 5)));
  return follow(start, q, std::move(rotation), mounting);
}

Path follow(double start, const Eigen::MatrixXd& q, std::vector<Eigen::Matrix3d> rotation,
            const Eigen::Vector3d& mounting) {
  const Eigen::Matrix3d mount = turn(mounting(2), mounting(1), mounting(0));
  for (Eigen::Matrix3d& R : rotation) R = R * mount;
  Path path;
  path.start = start;
  path.pose = q;
  path.rotation = std::move(rotation);
  path.velocity = differences(q.leftCols(3));
  path.acceleration = differences(path.velocity);
  const Index n = q.rows();
  path.rate.resize(n, 3);
  for (Index i = 1; i + 1 < n; ++i) {
    const std::size_t k = static_cast<std::size_t>(i);
    const Eigen::Matrix3d S = path.rotation[k].transpose() *
                              (path.rotation[k + 1] - path.rotation[k - 1]) / (2.0 * kStep);
    path.rate.row(i) << 0.5 * (S(2, 1) - S(1, 2)), 0.5 * (S(0, 2) - S(2, 0)),
        0.5 * (S(1, 0) - S(0, 1));
  }
  path.rate.row(0) = path.rate.row(1);
  path.rate.row(n - 1) = path.rate.row(n - 2);
  path.rate_derivative = differences(path.rate);
  return path;
}

}  // namespace dcnn::conceal
