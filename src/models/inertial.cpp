// SPDX-License-Identifier: Apache-2.0
#include "models/inertial.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/linear_algebra.h"

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix4d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Wrench6 = Eigen::Matrix<double, 6, 1>;

constexpr double kGravity = 9.81;  // m/s^2
constexpr Index kCount = InertialParameters::RowsAtCompileTime;
constexpr Index kBody = 10;      // of them describe the body
constexpr double kExact = 1e-9;  // no scatter is taken for less than this share of its target
constexpr double kLength = 0.1;  // m: the pseudo-inertia in units in which its parts compare
const std::array<Index, kCount> kKinds{0, 1, 1, 1, 2, 2, 2, 2, 2, 2, 3, 3, 3, 4, 4, 4};

Matrix3d inertia_of(const InertialParameters& p) {
  Matrix3d I;
  I << p[4], p[7], p[8], p[7], p[5], p[9], p[8], p[9], p[6];
  return I;
}

/// The wrench without bias: F = m·f + h x dw - w x (w x h), T = h x f - I·dw - w x (I·w), with
/// f = -9.81·u - a, all in S.
Wrench6 wrench(const InertialParameters& p, const Vector3d& u, const Vector3d& a,
               const Vector3d& dw, const Vector3d& w) {
  const Vector3d h = p.segment<3>(1), field = -kGravity * u - a;
  const Matrix3d I = inertia_of(p);
  Wrench6 result;
  result << p[0] * field + h.cross(dw) - w.cross(w.cross(h)),
      h.cross(field) - I * dw - w.cross(I * w);
  return result;
}

/// The six targets in units of their scatter, as one problem in the parameters.
struct JointProblem {
  MatrixXd a;  // what the data say, and below it what was known before
  VectorXd y;
};

VectorXd scatter(const LeastSquares& sums) {
  const VectorXd rms = sums.target_rms();
  VectorXd result = sums.residual_deviation().cwiseMax(kExact * rms);
  return (result.array() > 0.0).select(result, 1.0);
}

JointProblem joint_problem(const LeastSquares& sums, const WristColumns& columns) {
  const MatrixXd R = sums.factor(), projected = sums.projected();
  const VectorXd deviation = scatter(sums);
  const Index terms = R.rows(), rows = terms * 6;
  JointProblem problem{MatrixXd::Zero(rows + kCount, kCount), VectorXd::Zero(rows + kCount)};
  for (Index k = 0; k < kCount; ++k) {
    const MatrixXd effect = R * inertial_weights(InertialParameters::Unit(k), columns);
    for (Index j = 0; j < 6; ++j) {
      problem.a.col(k).segment(j * terms, terms) = effect.col(j) / deviation[j];
    }
  }
  for (Index j = 0; j < 6; ++j) {
    problem.y.segment(j * terms, terms) = projected.col(j) / deviation[j];
  }
  const VectorXd rms = problem.a.colwise().norm().transpose() /
                       std::sqrt(static_cast<double>(std::max<Index>(1, sums.rows())));
  const VectorXd size = group_sizes(rms, {kKinds.begin(), kKinds.end()});
  // In units of the scatter the targets' sizes differ; the least certain one sets the ridge.
  const double known = std::sqrt(known_before(sums).maxCoeff());
  for (Index k = 0; k < kCount; ++k) {
    problem.a(rows + k, k) = size[k] > 0.0 ? size[k] * known : 1.0;
  }
  return problem;
}

/// From lower triangles of the scaled pseudo-inertia, diagonal as logarithms, and biases.
class LogCholesky {
 public:
  explicit LogCholesky(const Matrix4d& scaled, const Eigen::Matrix<double, 6, 1>& bias) {
    const Matrix4d L = cholesky(scaled);
    for (Index k = 0; k < kBody; ++k) {
      const auto [i, j] = kPlaces[static_cast<std::size_t>(k)];
      point_[k] = i == j ? std::log(L(i, i)) : L(i, j);
    }
    point_.tail<6>() = bias;
  }

  InertialParameters& point() { return point_; }

  InertialParameters parameters() const {
    const Matrix4d L = lower();
    return from_scaled(L * L.transpose(), point_.tail<6>());
  }

  /// Derivatives of the parameters by the point.
  Eigen::Matrix<double, kCount, kCount> jacobian() const {
    Eigen::Matrix<double, kCount, kCount> result;
    const Matrix4d L = lower();
    for (Index k = 0; k < kBody; ++k) {
      const auto [i, j] = kPlaces[static_cast<std::size_t>(k)];
      Matrix4d dL = Matrix4d::Zero();
      dL(i, j) = i == j ? L(i, i) : 1.0;
      const Matrix4d half = dL * L.transpose();
      result.col(k) = from_scaled(half + half.transpose(), Eigen::Matrix<double, 6, 1>::Zero());
    }
    for (Index k = kBody; k < kCount; ++k) result.col(k) = InertialParameters::Unit(k);
    return result;
  }

 private:
  static constexpr std::array<std::pair<Index, Index>, kBody> kPlaces{
      {{0, 0}, {1, 0}, {1, 1}, {2, 0}, {2, 1}, {2, 2}, {3, 0}, {3, 1}, {3, 2}, {3, 3}}};

  Matrix4d lower() const {
    Matrix4d L = Matrix4d::Zero();
    for (Index k = 0; k < kBody; ++k) {
      const auto [i, j] = kPlaces[static_cast<std::size_t>(k)];
      L(i, j) = i == j ? std::exp(point_[k]) : point_[k];
    }
    return L;
  }

