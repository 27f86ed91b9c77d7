// SPDX-License-Identifier: Apache-2.0
// An arm's rigid body is one for all its joints.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "dcnn/core/file.h"
#include "dcnn/core/random.h"
#include "dcnn/physics/axis_machine.h"
#include "diagnosis/arm_senses.h"
#include "diagnosis/axis_case.h"
#include "diagnosis/axis_sense.h"
#include "support/process.h"

namespace dcnn {
namespace {

constexpr double kNoise = 0.05;  // N m
constexpr double kFriction[2] = {0.8, 0.5};

/// Angle of a joint as a sum of two sines, with its derivatives.
struct Swing {
  double q, v, a;
};
Swing swing(double t, double size, double hz) {
  Swing s{0.0, 0.0, 0.0};
  for (const double part : {1.0, 2.3}) {
    const double w = 2.0 * std::numbers::pi * hz * part, amplitude = size / part;
    s.q += amplitude * std::sin(w * t + part);
    s.v += amplitude * w * std::cos(w * t + part);
    s.a -= amplitude * w * w * std::sin(w * t + part);
  }
  return s;
}

/// Two links in a vertical plane, a point mass at the end of each (Craig, Introduction to Robotics,
/// 6.58), dry friction in both joints. `scale`: of what joint 2 logs; `against`: how
/// far it swings against joint 1 as well.
void write_arm(const std::filesystem::path& path, double begin, const double (&size)[2],
               double scale, std::uint64_t seed, double against = 0.0) {
  constexpr double m1 = 4.0, m2 = 2.5, l1 = 0.5, l2 = 0.4, g = 9.81;
  constexpr Index kSamples = 5000;
  Rng rng({seed});
  Table table;
  table.columns = {"t", "q_1", "q_2", "qd_1", "qd_2", "tau_1", "tau_2"};
  table.values.resize(kSamples, 7);
  for (Index k = 0; k < kSamples; ++k) {
    const double t = begin + static_cast<double>(k) / 250.0;
    const Swing a = swing(t, size[0], 0.13), follows = swing(t, -against, 0.13);
    Swing b = swing(t, size[1], 0.29);
    b = {b.q + follows.q, b.v + follows.v, b.a + follows.a};
    const double c = std::cos(b.q), s = std::sin(b.q), both = m2 * g * l2 * std::cos(a.q + b.q);
    const double one = (m1 * l1 * l1 + m2 * (l1 * l1 + 2.0 * l1 * l2 * c + l2 * l2)) * a.a +
                       m2 * (l1 * l2 * c + l2 * l2) * b.a -
                       m2 * l1 * l2 * s * (2.0 * a.v * b.v + b.v * b.v) +
                       (m1 + m2) * g * l1 * std::cos(a.q) + both;
    const double two = m2 * (l1 * l2 * c + l2 * l2) * a.a + m2 * l2 * l2 * b.a +
                       m2 * l1 * l2 * s * a.v * a.v + both;
    table.values.row(k) << t, a.q, b.q, a.v, b.v,
        one + kFriction[0] * std::tanh(a.v / 0.02) + kNoise * rng.normal(),
        scale * (two + kFriction[1] * std::tanh(b.v / 0.02) + kNoise * rng.normal());
  }
  write_csv(path, table);
}

class SharedBase : public testing::Test {
 protected:
  /// Joint 1 is fitted where joint 2 hardly turns, and predicted where it does.
  DiagnosisRequest request(double scale) const {
    write_arm(folder_ / "fit.csv", 0.0, {0.6, 0.15}, scale, 1);
    write_arm(folder_ / "hold.csv", 25.0, {0.8, 1.2}, scale, 2);
    write_file(folder_ / "arm.json", R"({"kind": "axes",
      "arm": {"convention": "standard", "dh": [[0.5, 0, 0, 0], [0.4, 0, 0, 0]],
              "gravity_mps2": [0, -9.81, 0]},
      "axes": [
        {"name": "one", "measured": "tau_1", "unit": "N*m", "position": "q_1", "velocity": "qd_1"},
        {"name": "two", "measured": "tau_2", "unit": "N*m", "position": "q_2", "velocity": "qd_2"}
      ]})");
    DiagnosisRequest request;
    request.system = folder_ / "arm.json";
    request.fit = {folder_ / "fit.csv"};
    request.holdout = {folder_ / "hold.csv"};
    return request;
  }

 private:
  test::TemporaryFolder folder_;
};

TEST_F(SharedBase, PredictsAJointWhereItWasNotMoved) {
  const Json report = diagnose(request(1.0), nullptr).report;
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT(report["fit"]["holdout_rmse_after"][k].get<double>(), 1.5 * kNoise) << k;
    // Without friction the arm alone leaves about the friction.
    EXPECT_LT(report["fit"]["holdout_rmse_before"][k].get<double>(), 1.3 * kFriction[k]) << k;
  }
  ASSERT_EQ(report["findings"].size(), 2u) << report["findings"].dump(1);
  for (const Json& finding : report["findings"]) {
    EXPECT_EQ(finding["effect"], "coulomb_friction");
    const std::size_t k = finding["axis"] == "one" ? 0 : 1;
    EXPECT_NEAR(finding["parameters"]["fc"]["value"].get<double>(), kFriction[k], 0.05);
  }
}

// Where the base's own offsets took a part of the weight that hardly varied, they were missing from
// what the links alone predict.
TEST_F(SharedBase, LeavesNoWeightToOffsetsThatAreNotThere) {
  DiagnosisRequest slow = request(1.0);
  write_arm(slow.fit[0], 0.0, {0.05, 0.1}, 1.0, 1);
  const Json report = diagnose(slow, nullptr).report;
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT(report["fit"]["holdout_rmse_before"][k].get<double>(), 1.5 * kFriction[k]) << k;
  }
}

