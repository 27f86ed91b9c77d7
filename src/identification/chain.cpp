#include "dcnn/identification/chain.h"

#include "identification/wrist_model.h"

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using identification::cross_matrix;

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
      next.R = R0 * Eigen::AngleAxisd(q[k], joint.axis).toRotationMatrix();
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

/// Torque (force) at a joint's drive from one link, linear in its ten parameters.
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

Matrix3d turn_x(double a) { return Eigen::AngleAxisd(a, Vector3d::UnitX()).toRotationMatrix(); }
Matrix3d turn_z(double a) { return Eigen::AngleAxisd(a, Vector3d::UnitZ()).toRotationMatrix(); }

}  // namespace

JointChain chain_of(const Arm& arm) {
  JointChain chain;
  chain.gravity = arm.gravity;
  Matrix3d R = Matrix3d::Identity();  // behind the last joint, before the next one's axis
  Vector3d p = Vector3d::Zero();
  for (std::size_t i = 0; i < arm.rows.size(); ++i) {
    const Arm::Row& row = arm.rows[i];
    ChainJoint joint;
    joint.name = "joint" + std::to_string(i + 1);
    if (arm.modified) {  // Rx(alpha) Tx(a) | Rz(q + theta0) Tz(d)
      const Matrix3d twist = R * turn_x(row.alpha);
      joint.R = twist * turn_z(row.theta0);
      joint.p = p + twist * Vector3d(row.a, 0.0, row.d);
      R = Matrix3d::Identity();
      p = Vector3d::Zero();
    } else {  // | Rz(q + theta0) Tz(d) Tx(a) Rx(alpha)
      joint.R = R * turn_z(row.theta0);
      joint.p = p;
      p = Vector3d(row.a, 0.0, row.d);
      R = turn_x(row.alpha);
    }
    chain.joints.push_back(joint);
  }
  chain.flange_R = R;
  chain.flange_p = p;
  return chain;
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

}  // namespace dcnn
