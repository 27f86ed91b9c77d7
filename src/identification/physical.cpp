// SPDX-License-Identifier: Apache-2.0
#include "identification/physical.h"

#include <cmath>

#include "core/linear_algebra.h"
#include "core/tails.h"

namespace dcnn::identification {
namespace {

using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kLength = 0.1;   // m: in its unit the parts of a tool's pseudo-inertia compare
constexpr double kFew = 0.1;      // share of draws that pass, below which hit and run is used
constexpr double kInside = 1e-3;  // least eigenvalue to start from, as a share of the largest
constexpr int kStepsPerDraw = 8, kWarmUp = 2000;

Matrix4d pseudo_inertia_of(double m, const Eigen::Vector3d& h, const Eigen::Matrix3d& I) {
  Matrix4d P;
  P << (0.5 * I.trace() * Eigen::Matrix3d::Identity() - I) / (kLength * kLength), h / kLength,
      h.transpose() / kLength, m;
  return P;
}

/// Of the ten parameters of a body.
Matrix4d pseudo_inertia_of(const VectorXd& body) {
  return pseudo_inertia_of(body[0], body.segment<3>(1), symmetric_of(body.segment(4, 6)));
}

bool is_body(const WristState& state, bool torque) {
  if (!torque) return state.mass > 0.0;
  return spectrum_of(pseudo_inertia_of(state)).values.minCoeff() > 0.0;
}

VectorXd normal_vector(Index size, Rng& rng) {
  VectorXd z(size);
  for (double& value : z) value = rng.normal();
  return z;
}

/// sqrt(freedom/chi²): what makes a normal vector one of Student's distribution.
double student_scale(double freedom, Rng& rng) {
  // Wilson and Hilferty's cube: chi²/nu is (1 - 2/(9 nu) + z sqrt(2/(9 nu)))³ to some 1e-3.
  const double a = 2.0 / (9.0 * std::max(freedom, 1.0));
  const double cube = std::pow(std::max(1.0 - a + rng.normal() * std::sqrt(a), 0.05), 3);
  return 1.0 / std::sqrt(cube);
}

/// A body near given parameters, from which hit and run starts.
VectorXd inside_of(const VectorXd& body) {
  auto [values, vectors] = spectrum_of(pseudo_inertia_of(body));
  const double largest = std::max(values.maxCoeff(), 1e-6);
  const VectorXd positive = values.cwiseMax(kInside * largest);
  const Matrix4d P = vectors * positive.asDiagonal() * vectors.transpose();
  VectorXd out(10);
  out[0] = P(3, 3);
  out.segment<3>(1) = kLength * P.topRightCorner<3, 1>();
  const Eigen::Matrix3d moments = kLength * kLength * P.topLeftCorner<3, 3>();
  out.tail(6) = six_of(moments.trace() * Eigen::Matrix3d::Identity() - moments);
  return out;
}

/// A standard normal variable restricted to [low, high], by inversion of its distribution.
double truncated_normal(double low, double high, Rng& rng) {
  const auto lower = [](double x) { return normal_tail(-x); };
  if (low > 0.0) return -truncated_normal(-high, -low, rng);  // tails are exact on the left
  const double a = lower(low), b = lower(high);
  if (!(b > a)) return std::abs(low) < std::abs(high) ? low : high;
  const double u = a + (b - a) * rng.uniform();
  double x0 = std::max(low, -40.0), x1 = std::min(high, 40.0);
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (x0 + x1);
    (lower(middle) < u ? x0 : x1) = middle;
  }
  return 0.5 * (x0 + x1);
}

/// Steps of hit and run over the ten parameters of the body (Smith 1984).
class HitAndRun {
 public:
  HitAndRun(const VectorXd& mean, const MatrixXd& covariance)
      : mean_(mean), L_(cholesky(covariance)), inverse_(inverse_cholesky(covariance)) {
    at_ = inverse_ * (inside_of(mean) - mean);
  }

