// SPDX-License-Identifier: Apache-2.0
#include "dcnn/data/rotation.h"

#include <gtest/gtest.h>

#include <numbers>

#include "data/sample_recording.h"
#include "data/testing.h"
#include "dcnn/core/json.h"
#include "dcnn/core/random.h"

namespace dcnn {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TEST(Rotation, EulerAnglesComeBack) {
  Rng rng(1);
  for (int k = 0; k < 1000; ++k) {
    const Vector3d euler(rng.uniform(-std::numbers::pi, std::numbers::pi), rng.uniform(-1.57, 1.57),
                         rng.uniform(-std::numbers::pi, std::numbers::pi));
    EXPECT_LT((euler_from_rotation(rotation_from_euler(euler)) - euler).norm(), 1e-11);
  }
}

TEST(Rotation, QuaternionOfEulerAnglesIsThatOfTheirMatrix) {
  Rng rng(2);
  for (int k = 0; k < 1000; ++k) {
    const Vector3d euler(rng.uniform(-4.0, 4.0), rng.uniform(-2.0, 2.0), rng.uniform(-4.0, 4.0));
    const Matrix3d R = (Eigen::AngleAxisd(euler[0], Vector3d::UnitZ()) *
                        Eigen::AngleAxisd(euler[1], Vector3d::UnitY()) *
                        Eigen::AngleAxisd(euler[2], Vector3d::UnitX()))
                           .toRotationMatrix();
    const Eigen::Quaterniond q(R);
    const Eigen::Vector4d got = quaternion_from_euler(euler);
    EXPECT_NEAR(std::abs(got.dot(Eigen::Vector4d(q.w(), q.x(), q.y(), q.z()))), 1.0, 1e-14);
  }
}

TEST(Rotation, SingularPitchKeepsTheRotation) {
  for (const double beta : {-std::numbers::pi / 2, std::numbers::pi / 2}) {
    const Matrix3d R = rotation_from_euler({0.4, beta, -0.9});
    const Vector3d euler = euler_from_rotation(R);
    EXPECT_EQ(euler[2], 0.0);
    EXPECT_LT((rotation_from_euler(euler) - R).norm(), 1e-9);
  }
}

TEST(Rotation, UnwrapTakesTheShortWayAroundPi) {
  Eigen::MatrixXd angles(5, 2);
  angles << 3.1, -3.1, -3.1, 3.1, 3.1, -3.1, 3.0, 9.0, -3.0, 2.8;
  const Eigen::MatrixXd wrapped = angles;
  unwrap(angles);
  for (Index i = 1; i < 5; ++i) {
    EXPECT_LT((angles.row(i) - angles.row(i - 1)).cwiseAbs().maxCoeff(), std::numbers::pi);
  }
  EXPECT_LT((angles.array().sin() - wrapped.array().sin()).abs().maxCoeff(), 1e-14);
  EXPECT_LT((angles.array().cos() - wrapped.array().cos()).abs().maxCoeff(), 1e-14);
}

TEST(Rotation, QuaternionsAndEulerAnglesSayTheSame) {
  const Recording euler = testing::sine_recording(500);
  Recording quaternion = testing::with_quaternions(euler);
  for (const char* name :
       {"qw", "qx", "qy", "qz"}) {  // the other half of the double cover, at random
    Eigen::VectorXd q = quaternion.column(name);
    for (Index i = 0; i < q.size(); i += 3) q[i] = -q[i];
    quaternion.set(name, q);
  }
  const auto R = rotations(quaternion);
  for (std::size_t i = 0; i < R.size(); ++i) {
    const Vector3d angles =
        euler.block({"alpha", "beta", "gamma"}).row(static_cast<Index>(i)).transpose();
    ASSERT_LT((R[i] - rotation_from_euler(angles)).norm(), 1e-14);
  }
  const Eigen::MatrixXd q = quaternions(quaternion);
  EXPECT_LT((q.bottomRows(499) - q.topRows(499)).rowwise().norm().maxCoeff(), 0.02);
}

TEST(Rotation, RateMatrixIsTheDerivativeOfTheRotation) {
  const auto euler = [](double t) { return testing::three(testing::kAngles, t, 0); };
  const double t = 0.7, h = 1e-5;
  const Vector3d rates = testing::three(testing::kAngles, t, 1);
  const Matrix3d R = rotation_from_euler(euler(t));
  const Matrix3d change =
      (rotation_from_euler(euler(t + h)) - rotation_from_euler(euler(t - h))) / (2.0 * h);
  const Matrix3d skew = R.transpose() * change;  // [omega_E]x
  const Vector3d omega = euler_rate_matrix(euler(t)) * rates;
  EXPECT_LT((omega - Vector3d(skew(2, 1), skew(0, 2), skew(1, 0))).norm(), 1e-8);
  const Matrix3d slope =
      (euler_rate_matrix(euler(t + h)) - euler_rate_matrix(euler(t - h))) / (2.0 * h);
  EXPECT_LT((euler_rate_matrix_derivative(euler(t), rates) - slope).norm(), 1e-8);
}

Vector3d vector_of(const Json& json) {
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

TEST(Rotation, AgreesWithTheReference) {
  const auto physics = testing::shared("reference/physics.json");
  if (physics.empty()) GTEST_SKIP() << "../shared/reference is absent";
  const Json p = read_json(physics, Exit::kData);
  const Json x = read_json(testing::shared("reference/xmap.json"), Exit::kData)["X"];
  for (std::size_t i = 0; i < p["theta"].size(); ++i) {
    const Vector3d euler = vector_of(p["theta"][i]);
    const Matrix3d R = rotation_from_euler(euler);
    for (Index row = 0; row < 3; ++row) {
      EXPECT_LT(
          (R.row(row).transpose() - vector_of(p["R"][i][static_cast<std::size_t>(row)])).norm(),
          1e-14);
    }
    const auto at = [&](std::size_t k) { return x[i][k].get<double>(); };
    const Vector3d rates(at(6), at(7), at(8)), accelerations(at(12), at(13), at(14));
    const Vector3d omega = euler_rate_matrix(euler) * rates;
    const Vector3d alpha = euler_rate_matrix(euler) * accelerations +
                           euler_rate_matrix_derivative(euler, rates) * rates;
    EXPECT_LT((omega - vector_of(p["omega_body"][i])).norm(), 1e-12);
    EXPECT_LT((alpha - vector_of(p["alpha_body"][i])).norm(), 1e-12);
  }
}

}  // namespace
}  // namespace dcnn
