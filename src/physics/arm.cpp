#include "dcnn/physics/arm.h"

#include <algorithm>
#include <cmath>

#include "dcnn/core/options.h"
#include "dcnn/data/rotation.h"

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kFarthest = 100.0;  // m

Arm::Row parse_row(const Json& json, Options& options) {
  const bool four = json.is_array() && json.size() == 4 &&
                    std::all_of(json.begin(), json.end(), [](const Json& v) {
                      return v.is_number() && std::abs(v.get<double>()) < kFarthest;
                    });
  if (!four) options.reject("dh", "must hold rows [a, alpha, d, theta0], not ", json.dump());
  return {json[0], json[1], json[2], json[3]};
}

/// A link as it moves, in the arm's base.
struct Link {
  Matrix3d R;               // of its frame
  Vector3d p, axis, pivot;  // origin; the joint that carries it, and a point of that joint's axis
  Vector3d w, dw, felt;     // rates; acceleration of the origin less gravity
};

std::vector<Link> forward(const Arm& arm, const Eigen::VectorXd& q, const Eigen::VectorXd& qd,
                          const Eigen::VectorXd& qdd) {
  Link at{Matrix3d::Identity(), Vector3d::Zero(), Vector3d::UnitZ(), Vector3d::Zero(),
          Vector3d::Zero(),     Vector3d::Zero(), -arm.gravity};
  std::vector<Link> links;
  for (std::size_t i = 0; i < arm.rows.size(); ++i) {
    const Arm::Row& row = arm.rows[i];
    const auto k = static_cast<Eigen::Index>(i);
    const Matrix3d turn = rotation_from_euler({q(k) + row.theta0, 0.0, 0.0});
    const Matrix3d twist = rotation_from_euler({0.0, 0.0, row.alpha});
    Link next = at;
    Vector3d step;
    if (arm.modified) {
      const Matrix3d R = at.R * twist;
      next.axis = R.col(2);
      step = at.R * Vector3d(row.a, 0.0, 0.0) + row.d * next.axis;
      next.R = R * turn;
    } else {
      next.axis = at.R.col(2);
      const Matrix3d R = at.R * turn;
      step = R * Vector3d(row.a, 0.0, row.d);
      next.R = R * twist;
    }
    next.p = at.p + step;
    next.pivot = arm.modified ? next.p : at.p;
    next.w = at.w + next.axis * qd(k);
    next.dw = at.dw + next.axis * qdd(k) + at.w.cross(next.axis * qd(k));
    // Modified: the new origin is a point of the link before; standard: of the new one.
    const Link& carrier = arm.modified ? at : next;
    next.felt = at.felt + carrier.dw.cross(step) + carrier.w.cross(carrier.w.cross(step));
    links.push_back(next);
    at = next;
  }
  return links;
}

/// d(I w)/d(ixx, ixy, ixz, iyy, iyz, izz).
Eigen::Matrix<double, 3, 6> inertia_columns(const Vector3d& w) {
  Eigen::Matrix<double, 3, 6> L;
  L << w.x(), w.y(), w.z(), 0, 0, 0,  //
      0, w.x(), 0, w.y(), w.z(), 0,   //
      0, 0, w.x(), 0, w.y(), w.z();
  return L;
}

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d S;
  S << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return S;
}

/// Newton and Euler for one link, linear in its parameters (Atkeson, An and Hollerbach 1986): the
/// torque that its wrench makes about a joint's axis.
Eigen::Matrix<double, 1, 10> torque_of(const Link& link, const Link& joint) {
  const Matrix3d toLink = link.R.transpose();
  const Vector3d w = toLink * link.w, dw = toLink * link.dw, felt = toLink * link.felt;
  const Matrix3d swing = cross_matrix(dw) + cross_matrix(w) * cross_matrix(w);
  const Vector3d about = toLink * joint.axis;
  const Vector3d lever = toLink * joint.axis.cross(link.p - joint.pivot);
  Eigen::Matrix<double, 1, 10> row;
  row(0) = lever.dot(felt);
  row.segment<3>(1) = lever.transpose() * swing - about.transpose() * cross_matrix(felt);
  row.segment<6>(4) =
      about.transpose() * (inertia_columns(dw) + cross_matrix(w) * inertia_columns(w));
  return row;
}

}  // namespace

Arm parse_arm(const Json& json, const std::string& where, Exit exit) {
  Options options(json, where, exit);
  Arm arm;
  arm.modified = options.choice("convention", "modified", {"modified", "standard"}) == "modified";
  const Json dh = options.raw("dh");
  if (!dh.is_array() || dh.empty()) options.reject("dh", "must be a list of [a, alpha, d, theta0]");
  for (const Json& row : dh) arm.rows.push_back(parse_row(row, options));
  const auto g = options.get<std::vector<double>>("gravity_mps2", {0.0, 0.0, -9.81});
  if (g.size() != 3) options.reject("gravity_mps2", "must be [x, y, z]");
  arm.gravity = {g[0], g[1], g[2]};
  options.finish();
  return arm;
}

Eigen::MatrixXd arm_regressor(const Arm& arm, const Eigen::MatrixXd& q, const Eigen::MatrixXd& qd,
                              const Eigen::MatrixXd& qdd, std::size_t joint) {
  const auto links = static_cast<Eigen::Index>(arm.rows.size());
  Eigen::MatrixXd regressor = Eigen::MatrixXd::Zero(q.rows(), 10 * links);
  for (Eigen::Index k = 0; k < q.rows(); ++k) {
    const auto moving = forward(arm, q.row(k), qd.row(k), qdd.row(k));
    for (std::size_t i = joint; i < moving.size(); ++i) {
      regressor.block<1, 10>(k, 10 * static_cast<Eigen::Index>(i)) =
          torque_of(moving[i], moving[joint]);
    }
  }
  return regressor;
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