// Where joints hardly turn, their weights are next to constants: what all joints together do not
// tell from offsets is told by what each one leaves.
TEST_F(SharedBase, IsCorrectedWhereItWasUncertain) {
  DiagnosisRequest small = request(1.0);
  write_arm(small.fit[0], 0.0, {0.12, 0.1}, 1.0, 1);
  write_arm(small.holdout[0], 25.0, {0.12, 0.1}, 1.0, 2);
  const Diagnosis found = diagnose(small, nullptr);
  const AxisMachine machine = parse_axis_machine(found.model, "model.json", Exit::kData);
  const Recording hold = read_recording(small.holdout[0], {}, machine.system);
  const Eigen::MatrixXd predicted = predict_axes(machine, hold);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_LT(found.report["fit"]["holdout_rmse_after"][k].get<double>(), 1.1 * kNoise) << k;
    const Eigen::VectorXd left =
        hold.column("tau_" + std::to_string(k + 1)) - predicted.col(static_cast<Index>(k));
    EXPECT_LT(std::sqrt(left.squaredNorm() / double(left.size())), 1.1 * kNoise) << k;
  }
}

/// A joint whose scale is wrong cannot share the masses of the others.
TEST_F(SharedBase, IsNotForcedOnAJointInOtherUnits) {
  const auto right = load_axes(request(1.0)).cases, wrong = load_axes(request(3.0)).cases;
  const auto apart = [](const std::vector<LoadedCase>& joints) {
    return (joints[0].fit.base_coefficients - joints[1].fit.base_coefficients).norm() >
           1e-9 * joints[0].fit.base_coefficients.norm();
  };
  EXPECT_FALSE(apart(right));
  EXPECT_TRUE(apart(wrong));
}

/// Where joint 1 swings against joint 2, joint 2's torque is opposed to its own acceleration.
TEST_F(SharedBase, TellsTheSenseOfAJointThatOthersDrive) {
  DiagnosisRequest against = request(1.0);
  write_arm(against.fit[0], 0.0, {0.9, 0.01}, 1.0, 1, 0.2);
  const System system = read_system(*against.system);
  const std::vector<Recording> logs{read_recording(against.fit[0], {}, system)};
  EXPECT_LT(sense_of(logs, system, system.axes[1], {}), 0.0);
  for (const LoadedCase& joint : load_axes(against).cases) {
    EXPECT_EQ(joint.fit.axis->sense, 1.0) << joint.fit.axis->index;
  }
}

/// Rows of six joints that four parameters of the links couple, the last by a thousandth, each with
/// dry friction. `truth`: 1 where a joint measures its drive's torque, -1 the reaction; `taken`:
/// what its rows are taken for.
std::vector<JointRows> coupled_joints(const Eigen::VectorXd& truth, const Eigen::VectorXd& taken,
                                      const Eigen::MatrixXd& told) {
  constexpr Index kJointRows = 240, kTimePieces = 6;
  Rng rng({77});
  const auto noise = [&](Index rows, Index columns) {
    Eigen::MatrixXd values(rows, columns);
    for (double& x : values.reshaped()) x = rng.normal();
    return values;
  };
  const Eigen::VectorXd links = told * noise(told.cols(), 1);
  std::vector<JointRows> joints;
  for (Index j = 0; j < truth.size(); ++j) {
    JointRows rows;
    const double coupled = j + 1 == truth.size() ? 1e-3 : 1.0;
    const Eigen::MatrixXd arm = coupled * noise(kJointRows, told.rows());
    const Eigen::ArrayXd v = noise(kJointRows, 1).array();
    rows.arm = taken(j) * arm;
    rows.own.resize(kJointRows, kOwnFriction);
    rows.own << Eigen::VectorXd::Ones(kJointRows), v.matrix(), (v / 0.02).tanh().matrix(),
        (v / 0.1).tanh().matrix(), (v / 0.4).tanh().matrix(), (v / 1.5).tanh().matrix();
    rows.target = truth(j) * (arm * links + rows.own.col(3)) + 0.1 * noise(kJointRows, 1);
    for (Index i = 0; i < kJointRows; ++i) rows.piece.push_back(i * kTimePieces / kJointRows);
    joints.push_back(std::move(rows));
  }
  return joints;
}

/// How joints are coupled says which are alike, friction which of the two they are: also of a joint
/// that no other drives.
TEST(ArmSenses, AreThoseOfAllJointsWhateverEachWasTakenFor) {
  const Eigen::VectorXd drives = Eigen::VectorXd::Ones(6);
  Eigen::VectorXd every_other = drives, one = drives;
  every_other(1) = every_other(3) = every_other(5) = -1.0;
  one(2) = -1.0;
  Rng rng({78});
  Eigen::MatrixXd told(60, 4);
  for (double& x : told.reshaped()) x = rng.normal();
  for (const Eigen::VectorXd& truth : {drives, Eigen::VectorXd(-drives), one}) {
    for (const Eigen::VectorXd& taken : {drives, Eigen::VectorXd(-drives), every_other, one}) {
      const ArmSums sums(coupled_joints(truth, taken, told));
      const ArmModel model = with_likeliest_senses(sums, told, taken);
      EXPECT_EQ(Eigen::VectorXd(model.turned.cwiseProduct(taken)), truth)
          << truth.transpose() << " taken for " << taken.transpose();
    }
  }
}

}  // namespace
}  // namespace dcnn
