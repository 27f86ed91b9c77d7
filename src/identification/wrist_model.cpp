// SPDX-License-Identifier: Apache-2.0
#include "identification/wrist_model.h"

#include <cmath>

#include "dcnn/data/rotation.h"

namespace dcnn::identification {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::Vector3d;
using Eigen::VectorXd;
using SixColumns = Eigen::Matrix<double, 3, 6>;

/// I w = columns(w)·(xx yy zz xy xz yz).
SixColumns angular_momentum(const Vector3d& w) {
  SixColumns L;
  L << w.x(), 0, 0, w.y(), w.z(), 0,  //
      0, w.y(), 0, w.x(), 0, w.z(),   //
      0, 0, w.z(), 0, w.x(), w.y();
  return L;
}

template <class Matrix>
RowVectorXd by_rows(const Matrix& M) {
  RowVectorXd row(M.size());
  for (Index i = 0; i < M.rows(); ++i) row.segment(i * M.cols(), M.cols()) = M.row(i);
  return row;
}

Matrix3d swing_at(const WristColumns& columns, Index k) {
  Matrix3d A;
  for (Index i = 0; i < 3; ++i) A.row(i) = columns.swing.row(k).segment(3 * i, 3);
  return A;
}

SixColumns spin_at(const WristColumns& columns, Index k) {
  SixColumns B;
  for (Index i = 0; i < 3; ++i) B.row(i) = columns.spin.row(k).segment(6 * i, 6);
  return B;
}

}  // namespace

Matrix3d rotation_of(const Vector3d& turn) {
  const double angle = turn.norm();
  if (angle < 1e-300) return Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

Matrix3d symmetric_of(const Eigen::Ref<const VectorXd>& i) {
  Matrix3d I;
  I << i(0), i(3), i(4), i(3), i(1), i(5), i(4), i(5), i(2);
  return I;
}

VectorXd six_of(const Matrix3d& I) {
  VectorXd six(6);
  six << I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2);
  return six;
}

WristColumns columns_of(const WristLog& log, bool torque) {
  const Motion& motion = log.motion;
  const Index n = motion.samples();
  const Vector3d g = ToolModel().gravity;
  MatrixXd raw = MatrixXd::Zero(n, torque ? 30 : 12);
  for (Index k = 0; k < n; ++k) {
    Vector3d felt = g;
    if (!log.at_rest && log.accelerated) felt -= motion.a_B.row(k).transpose();
    raw.row(k).head(3) = (motion.R_BS[static_cast<std::size_t>(k)].transpose() * felt).transpose();
    // Where the acceleration of the origin is unknown, that of turning is, too: a turn about a
    // point that is not the origin has the same terms.
    if (log.at_rest || !log.accelerated) continue;
    const Vector3d w = motion.w_S.row(k), dw = motion.dw_S.row(k);
    const Matrix3d W = cross_matrix(w);
    raw.row(k).segment(3, 9) = by_rows(Matrix3d(-cross_matrix(dw) - W * W));
    if (torque) {
      const SixColumns spin = -angular_momentum(dw) - W * angular_momentum(w);
      raw.row(k).segment(12, 18) = by_rows(spin);
    }
  }
  const MatrixXd thin = log.thinned(raw);
  WristColumns columns;
  columns.y = log.thinned(log.measured);
  columns.field = thin.leftCols(3);
  columns.swing = thin.middleCols(3, 9);
  if (torque) columns.spin = thin.middleCols(12, 18);
  columns.laws = MatrixXd(columns.y.rows(), 0);
  return columns;
}

WristState moved(const WristState& state, const Layout& layout, const VectorXd& step) {
  WristState next = state;
  next.mass += step[0];
  next.h += step.segment<3>(1);
  if (layout.torque) next.inertia += symmetric_of(step.segment(layout.inertia(), 6));
  if (layout.mounting) next.R_SE = state.R_SE * rotation_of(step.segment<3>(layout.turn()));
  next.bias += step.segment<3>(layout.bias());
  if (layout.torque) next.bias_torque += step.segment<3>(layout.bias_torque());
  if (layout.amplitudes > 0) next.amplitudes += step.tail(layout.amplitudes);
  return next;
}

VectorXd parameters_of(const WristState& state, const Layout& layout) {
  VectorXd p = VectorXd::Zero(layout.size());
  p[0] = state.mass;
  p.segment<3>(1) = state.h;
  if (layout.torque) p.segment(layout.inertia(), 6) = six_of(state.inertia);
  p.segment<3>(layout.bias()) = state.bias;
  if (layout.torque) p.segment<3>(layout.bias_torque()) = state.bias_torque;
  if (layout.amplitudes > 0) p.tail(layout.amplitudes) = state.amplitudes;
  return p;
}

MatrixXd predicted(const WristColumns& columns, const WristState& state) {
  const Index n = columns.rows(), channels = columns.y.cols();
  const bool torque = channels == 6;
  MatrixXd out(n, channels);
  const VectorXd six = six_of(state.inertia);
  for (Index k = 0; k < n; ++k) {
    const Vector3d f = columns.field.row(k);
    const Vector3d force = state.mass * f + swing_at(columns, k) * state.h;
    out.row(k).head(3) = (state.R_SE * force + state.bias).transpose();
    if (!torque) continue;
    const Vector3d twist = state.h.cross(f) + spin_at(columns, k) * six;
    out.row(k).tail(3) = (state.R_SE * twist + state.bias_torque).transpose();
  }
  for (Index a = 0; a < state.amplitudes.size(); ++a) {
    out += state.amplitudes[a] * columns.laws.middleCols(channels * a, channels);
  }
  return out;
}

MatrixXd jacobian(const WristColumns& columns, const WristState& state, const Layout& layout) {
  const Index n = columns.rows(), channels = layout.channels();
  MatrixXd J = MatrixXd::Zero(n * channels, layout.size());
  const VectorXd six = six_of(state.inertia);
  const Matrix3d& R = state.R_SE;
  // A block (3, k) of row `row`, whose channels begin at `first`, in columns from `column`.
  const auto put = [&](Index row, Index first, Index column, const MatrixXd& block) {
    for (Index i = 0; i < 3; ++i) {
      J.row((first + i) * n + row).segment(column, block.cols()) = block.row(i);
    }
  };
  const Matrix3d one = Matrix3d::Identity();
  for (Index k = 0; k < n; ++k) {
    const Vector3d f = columns.field.row(k);
    const Matrix3d A = swing_at(columns, k);
    put(k, 0, 0, R * f);
    put(k, 0, 1, R * A);
    if (layout.mounting) {
      put(k, 0, layout.turn(), -R * cross_matrix(state.mass * f + A * state.h));
    }
    put(k, 0, layout.bias(), one);
    if (!layout.torque) continue;
    const SixColumns B = spin_at(columns, k);
    put(k, 3, 1, -R * cross_matrix(f));
    put(k, 3, layout.inertia(), R * B);
    if (layout.mounting) {
      put(k, 3, layout.turn(), -R * cross_matrix(state.h.cross(f) + B * six));
    }
    put(k, 3, layout.bias_torque(), one);
  }
  for (Index a = 0; a < layout.amplitudes; ++a) {
    for (Index c = 0; c < channels; ++c) {
      J.col(layout.first_amplitude() + a).segment(c * n, n) = columns.laws.col(channels * a + c);
    }
  }
  return J;
}

}  // namespace dcnn::identification