  static InertialParameters from_scaled(const Matrix4d& scaled,
                                        const Eigen::Matrix<double, 6, 1>& bias) {
    const Matrix3d moments = kLength * kLength * scaled.topLeftCorner<3, 3>();
    const Matrix3d I = moments.trace() * Matrix3d::Identity() - moments;
    InertialParameters p;
    p << scaled(3, 3), kLength * scaled.topRightCorner<3, 1>(), I(0, 0), I(1, 1), I(2, 2), I(0, 1),
        I(0, 2), I(1, 2), bias;
    return p;
  }

  InertialParameters point_;
};

Matrix4d scaled_pseudo_inertia(const InertialParameters& p) {
  const Eigen::Vector4d unit(1.0 / kLength, 1.0 / kLength, 1.0 / kLength, 1.0);
  return unit.asDiagonal() * pseudo_inertia(p) * unit.asDiagonal();
}

/// Minimises |a·p - y|^2 over positive definite pseudo-inertias.
InertialParameters constrained(const JointProblem& problem, LogCholesky start) {
  constexpr int kIterations = 500;
  constexpr double kProgress = 1e-10, kFlat = -18.0;  // logarithm of a diagonal that is zero
  const auto cost = [&](const LogCholesky& at) {
    return (problem.a * at.parameters() - problem.y).squaredNorm();
  };
  double least = cost(start), damping = 1e-3;
  for (int iteration = 0; iteration < kIterations && damping < 1e12; ++iteration) {
    const MatrixXd J = problem.a * start.jacobian();
    const VectorXd error = problem.a * start.parameters() - problem.y;
    MatrixXd stacked(J.rows() + kCount, kCount);
    const VectorXd scale = J.colwise().norm().transpose().cwiseMax(1e-12 * J.norm());
    stacked << J, MatrixXd((std::sqrt(damping) * scale).asDiagonal());
    VectorXd wanted = VectorXd::Zero(stacked.rows());
    wanted.head(error.size()) = -error;
    LogCholesky next = start;
    next.point() += solve_least_squares(stacked, wanted);
    for (const Index k : {0, 2, 5, 9}) next.point()[k] = std::max(next.point()[k], kFlat);
    const double reached = cost(next);
    if (!(reached < least)) {
      damping *= 10.0;
      continue;
    }
    const bool done = least - reached < kProgress * least;
    start = next;
    least = reached;
    damping = std::max(1e-12, 0.1 * damping);
    if (done) break;
  }
  return start.parameters();
}

}  // namespace

MatrixXd inertial_weights(const InertialParameters& p, const WristColumns& columns) {
  const Vector3d zero = Vector3d::Zero();
  std::vector<Wrench6> rows;
  for (Index i = 0; i < 3; ++i) rows.push_back(wrench(p, Vector3d::Unit(i), zero, zero, zero));
  if (columns.acceleration >= 0) {
    for (Index i = 0; i < 3; ++i) rows.push_back(wrench(p, zero, Vector3d::Unit(i), zero, zero));
  }
  if (columns.angular_acceleration >= 0) {
    for (Index i = 0; i < 3; ++i) rows.push_back(wrench(p, zero, zero, Vector3d::Unit(i), zero));
  }
  if (columns.angular_velocity >= 0) {
    const auto square = [&](const Vector3d& w) { return wrench(p, zero, zero, zero, w); };
    const auto unit = [](Index i) -> Vector3d { return Vector3d::Unit(i); };
    for (Index i = 0; i < 3; ++i) rows.push_back(square(unit(i)));
    for (const auto& [i, j] : {std::pair<Index, Index>{0, 1}, {0, 2}, {1, 2}}) {
      rows.push_back(square(unit(i) + unit(j)) - square(unit(i)) - square(unit(j)));
    }
  }
  rows.push_back(p.tail<6>());
  MatrixXd weights(static_cast<Index>(rows.size()), 6);
  for (std::size_t k = 0; k < rows.size(); ++k) {
    weights.row(static_cast<Index>(k)) = rows[k].transpose();
  }
  return weights;
}

Matrix4d pseudo_inertia(const InertialParameters& p) {
  const Matrix3d I = inertia_of(p);
  Matrix4d result;
  result << 0.5 * I.trace() * Matrix3d::Identity() - I, p.segment<3>(1),
      p.segment<3>(1).transpose(), p[0];
  return result;
}

InertialFit fit_inertial(const LeastSquares& sums, const WristColumns& columns) {
  constexpr double kInside = 1e-3;  // least eigenvalue to start from, as a share of the largest
  const JointProblem problem = joint_problem(sums, columns);
  DenseProblem dense{problem.a, problem.y, problem.a.colwise().norm().transpose()};
  InertialFit fit;
  fit.parameters = solve(dense);
  fit.free_mass = fit.parameters[0];
  const auto [values, vectors] = spectrum_of(scaled_pseudo_inertia(fit.parameters));
  const double largest = std::max(values.maxCoeff(), 1e-6);
  fit.constraint_active = values.minCoeff() < -1e-12 * largest;
  if (!fit.constraint_active) return fit;
  const VectorXd inside = values.cwiseMax(kInside * largest);
  const Matrix4d start = vectors * inside.asDiagonal() * vectors.transpose();
  fit.parameters = constrained(problem, LogCholesky(start, fit.parameters.tail<6>()));
  return fit;
}

}  // namespace dcnn