  VectorXd step(Rng& rng) {
    const VectorXd direction = normal_vector(10, rng).normalized();
    const Matrix4d P = pseudo_inertia_of(VectorXd(mean_ + L_ * at_));
    const Matrix4d D = pseudo_inertia_of(VectorXd(L_ * direction));
    // P + s D stays positive while 1 + s lambda > 0 for the eigenvalues of P^-1/2 D P^-1/2.
    const Matrix4d white = inverse_cholesky(P);
    const VectorXd lambda = spectrum_of(white * D * white.transpose()).values;
    const double kAlmost = 1.0 - 1e-9;
    const double low = lambda.maxCoeff() > 0.0 ? -kAlmost / lambda.maxCoeff() : -1e6;
    const double high = lambda.minCoeff() < 0.0 ? -kAlmost / lambda.minCoeff() : 1e6;
    const double centre = -at_.dot(direction);
    at_ += direction * (centre + truncated_normal(low - centre, high - centre, rng));
    return mean_ + L_ * at_;
  }

 private:
  VectorXd mean_;
  MatrixXd L_, inverse_;
  VectorXd at_;  // white coordinates
};

Draws by_hit_and_run(const WristFit& fit, int count, Rng& rng) {
  const Index p = fit.layout.size();
  const MatrixXd body = fit.covariance.topLeftCorner(10, 10);
  const MatrixXd gain = solve_symmetric(body, fit.covariance.topRows(10)).transpose();  // (p, 10)
  const MatrixXd given = fit.covariance - gain * fit.covariance.topRows(10);
  const MatrixXd rest = given.bottomRightCorner(p - 10, p - 10);
  const MatrixXd L = cholesky(rest);
  const VectorXd mean = parameters_of(fit.state, fit.layout).head(10);
  HitAndRun chain(mean, body);
  for (int k = 0; k < kWarmUp; ++k) chain.step(rng);
  Draws draws;
  for (int k = 0; k < count; ++k) {
    VectorXd at;
    for (int s = 0; s < kStepsPerDraw; ++s) at = chain.step(rng);
    VectorXd step = gain * (at - mean);
    step.head(10) = at - mean;
    step.tail(p - 10) += L * normal_vector(p - 10, rng);
    draws.states.push_back(moved(fit.state, fit.layout, step));
  }
  return draws;
}

}  // namespace

Matrix4d pseudo_inertia_of(const WristState& state) {
  return pseudo_inertia_of(state.mass, state.h, state.inertia);
}

Draws draw_states(const WristFit& fit, int count, Rng& rng) {
  const MatrixXd L = cholesky(fit.covariance);
  Draws draws;
  int tried = 0;
  while (static_cast<int>(draws.states.size()) < count) {
    const VectorXd step =
        student_scale(fit.freedom, rng) * (L * normal_vector(fit.layout.size(), rng));
    const WristState state = moved(fit.state, fit.layout, step);
    if (is_body(state, fit.layout.torque)) draws.states.push_back(state);
    if (++tried == count && static_cast<double>(draws.states.size()) < kFew * count) break;
  }
  const double passed = static_cast<double>(draws.states.size()) / tried;
  if (static_cast<int>(draws.states.size()) < count && fit.layout.torque) {
    draws = by_hit_and_run(fit, count, rng);
  }
  draws.inside = passed;
  draws.constrained = !is_body(fit.state, fit.layout.torque);
  return draws;
}

WristState mean_state(const WristFit& fit, const Draws& draws) {
  VectorXd mean = VectorXd::Zero(fit.layout.size());
  Eigen::Matrix3d turns = Eigen::Matrix3d::Zero();
  for (const WristState& state : draws.states) {
    mean += parameters_of(state, fit.layout);
    turns += state.R_SE;
  }
  mean /= static_cast<double>(draws.states.size());
  WristState out = moved(fit.state, fit.layout, mean - parameters_of(fit.state, fit.layout));
  const auto svd = singular_values(turns);
  out.R_SE = svd.U * svd.V.transpose();
  return out;
}

}  // namespace dcnn::identification
