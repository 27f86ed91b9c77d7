// SPDX-License-Identifier: Apache-2.0
#include "dcnn/physics/chain.h"

#include <algorithm>
#include <cmath>

#include "dcnn/data/rotation.h"

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;

/// A link as it moves, in the base.
struct MovingLink {
  Matrix3d R = Matrix3d::Identity();
  Vector3d p = Vector3d::Zero(), axis = Vector3d::UnitZ();
  Vector3d w = Vector3d::Zero(), dw = Vector3d::Zero();
  Vector3d felt = Vector3d::Zero();  // acceleration of the origin less gravity
};

std::vector<MovingLink> moving_links(const JointChain& chain, const Eigen::RowVectorXd& q,
                                     const Eigen::RowVectorXd& qd, const Eigen::RowVectorXd& qdd) {
  std::vector<MovingLink> links;
  MovingLink at;
  at.felt = -chain.gravity;
  for (std::size_t i = 0; i < chain.joints.size(); ++i) {
    const ChainJoint& joint = chain.joints[i];
    const auto k = static_cast<Eigen::Index>(i);
    MovingLink next;
    const Matrix3d R0 = at.R * joint.R;
    next.axis = R0 * joint.axis;
    Vector3d step = at.R * joint.p;
    next.w = at.w;
    next.dw = at.dw;
    next.R = R0;
    if (joint.slides) {
      step += next.axis * q[k];
    } else {
      next.R = R0 * rotation_about(joint.axis, q[k]);
      next.w += next.axis * qd[k];
      next.dw += next.axis * qdd[k] + at.w.cross(next.axis * qd[k]);
    }
    next.p = at.p + step;
    next.felt = at.felt + at.dw.cross(step) + at.w.cross(at.w.cross(step));
    if (joint.slides) next.felt += next.axis * qdd[k] + 2.0 * at.w.cross(next.axis * qd[k]);
    links.push_back(next);
    at = next;
  }
  return links;
}

/// d(I w)/d(ixx, ixy, ixz, iyy, iyz, izz).
Eigen::Matrix<double, 3, 6> momentum_columns(const Vector3d& w) {
  Eigen::Matrix<double, 3, 6> L;
  L << w.x(), w.y(), w.z(), 0, 0, 0,  //
      0, w.x(), 0, w.y(), w.z(), 0,   //
      0, 0, w.x(), 0, w.y(), w.z();
  return L;
}

/// Torque (force) at a joint's drive from one link, linear in its ten parameters (Atkeson, An and
/// Hollerbach 1986).
Eigen::Matrix<double, 1, 10> share_of(const MovingLink& link, const MovingLink& joint,
                                      bool slides) {
  const Matrix3d to_link = link.R.transpose();
  const Vector3d w = to_link * link.w, dw = to_link * link.dw, felt = to_link * link.felt;
  const Matrix3d W = cross_matrix(w);
  const Matrix3d swing = cross_matrix(dw) + W * W;
  const Vector3d about = to_link * joint.axis;
  Eigen::Matrix<double, 1, 10> row = Eigen::Matrix<double, 1, 10>::Zero();
  if (slides) {
    row(0) = about.dot(felt);
    row.segment<3>(1) = about.transpose() * swing;
    return row;
  }
  const Vector3d lever = to_link * joint.axis.cross(link.p - joint.p);
  row(0) = lever.dot(felt);
  row.segment<3>(1) = lever.transpose() * swing - about.transpose() * cross_matrix(felt);
  row.segment<6>(4) = about.transpose() * (momentum_columns(dw) + W * momentum_columns(w));
  return row;
}

}  // namespace

std::optional<Eigen::VectorXd> JointChain::bodies() const {
  Eigen::VectorXd all(10 * static_cast<Eigen::Index>(joints.size()));
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (!joints[j].body) return std::nullopt;
    all.segment<10>(10 * static_cast<Eigen::Index>(j)) = *joints[j].body;
  }
  return all;
}

MatrixXd chain_regressor(const JointChain& chain, const MatrixXd& q, const MatrixXd& qd,
                         const MatrixXd& qdd, std::size_t joint) {
  const auto count = static_cast<Eigen::Index>(chain.joints.size());
  MatrixXd regressor = MatrixXd::Zero(q.rows(), 10 * count);
  for (Eigen::Index k = 0; k < q.rows(); ++k) {
    const auto links = moving_links(chain, q.row(k), qd.row(k), qdd.row(k));
    for (std::size_t i = joint; i < links.size(); ++i) {
      regressor.block<1, 10>(k, 10 * static_cast<Eigen::Index>(i)) =
          share_of(links[i], links[joint], chain.joints[joint].slides);
    }
  }
  return regressor;
}

BodyVector body_in_frame(const BodyVector& body, const Matrix3d& R, const Vector3d& p) {
  const double m = body[0];
  const Vector3d h = body.segment<3>(1);
  Matrix3d I;
  I << body[4], body[5], body[6], body[5], body[7], body[8], body[6], body[8], body[9];
  // With x' = R^T (x - p): about p, S(v)^T S(v) summed over the mass.
  const Matrix3d P = cross_matrix(p), H = cross_matrix(h);
  const Matrix3d about_p = I + P * H + H * P - m * P * P;
  const Matrix3d turned = R.transpose() * about_p * R;
  BodyVector out;
  out[0] = m;
  out.segment<3>(1) = R.transpose() * (h - m * p);
  out.tail<6>() << turned(0, 0), turned(0, 1), turned(0, 2), turned(1, 1), turned(1, 2),
      turned(2, 2);
  return out;
}

MatrixXd flange_to_link(const JointChain& chain) {
  const Matrix3d back = chain.flange_R.transpose();
  MatrixXd to_link(10, 10);
  for (Eigen::Index k = 0; k < 10; ++k) {
    to_link.col(k) = body_in_frame(BodyVector::Unit(k), back, -(back * chain.flange_p));
  }
  return to_link;
}

std::vector<Eigen::Index> independent_columns(const Eigen::MatrixXd& columns, double tolerance) {
  Eigen::MatrixXd left = columns;
  for (Eigen::Index k = 0; k < left.cols(); ++k) {
    const double length = left.col(k).norm();
    if (length > 1e-9 * std::sqrt(static_cast<double>(left.rows())))
      left.col(k) /= length;
    else
      left.col(k).setZero();
  }
  std::vector<Eigen::Index> chosen;
  for (Eigen::Index step = 0; step < left.cols(); ++step) {
    Eigen::Index best = 0;
    const double length = left.colwise().norm().maxCoeff(&best);
    if (length < tolerance) break;
    chosen.push_back(best);
    const Eigen::VectorXd direction = left.col(best) / length;
    for (int pass = 0; pass < 2; ++pass) left -= direction * (direction.transpose() * left);
    left.col(best).setZero();
  }
  std::sort(chosen.begin(), chosen.end());
  return chosen;
}

}  // namespace dcnn
