// SPDX-License-Identifier: Apache-2.0
#include <cmath>

#include "dcnn/data/rotation.h"
#include "models/regressors.h"

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::RowVectorXd;
using Eigen::Vector3d;

/// The motion of one row in the frame of the features' set: E turned by the mounting.
struct BodyMotion {
  Vector3d u = Vector3d::Zero(), w = Vector3d::Zero(), a = Vector3d::Zero(), dw = Vector3d::Zero();
};

class WristRegressors : public Regressors {
 public:
  explicit WristRegressors(const FeatureLayout& layout)
      : body_(layout.spec.set == FeatureSpec::Set::kBody),
        columns_(wrist_columns(layout)),
        R_SE_(rotation_from_euler(layout.spec.sensor_rotation_rpy.reverse()).transpose()) {}

 protected:
  const WristColumns& columns() const { return columns_; }
  bool is_body() const { return body_; }

  static Vector3d block(const RowVectorXd& x, Index column) {
    if (column < 0) return Vector3d::Zero();
    return x.segment<3>(column).transpose();
  }

  BodyMotion motion(const RowVectorXd& x) const {
    BodyMotion m{block(x, columns_.orientation), block(x, columns_.angular_velocity),
                 block(x, columns_.acceleration), block(x, columns_.angular_acceleration)};
    if (body_) return m;
    const Vector3d euler = m.u, rates = m.w;
    const Matrix3d W = euler_rate_matrix(euler);
    const Matrix3d R_SB = R_SE_ * rotation_from_euler(euler).transpose();
    m.u = R_SB.col(2);
    m.a = R_SB * m.a;
    m.w = R_SE_ * W * rates;
    m.dw = R_SE_ * (W * m.dw + euler_rate_matrix_derivative(euler, rates) * rates);
    return m;
  }

 private:
  bool body_;
  WristColumns columns_;
  Matrix3d R_SE_;
};

class Gravity : public WristRegressors {
 public:
  explicit Gravity(const FeatureLayout& layout) : WristRegressors(layout) {
    add_group(3);
    add_group(1);
  }

 public:
  void write(const RowVectorXd& x, RowVectorXd& terms) const override {
    terms << motion(x).u.transpose(), 1.0;
  }
};

class Fourier : public WristRegressors {
 public:
  explicit Fourier(const FeatureLayout& layout) : WristRegressors(layout) { add_group(27); }

 public:
  void write(const RowVectorXd& x, RowVectorXd& terms) const override {
    const Vector3d o = block(x, columns().orientation);
    const Vector3d one = is_body() ? o : Vector3d(o.array().sin());
    const Vector3d two = is_body() ? Vector3d(o.array().square()) : Vector3d(o.array().cos());
    Matrix3d factors;  // of angle k in row k
    factors << Vector3d::Ones(), one, two;
    Index term = 0;
    for (Index i = 0; i < 3; ++i) {
      for (Index j = 0; j < 3; ++j) {
        for (Index k = 0; k < 3; ++k) terms[term++] = factors(0, i) * factors(1, j) * factors(2, k);
      }
    }
  }
};

class Rigid : public WristRegressors {
 public:
  explicit Rigid(const FeatureLayout& layout) : WristRegressors(layout) {
    add_group(3);
    if (columns().acceleration >= 0) add_group(3);
    if (columns().angular_acceleration >= 0) add_group(3);
    if (columns().angular_velocity >= 0) add_group(6);
    add_group(1);
  }

 public:
  void write(const RowVectorXd& x, RowVectorXd& terms) const override {
    const BodyMotion m = motion(x);
    Index next = 0;
    const auto put = [&](const auto& values) {
      terms.segment(next, values.size()) = values.transpose();
      next += values.size();
    };
    put(m.u);
    if (columns().acceleration >= 0) put(m.a);
    if (columns().angular_acceleration >= 0) put(m.dw);
    if (columns().angular_velocity >= 0) {
      put(Vector3d(m.w.array().square()));
      put(Vector3d(m.w[0] * m.w[1], m.w[0] * m.w[2], m.w[1] * m.w[2]));
    }
    terms[next] = 1.0;
  }
};

}  // namespace

std::shared_ptr<const Regressors> wrist_regressors(const FeatureLayout& layout, Terms terms) {
  if (terms == Terms::kGravity) return std::make_shared<Gravity>(layout);
  if (terms == Terms::kFourier) return std::make_shared<Fourier>(layout);
  return std::make_shared<Rigid>(layout);
}

}  // namespace dcnn
